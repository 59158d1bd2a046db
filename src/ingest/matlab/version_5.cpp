#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include "byte_stream.hpp"
#include "contents.hpp"
#include "ingest/huge_pages.hpp"
#include "ingest/limits.hpp"
#include "ingest/numbers.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/statistics/parallel.hpp"

// After "MAT-File Format" (The MathWorks), level 5: a header of 128 bytes, then elements. An element is a tag of type
// and size, its bytes, and zeros up to a multiple of eight. A variable is an element "matrix": flags, sizes, name,
// values; or one "compressed", which holds the other deflated.

namespace tribofit {
namespace {

namespace element {
constexpr std::uint32_t utf8 = 16, utf16 = 17, matrix = 14, compressed = 15;
}
namespace array_class {
constexpr std::uint32_t cell = 1, structure = 2, object = 3, character = 4, sparse = 5, first_number = 6,
                        last_number = 15;
}

/// Bytes of a number of this type of element; 0: none.
std::size_t bytes_of(std::uint32_t type) {
  static constexpr std::array<std::size_t, 18> bytes = {0, 1, 1, 2, 2, 4, 4, 4, 0, 8, 0, 0, 8, 8, 0, 0, 1, 2};
  return type < bytes.size() ? bytes[type] : 0;
}

struct Tag {
  std::uint32_t type = 0, size = 0;
  std::array<char, 4> small{};  // the bytes of an element of up to four
  bool is_small = false;
};

template <class Number>
void convert(std::string_view bytes, bool big_endian, double* out) {
  for (std::size_t i = 0; i < bytes.size() / sizeof(Number); ++i) {
    out[i] = static_cast<double>(number_at<Number>(bytes, i * sizeof(Number), big_endian));
  }
}

void convert(std::uint32_t type, std::string_view bytes, bool big_endian, double* out) {
  switch (type) {
    case 1:
      return convert<std::int8_t>(bytes, big_endian, out);
    case 2:
      return convert<std::uint8_t>(bytes, big_endian, out);
    case 3:
      return convert<std::int16_t>(bytes, big_endian, out);
    case 4:
      return convert<std::uint16_t>(bytes, big_endian, out);
    case 5:
      return convert<std::int32_t>(bytes, big_endian, out);
    case 6:
      return convert<std::uint32_t>(bytes, big_endian, out);
    case 7:
      return convert<float>(bytes, big_endian, out);
    case 9:
      return convert<double>(bytes, big_endian, out);
    case 12:
      return convert<std::int64_t>(bytes, big_endian, out);
    default:
      return convert<std::uint64_t>(bytes, big_endian, out);
  }
}

/// Walks through one variable and its fields. `wants` says for which arrays of numbers the values are read.
class Walk {
 public:
  using Wants = std::function<std::vector<double>*(const MatArray&)>;
  /// `arrays`: how many more there may be.
  Walk(ByteStream& stream, bool big_endian, std::size_t& arrays, std::function<void(MatArray&&)> see, Wants wants)
      : stream_(stream), big_endian_(big_endian), arrays_(arrays), see_(std::move(see)), wants_(std::move(wants)) {}

  /// The variable's element; `name` is that of a field, whose own is empty.
  void matrix(const std::string& name, int depth) {
    const Tag tag = next_tag();
    if (tag.type != element::matrix || tag.is_small)
      stream_.refuse(fmt::format("an element of type {} where an array begins", tag.type));
    if (arrays_-- == 0) stream_.refuse(fmt::format("more than {} arrays", kMostMatArrays));
    stream_.expect(tag.size, "an array");
    const std::uint64_t end = stream_.position() + tag.size;
    if (tag.size > 0) {
      inside(name, depth);
    } else {
      see_({name, {0, 0}, "", false, {}, ""});
    }
    if (stream_.position() > end) stream_.refuse("the parts of an array are longer than it is");
    stream_.skip(end - stream_.position());
  }

 private:
  Tag next_tag() {
    std::array<char, 8> bytes;
    stream_.read(bytes);
    const std::string_view view(bytes.data(), bytes.size());
    Tag tag;
    const auto first = number_at<std::uint32_t>(view, 0, big_endian_);
    tag.is_small = (first >> 16) != 0;
    tag.type = tag.is_small ? first & 0xFFFF : first;
    tag.size = tag.is_small ? first >> 16 : number_at<std::uint32_t>(view, 4, big_endian_);
    std::copy(bytes.begin() + 4, bytes.end(), tag.small.begin());
    if (tag.is_small && tag.size > tag.small.size())
      stream_.refuse(fmt::format("an element of type {} and {} bytes in four", tag.type, tag.size));
    return tag;
  }

  static std::uint64_t padding(std::uint64_t size) { return (8 - size % 8) % 8; }

  /// The bytes of a short element.
  std::string bytes_of_element(const Tag& tag, std::uint64_t most) {
    if (tag.size > most) stream_.refuse(fmt::format("an element of {} bytes where up to {} can be", tag.size, most));
    if (tag.is_small) return std::string(tag.small.data(), tag.size);
    std::string bytes(tag.size, '\0');
    stream_.read(bytes);
    stream_.skip(padding(tag.size));
    return bytes;
  }

