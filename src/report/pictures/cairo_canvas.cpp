#include <cairo-pdf.h>
#include <cairo.h>

#include <cmath>

#include "report/pictures/canvas.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

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

/// PDF, with its letters embedded, and PNG.
class CairoCanvas : public Canvas {
 public:
  CairoCanvas(PictureFormat format, double width, double height, const std::string& title)
      : Canvas(height), format_(format) {
    const double right = across(width), bottom = across(height);
    if (format == PictureFormat::pdf) {
      surface_ = cairo_pdf_surface_create_for_stream(append, &out_, right, bottom);
      cairo_pdf_surface_set_metadata(surface_, CAIRO_PDF_METADATA_TITLE, title.c_str());
    } else {
      const double dots = kPicturePixelsPerInch / 72.0;
      surface_ = cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::lround(right * dots)),
                                            static_cast<int>(std::lround(bottom * dots)));
      cairo_surface_set_device_scale(surface_, dots, dots);
    }
    cairo_ = cairo_create(surface_);
    cairo_set_source_rgb(cairo_, 1, 1, 1);
    cairo_paint(cairo_);
    cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
    cairo_select_font_face(cairo_, "Arial", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(cairo_, options);
    cairo_font_options_destroy(options);
  }
  ~CairoCanvas() override {
    cairo_destroy(cairo_);
    cairo_surface_destroy(surface_);
  }
  CairoCanvas(const CairoCanvas&) = delete;
  CairoCanvas& operator=(const CairoCanvas&) = delete;

  void stroke(std::span<const Path> paths, const Pen& pen) override {
    bool dots = false;
    for (const Path& path : paths) {
      trace(path);
      if (path.size() == 1) cairo_close_path(cairo_), dots = true;
    }
    cairo_set_line_cap(cairo_, dots ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
    cairo_set_line_width(cairo_, pen.width);
    cairo_set_dash(cairo_, pen.dashes.data(), static_cast<int>(pen.dashes.size()), 0);
    use(pen.paint);
    cairo_stroke(cairo_);
  }
  void fill(std::span<const Path> polygons, const Paint& paint) override {
    for (const Path& path : polygons) trace(path);
    use(paint);
    cairo_fill(cairo_);
  }
  void write(const Words& words) override;
  void begin_plot(const Area& area) override {
    cairo_save(cairo_);
    cairo_rectangle(cairo_, across(area.left), down(area.top()), across(area.width), across(area.height));
    cairo_clip(cairo_);
  }
  void end_plot() override { cairo_restore(cairo_); }
  std::string finish() override;

 private:
  void trace(const Path& path) {
    cairo_new_sub_path(cairo_);
    for (const Point& point : path) cairo_line_to(cairo_, across(point.x), down(point.y));
  }
  void use(const Paint& paint) {
    const auto part = [&](std::size_t which) { return channel_of(paint.colour, which) / 255.0; };
    cairo_set_source_rgba(cairo_, part(0), part(1), part(2), paint.opacity);
  }

  PictureFormat format_;
  cairo_surface_t* surface_ = nullptr;
  cairo_t* cairo_ = nullptr;
  std::string out_;
};

void CairoCanvas::write(const Words& words) {
  const std::vector<TextPiece> pieces = words.pieces();
  const auto set_size = [&](const TextPiece& piece) {
    cairo_set_font_size(cairo_, words.points * (piece.level == 0 ? 1 : kScriptSize));
  };
  double width = 0;
  for (const TextPiece& piece : pieces) {
    cairo_text_extents_t extents;
    set_size(piece);
    cairo_text_extents(cairo_, piece.text.c_str(), &extents);
    width += extents.x_advance;
  }
  cairo_save(cairo_);
  cairo_translate(cairo_, across(words.at.x), down(words.at.y));
  if (words.upright) cairo_rotate(cairo_, -std::acos(0.0));
  cairo_translate(cairo_, -width * static_cast<double>(words.anchor) / 2, kHalfOfCapital * words.points);
  const auto show = [&](void (*text)(cairo_t*, const char*)) {
    cairo_move_to(cairo_, 0, 0);
    for (const TextPiece& piece : pieces) {
      const double rise = piece.level * kScriptRise * words.points;
      set_size(piece);
      cairo_rel_move_to(cairo_, 0, -rise);
      text(cairo_, piece.text.c_str());
      cairo_rel_move_to(cairo_, 0, rise);
    }
  };
  if (words.halo) {
    show(cairo_text_path);
    use({"#ffffff"});
    cairo_set_line_width(cairo_, kHalo);
    cairo_stroke(cairo_);
  }
  use({});
  show(cairo_show_text);
  cairo_new_path(cairo_);
  cairo_restore(cairo_);
}

std::string CairoCanvas::finish() {
  cairo_status_t status = cairo_status(cairo_);
  if (format_ == PictureFormat::png && status == CAIRO_STATUS_SUCCESS) {
    status = cairo_surface_write_to_png_stream(surface_, append, &out_);
  }
  cairo_surface_finish(surface_);
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface_);
  if (status != CAIRO_STATUS_SUCCESS) {
    throw InputError(std::string("the pictures cannot be drawn: ") + cairo_status_to_string(status),
                     "write them as SVG (--format svg)");
  }
  return format_ == PictureFormat::png ? with_dots_per_metre(std::move(out_)) : std::move(out_);
}

}  // namespace

bool has_cairo() {
  return true;
}

std::unique_ptr<Canvas> make_cairo(PictureFormat format, double width, double height, const std::string& title) {
  return std::make_unique<CairoCanvas>(format, width, height, title);
}

}  // namespace tribofit
