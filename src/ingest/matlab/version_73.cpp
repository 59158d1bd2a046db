#include <dlfcn.h>
#include <fmt/format.h>
#include <matio.h>

#include <bit>
#include <cstring>
#include <mutex>
#include <type_traits>
#include <utility>

#include "apart.hpp"
#include "contents.hpp"
#include "ingest/byte_cursor.hpp"
#include "ingest/byte_writer.hpp"
#include "ingest/limits.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

/// The functions of libmatio, which is loaded for the first file of version 7.3: it brings HDF5 and all that HDF5 may
/// need, and every start would pay for what hardly a file needs.
struct Matio {
  decltype(&::Mat_LogInitFunc) init_log = nullptr;
  decltype(&::Mat_Open) open = nullptr;
  decltype(&::Mat_Close) close = nullptr;
  decltype(&::Mat_VarReadNextInfo) next_variable = nullptr;
  decltype(&::Mat_VarReadInfo) find_variable = nullptr;
  decltype(&::Mat_VarReadDataAll) read_data = nullptr;
  decltype(&::Mat_VarFree) free_variable = nullptr;
  decltype(&::Mat_VarGetNumberOfFields) number_of_fields = nullptr;
  decltype(&::Mat_VarGetStructFieldnames) names_of_fields = nullptr;
  decltype(&::Mat_VarGetStructFieldByIndex) field_at = nullptr;
  decltype(&::Mat_VarGetStructFieldByName) field_named = nullptr;
  decltype(&::Mat_SizeOfClass) size_of_class = nullptr;
  std::string trouble;  ///< why there is none; empty: there is

  Matio() {
    void* const library = ::dlopen(TRIBOFIT_MATIO_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    const auto find = [&](auto& function, const char* name) {
      if (library != nullptr)
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(::dlsym(library, name));
      if (function == nullptr && trouble.empty()) trouble = ::dlerror();
    };
    find(init_log, "Mat_LogInitFunc");
    find(open, "Mat_Open");
    find(close, "Mat_Close");
    find(next_variable, "Mat_VarReadNextInfo");
    find(find_variable, "Mat_VarReadInfo");
    find(read_data, "Mat_VarReadDataAll");
    find(free_variable, "Mat_VarFree");
    find(number_of_fields, "Mat_VarGetNumberOfFields");
    find(names_of_fields, "Mat_VarGetStructFieldnames");
    find(field_at, "Mat_VarGetStructFieldByIndex");
    find(field_named, "Mat_VarGetStructFieldByName");
    find(size_of_class, "Mat_SizeOfClass");
  }
};

const Matio& matio() {
  static const Matio loaded;
  return loaded;
}

struct FreeVariable {
  void operator()(matvar_t* variable) const { matio().free_variable(variable); }
};
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

/// One child at a time, so that none inherits the pipe of another.
std::mutex& matio_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// What went wrong is said by an InputError, not by libmatio on standard error.
void ignore_message(int, char*) {}

bool is_numeric(const matvar_t& v) {
  return v.class_type >= MAT_C_DOUBLE && v.class_type <= MAT_C_UINT64 && v.isComplex == 0;
}

const char* kind_of(const matvar_t& v) {
  if (v.isComplex != 0) return "a complex array";
  switch (v.class_type) {
    case MAT_C_CELL:
      return "a cell array";
    case MAT_C_SPARSE:
      return "a sparse array";
    case MAT_C_STRUCT:
      return "an array of structures";
    case MAT_C_FUNCTION:
      return "a function";
    default:
      return "an object";
  }
}

template <class Number>
void convert(const void* data, std::vector<double>& out) {
  const auto* values = static_cast<const Number*>(data);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<double>(values[i]);
}

void convert(const matvar_t& v, std::vector<double>& out) {
  switch (v.class_type) {
    case MAT_C_DOUBLE:
      return convert<double>(v.data, out);
    case MAT_C_SINGLE:
      return convert<float>(v.data, out);
    case MAT_C_INT8:
      return convert<std::int8_t>(v.data, out);
    case MAT_C_UINT8:
      return convert<std::uint8_t>(v.data, out);
    case MAT_C_INT16:
      return convert<std::int16_t>(v.data, out);
    case MAT_C_UINT16:
      return convert<std::uint16_t>(v.data, out);
    case MAT_C_INT32:
      return convert<std::int32_t>(v.data, out);
    case MAT_C_UINT32:
      return convert<std::uint32_t>(v.data, out);
    case MAT_C_INT64:
      return convert<std::int64_t>(v.data, out);
    default:
      return convert<std::uint64_t>(v.data, out);
  }
}

/// The file in the hands of libmatio.
class Opened {
 public:
  explicit Opened(const InputFile& file) : mat_(nullptr, matio().close) {
    matio().init_log("", ignore_message);
    mat_.reset(matio().open(file.path().c_str(), MAT_ACC_RDONLY));
    if (mat_) return;
    throw InputError("is a MATLAB file of version 7.3 that cannot be opened: it is cut off or damaged",
                     "copy it again, or save it again with save(..., '-v7')", {file.path(), 0, ""});
  }
  mat_t* get() const { return mat_.get(); }

