#include "tdms_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "ingest/numbers.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace tdms {

std::size_t bytes_of(std::uint32_t type) {
  switch (type) {
    case 1:
    case 5:
    case boolean:
      return 1;
    case 2:
    case 6:
      return 2;
    case 3:
    case 7:
    case 9:
    case 0x19:
      return 4;
    case 4:
    case 8:
    case 10:
    case 0x1A:
      return 8;
    case timestamp:
      return 16;
    default:
      return 0;
  }
}

double value_at(std::string_view bytes, std::size_t at, std::uint32_t type, bool big_endian, double epoch) {
  switch (type) {
    case 1:
      return number_at<std::int8_t>(bytes, at, big_endian);
    case 2:
      return number_at<std::int16_t>(bytes, at, big_endian);
    case 3:
      return number_at<std::int32_t>(bytes, at, big_endian);
    case 4:
      return static_cast<double>(number_at<std::int64_t>(bytes, at, big_endian));
    case 5:
    case boolean:
      return number_at<std::uint8_t>(bytes, at, big_endian);
    case 6:
      return number_at<std::uint16_t>(bytes, at, big_endian);
    case 7:
      return number_at<std::uint32_t>(bytes, at, big_endian);
    case 8:
      return static_cast<double>(number_at<std::uint64_t>(bytes, at, big_endian));
    case 9:
    case 0x19:
      return number_at<float>(bytes, at, big_endian);
    case timestamp: {
      // Fractions of 2^-64 s and seconds since 1904; the seconds come first where the highest byte does.
      const auto seconds = number_at<std::int64_t>(bytes, at + (big_endian ? 0 : 8), big_endian);
      const auto fractions = number_at<std::uint64_t>(bytes, at + (big_endian ? 8 : 0), big_endian);
      return (static_cast<double>(seconds) - epoch) + std::ldexp(static_cast<double>(fractions), -64);
    }
    default:
      return number_at<double>(bytes, at, big_endian);
  }
}

}  // namespace tdms

namespace {

namespace contents {  // of a segment: bits of its mask
constexpr std::uint32_t metadata = 2, new_list = 4, raw_data = 8, interleaved = 32, big_endian = 64, daqmx = 128;
}
constexpr std::size_t lead_bytes = 28;
constexpr std::size_t most_properties = 4096;  // of an object
constexpr std::uint32_t no_values = 0xFFFFFFFF, as_before = 0;
constexpr std::array<std::uint32_t, 2> daqmx_index = {0x1269, 0x126A};

/// Values of an object in each chunk of a segment.
struct Index {
  std::uint32_t type = 0;
  std::uint64_t count = 0, bytes = 0;
};

class Parser {
 public:
  Parser(const InputFile& file, std::vector<std::string>& notes) : file_(file), notes_(notes) {}

  std::vector<TdmsObject> parse() {
    for (std::uint64_t at = 0; at < file_.size();) at = segment(at);
    return std::move(objects_);
  }

 private:
  [[noreturn]] void refuse(std::uint64_t at, const std::string& problem, const char* advice = nullptr) const {
    throw InputError(fmt::format("byte {}: {}", at, problem),
                     advice != nullptr ? advice : "the file is cut off or damaged; copy or export it again",
                     {file_.path(), 0, ""});
  }

  /// Reads a segment and returns where the next one begins.
  std::uint64_t segment(std::uint64_t begin) {
    std::array<char, lead_bytes> lead;
    const std::string_view view(lead.data(), lead.size());
    if (file_.read(begin, lead) < lead_bytes) refuse(begin, "the head of a segment is cut off");
    if (!view.starts_with("TDSm")) refuse(begin, "no segment begins here");
    mask_ = number_at<std::uint32_t>(view, 4, false);
    big_endian_ = (mask_ & contents::big_endian) != 0;
    const auto version = number_at<std::uint32_t>(view, 8, big_endian_);
    if (version != 4712 && version != 4713)
      refuse(begin + 8, fmt::format("version {} of the format is not known", version));
    const auto length = number_at<std::uint64_t>(view, 12, big_endian_),
               raw = number_at<std::uint64_t>(view, 20, big_endian_);
    const std::uint64_t left = file_.size() - begin - lead_bytes;
    const bool unfinished = length == std::numeric_limits<std::uint64_t>::max();
    if (unfinished)
      notes_.push_back(fmt::format("the segment at byte {} was not finished and is read as far as it goes", begin));
    if (!unfinished && length > left)
      refuse(begin, fmt::format("a segment of {} bytes, of which {} are there", length, left));
    const std::uint64_t size = unfinished ? left : length;
    if (raw > size) refuse(begin + 20, fmt::format("values from byte {} of a segment of {} bytes", raw, size));
    if ((mask_ & contents::metadata) != 0) metadata(begin + lead_bytes, raw);
    if ((mask_ & contents::raw_data) != 0) values(begin + lead_bytes + raw, size - raw);
    return begin + lead_bytes + size;
  }