  void inside(const std::string& field, int depth) {
    const std::string flags = bytes_of_element(next_tag(), 16);
    if (flags.size() < 8) stream_.refuse("an array without flags");
    const auto word = number_at<std::uint32_t>(flags, 0, big_endian_);
    const std::uint32_t type = word & 0xFF;
    const bool is_complex = (word & 0x0800) != 0;
    MatArray array;
    if (type > array_class::last_number) {  // objects have no sizes of this form
      array.kind = "an object";
      array.name = field;
      if (!field.empty()) see_(std::move(array));
      return;
    }
    const std::string sizes = bytes_of_element(next_tag(), 4 * kMostMatDimensions);
    for (std::size_t at = 0; at + 4 <= sizes.size(); at += 4) {
      const auto size = number_at<std::int32_t>(sizes, at, big_endian_);
      if (size < 0) stream_.refuse(fmt::format("an array of {} rows or columns", size));
      array.sizes.push_back(static_cast<std::uint64_t>(size));
    }
    const std::string name = bytes_of_element(next_tag(), kLongestMatName);
    array.name = field.empty() ? name.substr(0, name.find('\0')) : field;
    if (array.name.empty()) return;  // what belongs to objects
    if (type == array_class::structure && array.elements() == 1 && depth < kDeepestMatStructure)
      return fields(array.name, depth);
    const bool is_number = type >= array_class::first_number && !is_complex;
    if (is_number || type == array_class::character) return values(std::move(array), type == array_class::character);
    array.kind = is_complex                       ? "a complex array"
                 : type == array_class::cell      ? "a cell array"
                 : type == array_class::structure ? "an array of structures"
                 : type == array_class::sparse    ? "a sparse array"
                                                  : "an object";
    see_(std::move(array));
  }

  void fields(const std::string& name, int depth) {
    const std::string length = bytes_of_element(next_tag(), 8);
    const auto size = length.size() >= 4 ? number_at<std::int32_t>(length, 0, big_endian_) : 0;
    if (size <= 0 || static_cast<std::uint64_t>(size) > kLongestMatName)
      stream_.refuse(fmt::format("names of fields of {} bytes", size));
    const std::string names = bytes_of_element(next_tag(), kMostMatNameBytes);
    for (std::size_t at = 0; at < names.size(); at += static_cast<std::size_t>(size)) {
      const std::string field = names.substr(at, static_cast<std::size_t>(size));
      matrix(name + "." + field.substr(0, field.find('\0')), depth + 1);
    }
  }

  void values(MatArray array, bool is_text) {
    const std::uint64_t count = array.elements();
    array.is_text = is_text;
    if (count == 0) return see_(std::move(array));
    const Tag tag = next_tag();
    const std::size_t size = bytes_of(tag.type);
    if (!tag.is_small) stream_.expect(tag.size, "values of " + array.name);
    if (is_text) {
      if (tag.size <= kLongestMatText) array.text = text_of(bytes_of_element(tag, kLongestMatText), size);
      return see_(std::move(array));
    }
    if (size == 0 || tag.type == element::utf8 || tag.type == element::utf16 || tag.size / size != count ||
        tag.size % size != 0) {
      stream_.refuse(
          fmt::format("{} has {} elements and {} bytes of type {} for them", array.name, count, tag.size, tag.type));
    }
    std::vector<double> one;
    std::vector<double>* wanted = count == 1 ? &one : wants_(array);
    if (wanted != nullptr) read_numbers(tag, count, *wanted);
    if (count == 1) array.scalar = one;
    see_(std::move(array));
  }

  void read_numbers(const Tag& tag, std::uint64_t count, std::vector<double>& out) {
    out.reserve(count);
    prefer_huge_pages(out, out.capacity());
    out.resize(count);
    const bool as_here = tag.type == 9 && big_endian_ == (std::endian::native == std::endian::big);
    if (as_here && !tag.is_small) {
      stream_.read({reinterpret_cast<char*>(out.data()), out.size() * sizeof(double)});
      return;
    }
    if (tag.is_small) return convert(tag.type, {tag.small.data(), tag.size}, big_endian_, out.data());
    const std::size_t size = bytes_of(tag.type);
    std::vector<char> part(1 << 16);
    for (std::size_t done = 0; done < out.size();) {
      const std::size_t now = std::min(out.size() - done, part.size() / size);
      stream_.read(std::span(part).first(now * size));
      convert(tag.type, {part.data(), now * size}, big_endian_, out.data() + done);
      done += now;
    }
  }

  /// Letters of ASCII; others are '?'.
  std::string text_of(const std::string& bytes, std::size_t size) const {
    if (size <= 1) return bytes;
    std::string text;
    for (std::size_t at = 0; at + size <= bytes.size(); at += size) {
      const auto letter = size == 2 ? number_at<std::uint16_t>(bytes, at, big_endian_) : 0xFFFFU;
      text += letter < 0x80 ? static_cast<char>(letter) : '?';
    }
    return text;
  }