 private:
  std::unique_ptr<mat_t, decltype(&::Mat_Close)> mat_;
};

void put(const MatArray& array, ByteWriter& out) {
  out.text(array.name).number(static_cast<std::uint32_t>(array.sizes.size()));
  for (const std::uint64_t size : array.sizes) out.number(size);
  out.text(array.kind).number(array.is_text).number(static_cast<std::uint32_t>(array.scalar.size()));
  for (const double value : array.scalar) out.number(value);
  out.text(array.text);
}

MatArray take_array(ByteCursor& in) {
  MatArray array;
  array.name = in.text(native_big_endian);
  for (auto n = in.number<std::uint32_t>(native_big_endian); n > 0; --n)
    array.sizes.push_back(in.number<std::uint64_t>(native_big_endian));
  array.kind = in.text(native_big_endian);
  array.is_text = in.number<std::uint8_t>(native_big_endian) != 0;
  for (auto n = in.number<std::uint32_t>(native_big_endian); n > 0; --n)
    array.scalar.push_back(in.number<double>(native_big_endian));
  array.text = in.text(native_big_endian);
  return array;
}

void put(const MatValues& values, ByteWriter& out) {
  out.number(values.refusal.has_value());
  if (values.refusal) {
    out.text(values.refusal->problem()).text(values.refusal->advice());
    out.text(values.refusal->where().file).text(values.refusal->where().column);
    return;
  }
  out.number(static_cast<std::uint64_t>(values.numbers.size()));
  out.raw({reinterpret_cast<const char*>(values.numbers.data()), values.numbers.size() * sizeof(double)});
}

MatValues take_values(ByteCursor& in) {
  MatValues values;
  if (in.number<std::uint8_t>(native_big_endian) != 0) {
    std::string problem = in.text(native_big_endian), advice = in.text(native_big_endian),
                file = in.text(native_big_endian), column = in.text(native_big_endian);
    values.refusal.emplace(std::move(problem), std::move(advice), InputLocation{std::move(file), 0, std::move(column)});
    return values;
  }
  const auto count = in.number<std::uint64_t>(native_big_endian);
  in.need(count, sizeof(double));
  values.numbers.resize(static_cast<std::size_t>(count));
  std::memcpy(values.numbers.data(), in.bytes().data() + in.position(), values.numbers.size() * sizeof(double));
  in.skip(count * sizeof(double));
  return values;
}

class Version73 : public MatContents {
 public:
  explicit Version73(std::shared_ptr<const InputFile> file) : file_(std::move(file)) {
    refuse_cut_off();
    if (matio().trouble.empty()) return;
    throw InputError("is a MATLAB file of version 7.3, and libmatio cannot be loaded: " + matio().trouble,
                     "install it, or save the file again with save(..., '-v7')", {file_->path(), 0, ""});
  }

  void describe(const std::function<void(MatArray&&)>& see) override {
    const std::lock_guard lock(matio_mutex());
    ByteCursor arrays = taken_apart([this] {
      ByteWriter out;
      describe_here([&](MatArray&& array) { put(array, out); });
      return out.take();
    });
    while (arrays.position() < arrays.bytes().size()) see(take_array(arrays));
  }

  std::vector<MatValues> load(std::span<const std::string> names, int) override {
    const std::lock_guard lock(matio_mutex());
    std::vector<MatValues> values(names.size());
    ByteCursor taken = taken_apart([&] {
      ByteWriter out;
      const Opened mat(*file_);
      for (const std::string& name : names) put(read_or_refuse(mat, name), out);
      return out.take();
    });
    for (MatValues& one : values) one = take_values(taken);
    return values;
  }

 private:
  /// What follows runs in a process of its own: see run_apart.
  void describe_here(const std::function<void(MatArray&&)>& see) {
    const Opened mat(*file_);
    bytes_ = 0;
    for (std::size_t count = 0; count < kMostMatArrays; ++count) {
      const Variable variable(matio().next_variable(mat.get()));
      if (!variable) return;
      if (variable->name != nullptr) describe(mat, *variable, variable->name, 0, see);
    }
    throw InputError(fmt::format("holds more than {} variables", kMostMatArrays), "save those that are needed",
                     {file_->path(), 0, ""});
  }

  MatValues read_or_refuse(const Opened& mat, const std::string& name) const {
    MatValues values;
    try {
      values.numbers = read(mat, name);
    } catch (const InputError& error) {
      values.refusal = error;
    }
    return values;
  }

  ByteCursor taken_apart(const std::function<std::string()>& work) const {
    const std::string path = file_->path();
    return ByteCursor(run_apart(path, work), [path](std::uint64_t, std::uint64_t) {
      throw InputError("the reading of the file broke off", "the file is damaged; save it again", {path, 0, ""});
    });
  }