  // What describes the objects is read from a copy of these bytes of the file.
  std::string bytes_;
  std::uint64_t bytes_begin_ = 0;
  std::size_t at_ = 0;

  void need(std::uint64_t count, std::uint64_t size) const {
    if (size != 0 && count > (bytes_.size() - at_) / size) {
      refuse(bytes_begin_ + at_,
             fmt::format("{} bytes are wanted where {} are left", count * size, bytes_.size() - at_));
    }
  }
  template <class Number>
  Number number() {
    need(1, sizeof(Number));
    const auto value = number_at<Number>(bytes_, at_, big_endian_);
    at_ += sizeof(Number);
    return value;
  }
  std::string text() {
    const auto length = number<std::uint32_t>();
    need(length, 1);
    at_ += length;
    return bytes_.substr(at_ - length, length);
  }

  void metadata(std::uint64_t begin, std::uint64_t size) {
    bytes_.assign(static_cast<std::size_t>(size), '\0');
    bytes_.resize(file_.read(begin, bytes_));
    bytes_begin_ = begin;
    at_ = 0;
    if ((mask_ & contents::new_list) != 0) {
      active_.clear();
      is_active_.assign(objects_.size(), false);
    }
    for (auto count = number<std::uint32_t>(); count > 0; --count) object();
  }

  void object() {
    const std::string path = text();
    const auto [known, is_new] = object_of_.emplace(path, objects_.size());
    const std::size_t k = known->second;
    if (is_new) {
      objects_.push_back({path, names_of(path), 0, 0, {}, {}});
      indices_.emplace_back();
      is_active_.push_back(false);
    }
    const std::uint64_t index_at = bytes_begin_ + at_;
    const auto index = number<std::uint32_t>();
    if (std::find(daqmx_index.begin(), daqmx_index.end(), index) != daqmx_index.end())
      refuse_daqmx(index_at, objects_[k]);
    if (index == no_values) {
      if (is_active_[k]) std::erase(active_, k);
    } else if (!is_active_[k]) {
      active_.push_back(k);
    }
    is_active_[k] = index != no_values;
    if (index != no_values && index != as_before) read_index(index_at, k);
    for (auto count = number<std::uint32_t>(); count > 0; --count) property(objects_[k]);
  }

  [[noreturn]] void refuse_daqmx(std::uint64_t at, const TdmsObject& object) const {
    refuse(at, fmt::format("the values of {} are raw ones of DAQmx, which need its scaling", object.path),
           "export the channel scaled, as a TDMS file of doubles or as CSV");
  }

  void read_index(std::uint64_t index_at, std::size_t k) {
    Index& index = indices_[k];
    index.type = number<std::uint32_t>();
    const auto dimensions = number<std::uint32_t>();
    index.count = number<std::uint64_t>();
    if (index.type == 0xFFFFFFFF) refuse_daqmx(index_at, objects_[k]);
    if (dimensions != 1) refuse(index_at, fmt::format("{} is of {} dimensions, not one", objects_[k].path, dimensions));
    const std::size_t size = tdms::bytes_of(index.type);
    if (index.type == tdms::text) {
      index.bytes = number<std::uint64_t>();
    } else if (size == 0) {
      refuse(index_at, fmt::format("{} is of the type {:#x}, which is not read", objects_[k].path, index.type));
    } else if (index.count > file_.size()) {
      refuse(index_at,
             fmt::format("{} values of {} in a file of {} bytes", index.count, objects_[k].path, file_.size()));
    } else {
      index.bytes = index.count * size;
    }
    if (index.bytes > file_.size())
      refuse(index_at, fmt::format("{} holds {} bytes, more than the file", objects_[k].path, index.bytes));
    const bool changes = objects_[k].count > 0 && objects_[k].type != index.type;
    if (changes) refuse(index_at, fmt::format("the type of {} changes", objects_[k].path));
    objects_[k].type = index.type;
  }

