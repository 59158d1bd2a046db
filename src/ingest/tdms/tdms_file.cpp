#include "tdms_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "active_objects.hpp"
#include "ingest/byte_cursor.hpp"
#include "ingest/limits.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace tdms {

namespace {

/// Types of numbers, by their numbers in the file; nullptr: another type.
const NumberType* find_type(std::uint32_t type) {
  static const std::map<std::uint32_t, NumberType> types = {
      {1, number_type<std::int8_t>},   {2, number_type<std::int16_t>},       {3, number_type<std::int32_t>},
      {4, number_type<std::int64_t>},  {5, number_type<std::uint8_t>},       {6, number_type<std::uint16_t>},
      {7, number_type<std::uint32_t>}, {8, number_type<std::uint64_t>},      {9, number_type<float>},
      {10, number_type<double>},       {boolean, number_type<std::uint8_t>}, {0x19, number_type<float>},
      {0x1A, number_type<double>}};
  const auto found = types.find(type);
  return found == types.end() ? nullptr : &found->second;
}

}  // namespace

std::size_t bytes_of(std::uint32_t type) {
  const NumberType* known = find_type(type);
  return known != nullptr ? known->bytes : type == timestamp ? 16 : 0;
}

double value_at(std::string_view bytes, std::size_t at, std::uint32_t type, bool big_endian, double epoch) {
  if (type != timestamp) return find_type(type)->at(bytes, at, big_endian);
  // Fractions of 2^-64 s and seconds since 1904; the seconds come first where the highest byte does.
  const auto seconds = number_at<std::int64_t>(bytes, at + (big_endian ? 0 : 8), big_endian);
  const auto fractions = number_at<std::uint64_t>(bytes, at + (big_endian ? 8 : 0), big_endian);
  return (static_cast<double>(seconds) - epoch) + std::ldexp(static_cast<double>(fractions), -64);
}

}  // namespace tdms

