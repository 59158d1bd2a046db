#include "report/pictures/draw.hpp"

#include <cairo-pdf.h>
#include <dlfcn.h>
#include <librsvg/rsvg.h>

#include <cmath>
#include <memory>

#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

[[noreturn]] void refuse(const std::string& why) {
  throw InputError("the pictures cannot be drawn: " + why, "write them as SVG (--format svg)");
}

/// librsvg and the Cairo it draws with, loaded by the first picture: with the thirty libraries that they bring every
/// command would start half as slowly again.
class Drawer {
  void* library_ = ::dlopen(TRIBOFIT_RSVG_LIBRARY, RTLD_NOW | RTLD_LOCAL);

  template <class Function>
  Function* loaded(const char* name) const {
    void* const found = library_ == nullptr ? nullptr : ::dlsym(library_, name);
    if (found == nullptr) refuse(std::string(name) + " of librsvg cannot be loaded");
    return reinterpret_cast<Function*>(found);
  }

 public:
#define TRIBOFIT_LOADED(name) decltype(::name)* name = loaded<decltype(::name)>(#name)
  TRIBOFIT_LOADED(g_error_free);
  TRIBOFIT_LOADED(g_object_unref);
  TRIBOFIT_LOADED(rsvg_handle_new_from_data);
  TRIBOFIT_LOADED(rsvg_handle_set_dpi);
  TRIBOFIT_LOADED(rsvg_handle_get_intrinsic_size_in_pixels);
  TRIBOFIT_LOADED(rsvg_handle_render_document);
  TRIBOFIT_LOADED(cairo_pdf_surface_create_for_stream);
  TRIBOFIT_LOADED(cairo_pdf_surface_set_metadata);
  TRIBOFIT_LOADED(cairo_image_surface_create);
  TRIBOFIT_LOADED(cairo_create);
  TRIBOFIT_LOADED(cairo_destroy);
  TRIBOFIT_LOADED(cairo_surface_status);
  TRIBOFIT_LOADED(cairo_surface_write_to_png_stream);
  TRIBOFIT_LOADED(cairo_surface_finish);
  TRIBOFIT_LOADED(cairo_surface_destroy);
  TRIBOFIT_LOADED(cairo_status_to_string);
#undef TRIBOFIT_LOADED
};

const Drawer& drawer() {
  static const Drawer loaded;
  return loaded;
}

template <auto Release>
struct Released {
  template <class T>
  void operator()(T* what) const {
    (drawer().*Release)(what);
  }
};

cairo_status_t append(void* out, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(out)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

/// The chunk pHYs, which says how large a dot is: 600 of them an inch, 23622 a metre, across and along.
std::string with_dots_per_metre(std::string png) {
  static_assert(kPicturePixelsPerInch == 600);
  constexpr std::string_view kDots("\x00\x00\x00\x09pHYs\x00\x00\x5C\x46\x00\x00\x5C\x46\x01\x14\x94\x43\x41", 21);
  constexpr std::size_t kAfterHeader = 33;  // signature and IHDR
  return png.size() > kAfterHeader ? png.insert(kAfterHeader, kDots) : png;
}

}  // namespace

bool can_convert() {
  return true;
}

std::string converted(const std::string& svg, PictureFormat format, const std::string& title) {
  const Drawer& use = drawer();
  GError* error = nullptr;
  const auto check = [&](bool done) {
    const std::unique_ptr<GError, Released<&Drawer::g_error_free>> why(done ? nullptr : error);
    if (!done) refuse(why ? why->message : "librsvg does not say why");
  };
  const std::unique_ptr<RsvgHandle, Released<&Drawer::g_object_unref>> picture(
      use.rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error));
  check(picture != nullptr);
  const bool pdf = format == PictureFormat::pdf;
  RsvgRectangle page{};
  use.rsvg_handle_set_dpi(picture.get(), pdf ? 72 : kPicturePixelsPerInch);
  check(use.rsvg_handle_get_intrinsic_size_in_pixels(picture.get(), &page.width, &page.height) != 0);
  std::string out;
  const std::unique_ptr<cairo_surface_t, Released<&Drawer::cairo_surface_destroy>> surface(
      pdf ? use.cairo_pdf_surface_create_for_stream(append, &out, page.width, page.height)
          : use.cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::lround(page.width)),
                                           static_cast<int>(std::lround(page.height))));
  if (pdf) use.cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, title.c_str());
  {
    const std::unique_ptr<cairo_t, Released<&Drawer::cairo_destroy>> cairo(use.cairo_create(surface.get()));
    check(use.rsvg_handle_render_document(picture.get(), cairo.get(), &page, &error) != 0);
  }
  cairo_status_t status = use.cairo_surface_status(surface.get());
  if (!pdf && status == CAIRO_STATUS_SUCCESS)
    status = use.cairo_surface_write_to_png_stream(surface.get(), append, &out);
  use.cairo_surface_finish(surface.get());
  if (status == CAIRO_STATUS_SUCCESS) status = use.cairo_surface_status(surface.get());
  if (status != CAIRO_STATUS_SUCCESS) refuse(use.cairo_status_to_string(status));
  return pdf ? out : with_dots_per_metre(std::move(out));
}

}  // namespace tribofit
