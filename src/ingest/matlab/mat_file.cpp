#include "mat_file.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <matio.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "ingest/limits.hpp"
#include "ingest/numbers.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MatArray, name, sizes, kind, is_text, scalar, text)

namespace {

/// The functions of libmatio, which is loaded for the first MATLAB file: it brings HDF5 and all that HDF5 may need, and
/// every start would pay for what few files need.
struct Matio {
  void* library = ::dlopen(TRIBOFIT_MATIO_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  const char* trouble = library == nullptr ? ::dlerror() : nullptr;
#define TRIBOFIT_MATIO(name) \
  decltype(&::name) name = library == nullptr ? nullptr : reinterpret_cast<decltype(&::name)>(::dlsym(library, #name))
  TRIBOFIT_MATIO(Mat_LogInitFunc);
  TRIBOFIT_MATIO(Mat_Open);
  TRIBOFIT_MATIO(Mat_Close);
  TRIBOFIT_MATIO(Mat_VarReadNextInfo);
  TRIBOFIT_MATIO(Mat_VarReadDataAll);
  TRIBOFIT_MATIO(Mat_VarFree);
  TRIBOFIT_MATIO(Mat_VarGetNumberOfFields);
  TRIBOFIT_MATIO(Mat_VarGetStructFieldnames);
  TRIBOFIT_MATIO(Mat_VarGetStructFieldByIndex);
#undef TRIBOFIT_MATIO
};

const Matio& matio() {
  static const Matio loaded;
  return loaded;
}

struct FreeVariable {
  void operator()(matvar_t* variable) const { matio().Mat_VarFree(variable); }
};
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

/// Bytes that the values of a file may take, inflated and as doubles.
std::uint64_t most_bytes(const InputFile& file) {
  constexpr std::uint64_t kBeside = std::uint64_t{1} << 20;
  return (file.size() + kBeside) * kMostInflated;
}

// ---- what runs in a process of its own

bool is_numeric(const matvar_t& v) {
  return v.class_type >= MAT_C_DOUBLE && v.class_type <= MAT_C_UINT64 && v.isComplex == 0;
}

const NumberType& type_of(const matvar_t& v) {
  static constexpr std::array types = {
      number_type<double>,       number_type<float>,         number_type<std::int8_t>,  number_type<std::uint8_t>,
      number_type<std::int16_t>, number_type<std::uint16_t>, number_type<std::int32_t>, number_type<std::uint32_t>,
      number_type<std::int64_t>, number_type<std::uint64_t>};
  return types.at(static_cast<std::size_t>(v.class_type - MAT_C_DOUBLE));
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

/// The file in the hands of libmatio.
class MatFile {
 public:
  explicit MatFile(const InputFile& file) : file_(file), mat_(nullptr, matio().Mat_Close) {
    matio().Mat_LogInitFunc("", [](int, char*) {});  // what went wrong is said by an InputError
    mat_.reset(matio().Mat_Open(file.path().c_str(), MAT_ACC_RDONLY));
    if (!mat_) refuse("is a MATLAB file that cannot be opened: it is cut off or damaged", "");
  }

  /// All arrays, those of `variables` variables at least.
  std::vector<MatArray> describe(std::size_t variables) {
    std::vector<MatArray> arrays;
    const std::size_t number = visit_all([&](matvar_t& v, MatArray array) {
      if (arrays.size() == kMostMatArrays) refuse(fmt::format("holds more than {} arrays", kMostMatArrays), "");
      describe(v, array);
      arrays.push_back(std::move(array));
    });
    if (number < variables) refuse(fmt::format("{} of {} variables cannot be read", variables - number, variables), "");
    return arrays;
  }

  /// Answers with the values of columns, in the order of their arrays.
  void answer(const std::vector<MatColumn>& sources, const Answers& answers) {
    auto source = sources.begin();
    std::size_t number = 0;
    visit_all([&](matvar_t& v, const MatArray&) {
      for (; source != sources.end() && source->array == number; ++source) {
        try {
          const std::vector<double> values = values_of(v, *source);
          answers.send({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)});
        } catch (const InputError& error) {
          answers.refuse(error);
        }
      }
      ++number;
    });
  }

 private:
  [[noreturn]] void refuse(const std::string& problem, const std::string& array) const {
    throw InputError(problem, "the file is damaged; copy or save it again, with save(..., '-v7')",
                     {file_.path(), 0, array});
  }

  /// Called with an array, and with its name and sizes.
  using Visit = std::function<void(matvar_t& v, MatArray array)>;

  /// Goes through the arrays, and returns the number of variables.
  std::size_t visit_all(const Visit& visit) {
    std::size_t number = 0;
    for (;; ++number) {
      const Variable v(matio().Mat_VarReadNextInfo(mat_.get()));
      if (!v) return number;
      if (v->name != nullptr && *v->name != '\0') visit_in(*v, v->name, 0, visit);
    }
  }

  void visit_in(matvar_t& v, const std::string& name, std::size_t depth, const Visit& visit) {
    MatArray array;
    array.name = name;
    array.sizes.assign(v.dims, v.dims + std::max(0, v.rank));
    const unsigned fields = v.class_type == MAT_C_STRUCT ? matio().Mat_VarGetNumberOfFields(&v) : 0;
    if (fields == 0 || array.elements() != 1 || depth >= kDeepestMatStructure) return visit(v, std::move(array));
    char* const* names = matio().Mat_VarGetStructFieldnames(&v);
    for (unsigned k = 0; k < fields; ++k) {
      matvar_t* field = matio().Mat_VarGetStructFieldByIndex(&v, k, 0);
      if (field != nullptr) visit_in(*field, name + "." + names[k], depth + 1, visit);
    }
  }

  void describe(matvar_t& v, MatArray& array) {
    array.is_text = v.class_type == MAT_C_CHAR;
    if (is_numeric(v)) {
      count_bytes(array);
    } else if (v.class_type == MAT_C_EMPTY) {
      array.sizes = {0, 0};
    } else if (!array.is_text) {
      array.kind = kind_of(v);
    }
    const bool is_short = array.elements() > 0 && array.elements() <= (array.is_text ? kLongestMatText : 1);
    if (array.kind.empty() && is_short) take_fact(v, array);
  }

  bool has_data(matvar_t& v) const {
    return v.data != nullptr || (matio().Mat_VarReadDataAll(mat_.get(), &v) == 0 && v.data != nullptr);
  }

  void take_fact(matvar_t& v, MatArray& array) const {
    if (!has_data(v)) return;
    const std::string_view bytes(static_cast<const char*>(v.data), v.nbytes);
    if (!array.is_text) {
      if (bytes.size() >= type_of(v).bytes) array.scalar = {type_of(v).at(bytes, 0, native_big_endian)};
    } else if (v.data_size == 1) {
      array.text = bytes;
    } else if (v.data_size == 2) {
      for (std::size_t at = 0; at + 2 <= bytes.size(); at += 2) {
        const auto letter = number_at<std::uint16_t>(bytes, at, native_big_endian);
        array.text += letter < 0x80 ? static_cast<char>(letter) : '?';
      }
    }
  }

  /// Zeros that were never written, and those deflated, take no room: but not for ever.
  void count_bytes(const MatArray& array) {
    if (array.elements() > (most_bytes(file_) - bytes_) / sizeof(double)) {
      refuse(fmt::format("holds {} values, more than the file of {} bytes can", array.elements(), file_.size()),
             array.name);
    }
    bytes_ += array.elements() * sizeof(double);
  }

  std::vector<double> values_of(matvar_t& v, const MatColumn& source) const {
    if (source.count == 0) throw InputError("the vector is empty", "name another one with " + setting("columns"));
    if (!is_numeric(v) || !has_data(v)) refuse("the values cannot be read", "");
    const NumberType& type = type_of(v);
    const std::string_view bytes(static_cast<const char*>(v.data), v.nbytes);
    if (bytes.size() / type.bytes <= source.first + (source.count - 1) * source.stride)
      refuse(fmt::format("the {} values of the vector are not all in the file", source.count), "");
    std::vector<double> values(source.count);
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = type.at(bytes, (source.first + i * source.stride) * type.bytes, native_big_endian);
    return values;
  }

  const InputFile& file_;
  std::unique_ptr<mat_t, decltype(&::Mat_Close)> mat_;
  std::uint64_t bytes_ = 0;  // of the values described so far, as doubles
};

/// Memory that libmatio may take: the values, and they again in the answer.
std::uint64_t memory_for(const InputFile& file) {
  return 3 * most_bytes(file);
}

}  // namespace

std::uint64_t MatArray::elements() const {
  std::uint64_t count = sizes.empty() ? 0 : 1;
  for (const std::uint64_t size : sizes) {
    if (size != 0 && count > std::numeric_limits<std::uint64_t>::max() / size)
      return std::numeric_limits<std::uint64_t>::max();
    count *= size;
  }
  return count;
}

std::vector<MatArray> describe_mat_file(const InputFile& file, std::size_t variables) {
  if (matio().trouble != nullptr) {
    throw InputError(std::string("is a MATLAB file, and libmatio cannot be loaded: ") + matio().trouble, "install it",
                     {file.path(), 0, ""});
  }
  Apart process(file.path(), memory_for(file), [&](const Answers& answers) {
    const auto bytes = nlohmann::json::to_msgpack(MatFile(file).describe(variables));
    answers.send({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  });
  return nlohmann::json::from_msgpack(process.next<std::string>()).get<std::vector<MatArray>>();
}

Apart read_mat_columns(const InputFile& file, std::vector<MatColumn> columns) {
  return Apart(file.path(), memory_for(file), [&](const Answers& answers) { MatFile(file).answer(columns, answers); });
}

}  // namespace tribofit