  /// The superblock of HDF5 (versions 0 to 3), behind MATLAB's own head, states where the file ends.
  void refuse_cut_off() const {
    constexpr std::uint64_t superblock = 512;
    std::string bytes(64, '\0');
    bytes.resize(file_->read(superblock, bytes));
    if (bytes.size() < 64 || !bytes.starts_with("\x89HDF")) {
      throw InputError(fmt::format("byte {}: no HDF5 file begins here", superblock),
                       "the file is cut off or damaged; copy or save it again", {file_->path(), 0, ""});
    }
    const int version = bytes[8];
    const int bytes_of_offsets = bytes[version < 2 ? 13 : 9];
    if (version < 0 || version > 3 || bytes_of_offsets != 8) {
      throw InputError(
          fmt::format("byte {}: HDF5 of version {} with offsets of {} bytes", superblock, version, bytes_of_offsets),
          "the file is damaged; copy or save it again", {file_->path(), 0, ""});
    }
    const std::size_t base_at = version == 0 ? 24 : version == 1 ? 28 : 12;
    const auto end = number_at<std::uint64_t>(bytes, base_at + 16, false);
    const auto base = number_at<std::uint64_t>(bytes, base_at, false);
    const std::uint64_t size = file_->size();
    if (base <= size && end <= size) return;
    throw InputError(fmt::format("is cut off at byte {}: it states {} bytes", file_->size(), end),
                     "copy or save the file again", {file_->path(), 0, ""});
  }

  void describe(const Opened& mat, matvar_t& v, const std::string& name, int depth,
                const std::function<void(MatArray&&)>& see) {
    MatArray array;
    array.name = name;
    for (int k = 0; k < v.rank; ++k) array.sizes.push_back(v.dims[k]);
    if (v.class_type == MAT_C_STRUCT && array.elements() == 1 && depth < kDeepestMatStructure) {
      const unsigned count = matio().number_of_fields(&v);
      char* const* names = matio().names_of_fields(&v);
      for (unsigned k = 0; k < count; ++k) {
        matvar_t* field = matio().field_at(&v, k, 0);
        if (field != nullptr) describe(mat, *field, name + "." + names[k], depth + 1, see);
      }
      return;
    }
    array.is_text = v.class_type == MAT_C_CHAR;
    if (is_numeric(v)) {
      refuse_beyond_file(array);
    } else if (v.class_type == MAT_C_EMPTY) {
      array.sizes = {0, 0};
    } else if (!array.is_text) {
      array.kind = kind_of(v);
    }
    const bool is_short = array.elements() > 0 && array.elements() <= (array.is_text ? kLongestMatText : 1);
    if (array.kind.empty() && is_short) take_fact(mat, v, array);
    see(std::move(array));
  }

  static void take_fact(const Opened& mat, matvar_t& v, MatArray& array) {
    if (v.data == nullptr) matio().read_data(mat.get(), &v);
    if (v.data == nullptr) return;
    if (!array.is_text) {
      if (v.nbytes < matio().size_of_class(v.class_type)) return;
      array.scalar.resize(1);
      convert(v, array.scalar);
    } else if (v.data_size == 1) {
      array.text.assign(static_cast<const char*>(v.data), v.nbytes);
    } else if (v.data_size == 2) {
      const auto* letters = static_cast<const std::uint16_t*>(v.data);
      for (std::size_t i = 0; i < v.nbytes / 2; ++i)
        array.text += letters[i] < 0x80 ? static_cast<char>(letters[i]) : '?';
    }
  }

  /// Zeros that were never written, and those deflated, take no room: but not for ever.
  void refuse_beyond_file(const MatArray& array) {
    const std::uint64_t left = most_mat_bytes(file_->size()) - bytes_;
    if (array.elements() <= left / sizeof(double)) {
      bytes_ += array.elements() * sizeof(double);
      return;
    }
    throw InputError(
        fmt::format("holds {} values, more than the file of {} bytes can", array.elements(), file_->size()),
        "the file is damaged; save it again", {file_->path(), 0, array.name});
  }

  std::vector<double> read(const Opened& mat, const std::string& name) const {
    const std::vector<std::string> path = split(name, '.');
    const Variable variable(matio().find_variable(mat.get(), path.front().c_str()));
    matvar_t* v = variable.get();
    for (std::size_t k = 1; k < path.size() && v != nullptr; ++k) {
      v = v->class_type == MAT_C_STRUCT ? matio().field_named(v, path[k].c_str(), 0) : nullptr;
    }
    if (v != nullptr && v->data == nullptr) matio().read_data(mat.get(), v);
    if (v == nullptr || v->data == nullptr || !is_numeric(*v)) {
      throw InputError("the values cannot be read", "the file is damaged; save it again", {file_->path(), 0, name});
    }
    std::vector<double> values(v->nbytes / matio().size_of_class(v->class_type));
    convert(*v, values);
    return values;
  }

  std::shared_ptr<const InputFile> file_;
  std::uint64_t bytes_ = 0;  // of the values described so far, as doubles
};

}  // namespace

std::unique_ptr<MatContents> contents_of_version_73(std::shared_ptr<const InputFile> file) {
  return std::make_unique<Version73>(std::move(file));
}

}  // namespace tribofit