namespace {

namespace contents {  // of a segment: bits of its mask
constexpr std::uint32_t metadata = 2, new_list = 4, raw_data = 8, interleaved = 32, big_endian = 64, daqmx = 128;
}
constexpr std::size_t lead_bytes = 28;
constexpr std::uint32_t no_values = 0xFFFFFFFF, as_before = 0;
constexpr std::array<std::uint32_t, 2> daqmx_index = {0x1269, 0x126A};

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
    unfinished_ = length == std::numeric_limits<std::uint64_t>::max();
    if (unfinished_)
      notes_.push_back(fmt::format("the segment at byte {} was not finished and is read as far as it goes", begin));
    if (!unfinished_ && length > left)
      refuse(begin, fmt::format("a segment of {} bytes, of which {} are there", length, left));
    const std::uint64_t size = unfinished_ ? left : length;
    if (raw > size) {
      if (unfinished_) return file_.size();  // what describes its objects was not written to its end
      refuse(begin + 20, fmt::format("values from byte {} of a segment of {} bytes", raw, size));
    }
    if ((mask_ & contents::metadata) != 0) metadata(begin + lead_bytes, raw);
    if ((mask_ & contents::raw_data) != 0) values(begin + lead_bytes + raw, size - raw);
    return begin + lead_bytes + size;
  }

  void metadata(std::uint64_t begin, std::uint64_t size) {
    std::string bytes(static_cast<std::size_t>(size), '\0');
    bytes.resize(file_.read(begin, bytes));
    begin_ = begin;
    described_.emplace(std::move(bytes), [this](std::uint64_t wanted, std::uint64_t there) {
      refuse(at(), fmt::format("{} bytes are wanted where {} are left", wanted, there));
    });
    if ((mask_ & contents::new_list) != 0) active_.clear();
    for (auto count = number<std::uint32_t>(); count > 0; --count) object();
  }

  /// Where the description is being read, in the file.
  std::uint64_t at() const { return begin_ + described_->position(); }
  template <class Number>
  Number number() {
    return described_->number<Number>(big_endian_);
  }
  std::string text() { return described_->text(big_endian_); }

  void object() {
    const std::string path = text();
    const auto [known, is_new] = object_of_.emplace(path, objects_.size());
    const std::size_t k = known->second;
    if (is_new) {
      if (objects_.size() == kMostTdmsObjects)
        refuse(at(), fmt::format("more than {} groups and channels", kMostTdmsObjects), "export fewer channels");
      objects_.push_back({path, names_of(path), 0, 0, {}, {}});
      indices_.emplace_back();
    }
    const std::uint64_t index_at = at();
    const auto index = number<std::uint32_t>();
    if (std::find(daqmx_index.begin(), daqmx_index.end(), index) != daqmx_index.end())
      refuse_daqmx(index_at, objects_[k]);
    if (index != no_values && index != as_before) read_index(index_at, k);
    if (index == no_values) {
      active_.remove(k);
    } else {
      active_.put(k, indices_[k]);
    }
    for (auto count = number<std::uint32_t>(); count > 0; --count) property(k);
  }

  [[noreturn]] void refuse_daqmx(std::uint64_t at, const TdmsObject& object) const {
    refuse(at, fmt::format("the values of {} are raw ones of DAQmx, which need its scaling", object.path),
           "export the channel scaled, as a TDMS file of doubles or as CSV");
  }

  void read_index(std::uint64_t index_at, std::size_t k) {
    TdmsIndex& index = indices_[k];
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
    } else if (index.count > file_.size() && !unfinished_) {
      refuse(index_at,
             fmt::format("{} values of {} in a file of {} bytes", index.count, objects_[k].path, file_.size()));
    } else {
      index.bytes = std::min(index.count, file_.size() + 1) * size;
    }
    if (index.bytes > file_.size() && !unfinished_)
      refuse(index_at, fmt::format("{} holds {} bytes, more than the file", objects_[k].path, index.bytes));
    index.bytes = std::min(index.bytes, file_.size() + 1);  // of which no whole chunk can be there
    const bool changes = objects_[k].count > 0 && objects_[k].type != index.type;
    if (changes) refuse(index_at, fmt::format("the type of {} changes", objects_[k].path));
    objects_[k].type = index.type;
  }

  void property(std::size_t k) {
    TdmsObject& object = objects_[k];
    TdmsProperty property;
    property.name = text();
    const std::uint64_t type_at = at();
    const auto type = number<std::uint32_t>();
    property.is_text = type == tdms::text;
    if (property.is_text) {
      property.text = text();
    } else {
      const std::size_t size = tdms::bytes_of(type);
      if (size == 0)
        refuse(type_at, fmt::format("the property {} is of the type {:#x}, which is not known", property.name, type));
      described_->need(1, size);
      property.number = tdms::value_at(described_->bytes(), described_->position(), type, big_endian_, 0);
      described_->skip(size);
    }
    const auto [known, is_new] = property_of_.emplace(std::pair(k, property.name), object.properties.size());
    if (!is_new) {
      object.properties[known->second] = std::move(property);
      return;
    }
    if (object.properties.size() >= kMostTdmsProperties) {
      refuse(type_at, fmt::format("more than {} properties of {}", kMostTdmsProperties, object.path));
    }
    object.properties.push_back(std::move(property));
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
    const std::uint64_t chunk = active_.chunk_bytes();
    if (chunk == 0 || size == 0) return;
    if ((mask_ & contents::interleaved) != 0) return interleaved(begin, size);
    if (unfinished_) size -= size % chunk;
    if (size % chunk != 0) refuse(begin, fmt::format("{} bytes of values in chunks of {}", size, chunk));
    if (size == 0) return;
    std::uint64_t at = begin;
    for (const auto& [place, k] : active_.with_values()) {
      const std::size_t bytes = tdms::bytes_of(indices_[k].type);
      if (bytes > 0) add({at, indices_[k].count, bytes, size / chunk, chunk, big_endian_}, objects_[k]);
      at += indices_[k].bytes;
    }
  }

  void interleaved(std::uint64_t begin, std::uint64_t size) {
    const auto& channels = active_.with_values();
    for (const auto& [place, k] : channels) {
      if (indices_[k].type == tdms::text || indices_[k].count != indices_[channels.begin()->second].count) {
        refuse(begin, fmt::format("{} cannot be interleaved with the other channels", objects_[k].path));
      }
    }
    const std::uint64_t sample = active_.sample_bytes();
    if (unfinished_) size -= size % sample;
    if (size % sample != 0) refuse(begin, fmt::format("{} bytes of values in samples of {}", size, sample));
    std::uint64_t at = begin;
    for (const auto& [place, k] : channels) {
      if (size > 0) add({at, size / sample, sample, 1, 0, big_endian_}, objects_[k]);
      at += tdms::bytes_of(indices_[k].type);
    }
  }

  void add(TdmsPiece piece, TdmsObject& object) {
    object.count += piece.count * piece.chunks;
    if (piece.chunk_stride == piece.count * piece.stride) {  // one chunk goes on in the next
      piece.count *= piece.chunks;
      piece.chunks = 1;
    }
    if (!object.pieces.empty() && goes_on(object.pieces.back(), piece)) return;
    if (++pieces_ > kMostTdmsPieces) {
      refuse(piece.begin, fmt::format("the values are in more than {} pieces", kMostTdmsPieces),
             "defragment the file in LabVIEW, or export it as CSV");
    }
    object.pieces.push_back(piece);
  }

  /// Lengthens the last piece by the next one, where it is of the same build.
  static bool goes_on(TdmsPiece& last, const TdmsPiece& next) {
    if (last.stride != next.stride || last.big_endian != next.big_endian || next.begin < last.begin) return false;
    if (last.chunks == 1 && next.chunks == 1 && last.begin + last.count * last.stride == next.begin) {
      last.count += next.count;
      return true;
    }
    const std::uint64_t stride = last.chunks > 1 ? last.chunk_stride : next.begin - last.begin;
    const bool same = last.count == next.count && last.begin + last.chunks * stride == next.begin &&
                      (next.chunks == 1 || next.chunk_stride == stride);
    if (!same) return false;
    last.chunk_stride = stride;
    last.chunks += next.chunks;
    return true;
  }

  const InputFile& file_;
  std::vector<std::string>& notes_;
  std::uint32_t mask_ = 0;
  bool big_endian_ = false, unfinished_ = false;  // the segment
  std::optional<ByteCursor> described_;           // a copy of what describes the objects of a segment
  std::uint64_t begin_ = 0;                       // of it, in the file
  std::vector<TdmsObject> objects_;
  std::vector<TdmsIndex> indices_;                                          // of each object, the last one stated
  std::map<std::string, std::size_t> object_of_;                            // path
  std::map<std::pair<std::size_t, std::string>, std::size_t> property_of_;  // object and name
  ActiveTdmsObjects active_;
  std::size_t pieces_ = 0;  // of all objects
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