  ByteStream& stream_;
  bool big_endian_;
  std::size_t& arrays_;
  std::function<void(MatArray&&)> see_;
  Wants wants_;
};

class Version5 : public MatContents {
 public:
  explicit Version5(std::shared_ptr<const InputFile> file) : file_(std::move(file)) {
    std::string header(mat_header_bytes, '\0');
    file_->read(0, header);
    big_endian_ = is_mat_big_endian(header);
    find_variables();
  }

  void describe(const std::function<void(MatArray&&)>& see) override {
    std::size_t arrays = kMostMatArrays;
    std::uint64_t values = 0, inflated = 0;  // bytes of all variables
    const std::uint64_t most = most_mat_bytes(file_->size());
    for (std::size_t k = 0; k < variables_.size(); ++k) {
      const Variable& variable = variables_[k];
      ByteStream stream(*file_, variable.begin, variable.end, variable.compressed, most - inflated);
      const auto noting = [&](MatArray&& array) {
        if (array.kind.empty() && !array.is_text) {
          if (array.elements() > (most - values) / sizeof(double)) stream.refuse_bomb();
          values += array.elements() * sizeof(double);
        }
        variable_of_.emplace(array.name, k);
        see(std::move(array));
      };
      Walk(stream, big_endian_, arrays, noting, [](const MatArray&) { return nullptr; }).matrix("", 0);
      if (variable.compressed) inflated += stream.position();
    }
  }

  std::vector<MatValues> load(std::span<const std::string> names, int threads) override {
    std::vector<MatValues> values(names.size());
    std::map<std::size_t, std::vector<std::size_t>> wanted;  // by variable
    for (std::size_t i = 0; i < names.size(); ++i) wanted[variable_of_.at(names[i])].push_back(i);
    const std::vector<std::pair<std::size_t, std::vector<std::size_t>>> jobs(wanted.begin(), wanted.end());
    std::vector<std::exception_ptr> failures(jobs.size());
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
      for (std::size_t j = next++; j < jobs.size(); j = next++) {
        try {
          load(jobs[j].first, jobs[j].second, names, values);
        } catch (const InputError& error) {
          for (const std::size_t i : jobs[j].second) values[i].refusal = error;
        } catch (...) {
          failures[j] = std::current_exception();
        }
      }
    };
    const std::size_t most = static_cast<std::size_t>(threads > 0 ? threads : available_threads());
    {
      const HelperThreads others(std::max<std::size_t>(1, std::min(most, jobs.size())) - 1, work);
      work();
    }
    for (const std::exception_ptr& failure : failures) {
      if (failure) std::rethrow_exception(failure);
    }
    return values;
  }

 private:
  struct Variable {
    std::uint64_t begin, end;
    bool compressed;
  };

  void load(std::size_t variable, const std::vector<std::size_t>& which, std::span<const std::string> names,
            std::vector<MatValues>& values) const {
    const Variable& place = variables_[variable];
    ByteStream stream(*file_, place.begin, place.end, place.compressed, most_mat_bytes(file_->size()));
    std::size_t arrays = kMostMatArrays;
    const auto wants = [&](const MatArray& array) -> std::vector<double>* {
      for (const std::size_t i : which) {
        if (names[i] == array.name && values[i].numbers.empty()) return &values[i].numbers;
      }
      return nullptr;
    };
    Walk(
        stream, big_endian_, arrays, [](MatArray&&) {}, wants)
        .matrix("", 0);
  }

  void find_variables() {
    std::array<char, 8> tag;
    for (std::uint64_t at = mat_header_bytes; at < file_->size();) {
      const ByteStream place(*file_, at, file_->size(), false);
      if (file_->read(at, tag) < tag.size()) place.refuse("the head of a variable is cut off");
      const std::string_view bytes(tag.data(), tag.size());
      const auto type = number_at<std::uint32_t>(bytes, 0, big_endian_);
      const std::uint64_t size = number_at<std::uint32_t>(bytes, 4, big_endian_);
      const bool compressed = type == element::compressed;
      if (type != element::matrix && !compressed)
        place.refuse(fmt::format("an element of type {} where a variable begins", type));
      const std::uint64_t left = file_->size() - at - tag.size();
      if (size > left) place.refuse(fmt::format("a variable of {} bytes, of which {} are there", size, left));
      if (variables_.size() == kMostMatArrays) place.refuse(fmt::format("more than {} variables", kMostMatArrays));
      const std::uint64_t end = at + tag.size() + size;
      variables_.push_back({compressed ? at + tag.size() : at, end, compressed});
      at = end;
    }
  }

  std::shared_ptr<const InputFile> file_;
  bool big_endian_ = false;
  std::vector<Variable> variables_;
  std::map<std::string, std::size_t> variable_of_;  // array
};

}  // namespace

std::unique_ptr<MatContents> contents_of_version_5(std::shared_ptr<const InputFile> file) {
  return std::make_unique<Version5>(std::move(file));
}

}  // namespace tribofit