  void property(TdmsObject& object) {
    TdmsProperty property;
    property.name = text();
    const std::uint64_t type_at = bytes_begin_ + at_;
    const auto type = number<std::uint32_t>();
    property.is_text = type == tdms::text;
    if (property.is_text) {
      property.text = text();
    } else {
      const std::size_t size = tdms::bytes_of(type);
      if (size == 0)
        refuse(type_at, fmt::format("the property {} is of the type {:#x}, which is not known", property.name, type));
      need(1, size);
      property.number = tdms::value_at(bytes_, at_, type, big_endian_, 0);
      at_ += size;
    }
    const auto known = std::find_if(object.properties.begin(), object.properties.end(),
                                    [&](const TdmsProperty& p) { return p.name == property.name; });
    if (object.properties.size() >= most_properties) {
      refuse(type_at, fmt::format("more than {} properties of {}", most_properties, object.path));
    }
    if (known == object.properties.end()) {
      object.properties.push_back(std::move(property));
    } else {
      *known = std::move(property);
    }
  }

  /// "/'Measured Data'/'Sweep'": names are quoted, and a quote in them is doubled.
  static std::vector<std::string> names_of(const std::string& path) {
    std::vector<std::string> names;
    for (std::size_t at = 0; at + 1 < path.size();) {
      if (path[at] != '/' || path[at + 1] != '\'') return names;
      names.emplace_back();
      for (at += 2; at < path.size(); ++at) {
        if (path[at] == '\'' && (at + 1 >= path.size() || path[at + 1] != '\'')) break;
        if (path[at] == '\'') ++at;
        names.back() += path[at];
      }
      ++at;
    }
    return names;
  }

  /// Notes where the values of a segment are: chunks of the same build, as many as it holds.
  void values(std::uint64_t begin, std::uint64_t size) {
    if ((mask_ & contents::daqmx) != 0)
      refuse(begin, "raw values of DAQmx, which need its scaling",
             "export the channels scaled, as a TDMS file of doubles or as CSV");
    std::uint64_t chunk = 0, sample = 0;
    for (const std::size_t k : active_) {
      chunk += indices_[k].bytes;
      sample += tdms::bytes_of(indices_[k].type);
    }
    if (chunk == 0 || size == 0) return;
    if ((mask_ & contents::interleaved) != 0) return interleaved(begin, size, sample);
    if (size % chunk != 0) refuse(begin, fmt::format("{} bytes of values in chunks of {}", size, chunk));
    std::vector<std::size_t> filled;
    std::copy_if(active_.begin(), active_.end(), std::back_inserter(filled),
                 [&](std::size_t k) { return indices_[k].bytes > 0; });
    for (std::uint64_t done = 0; done < size; done += chunk) {
      std::uint64_t at = begin + done;
      for (const std::size_t k : filled) {
        const std::size_t bytes = tdms::bytes_of(indices_[k].type);
        if (bytes > 0) add({at, indices_[k].count, bytes, big_endian_}, objects_[k]);
        at += indices_[k].bytes;
      }
    }
  }

  void interleaved(std::uint64_t begin, std::uint64_t size, std::uint64_t sample) {
    for (const std::size_t k : active_) {
      if (indices_[k].type == tdms::text || indices_[k].count != indices_[active_.front()].count) {
        refuse(begin, fmt::format("{} cannot be interleaved with the other channels", objects_[k].path));
      }
    }
    if (size % sample != 0) refuse(begin, fmt::format("{} bytes of values in samples of {}", size, sample));
    std::uint64_t at = begin;
    for (const std::size_t k : active_) {
      add({at, size / sample, sample, big_endian_}, objects_[k]);
      at += tdms::bytes_of(indices_[k].type);
    }
  }

  static void add(const TdmsPiece& piece, TdmsObject& object) {
    object.count += piece.count;
    if (!object.pieces.empty()) {
      TdmsPiece& last = object.pieces.back();
      const bool goes_on = last.begin + last.count * last.stride == piece.begin && last.stride == piece.stride &&
                           last.big_endian == piece.big_endian;
      if (goes_on) {
        last.count += piece.count;
        return;
      }
    }
    if (piece.count > 0) object.pieces.push_back(piece);
  }

  const InputFile& file_;
  std::vector<std::string>& notes_;
  std::uint32_t mask_ = 0;
  bool big_endian_ = false;
  std::vector<TdmsObject> objects_;
  std::vector<Index> indices_;                    // of each object, the last one stated
  std::map<std::string, std::size_t> object_of_;  // path
  std::vector<std::size_t> active_;               // objects with values in the segment, in their order
  std::vector<bool> is_active_;                   // of each object
};

}  // namespace

const TdmsProperty* TdmsObject::find(std::string_view name) const {
  const auto at =
      std::find_if(properties.begin(), properties.end(), [&](const TdmsProperty& p) { return p.name == name; });
  return at != properties.end() ? &*at : nullptr;
}

std::vector<TdmsObject> read_tdms_objects(const InputFile& file, std::vector<std::string>& notes) {
  return Parser(file, notes).parse();
}

}  // namespace tribofit
