#include "tdms_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "ingest/limits.hpp"
#include "ingest/numbers.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

/// Types of numbers, by their numbers in the file; nullptr: another type.
const NumberType* find_type(std::uint32_t type) {
  static const std::map<std::uint32_t, NumberType> types = {{1, number_type<std::int8_t>},
                                                            {2, number_type<std::int16_t>},
                                                            {3, number_type<std::int32_t>},
                                                            {4, number_type<std::int64_t>},
                                                            {5, number_type<std::uint8_t>},
                                                            {6, number_type<std::uint16_t>},
                                                            {7, number_type<std::uint32_t>},
                                                            {8, number_type<std::uint64_t>},
                                                            {9, number_type<float>},
                                                            {10, number_type<double>},
                                                            {tdms::boolean, number_type<std::uint8_t>},
                                                            {0x19, number_type<float>},
                                                            {0x1A, number_type<double>}};
  const auto found = types.find(type);
  return found == types.end() ? nullptr : &found->second;
}

/// Bytes of a value; 0: not of one length, or not known.
std::size_t bytes_of(std::uint32_t type) {
  const NumberType* known = find_type(type);
  return known != nullptr ? known->bytes : type == tdms::timestamp ? 16 : 0;
}

/// A value as a number; timestamps in s after `epoch` [s].
double value_at(std::string_view bytes, std::size_t at, std::uint32_t type, bool big_endian, double epoch) {
  if (type != tdms::timestamp) return find_type(type)->at(bytes, at, big_endian);
  // Fractions of 2^-64 s and seconds since 1904; the seconds come first where the highest byte does.
  const auto seconds = number_at<std::int64_t>(bytes, at + (big_endian ? 0 : 8), big_endian);
  const auto fractions = number_at<std::uint64_t>(bytes, at + (big_endian ? 8 : 0), big_endian);
  return (static_cast<double>(seconds) - epoch) + std::ldexp(static_cast<double>(fractions), -64);
}

namespace contents {  // of a segment: bits of its mask
constexpr std::uint32_t metadata = 2, new_list = 4, raw_data = 8, interleaved = 32, big_endian = 64, daqmx = 128;
}
constexpr std::size_t lead_bytes = 28;
constexpr std::uint32_t no_values = 0xFFFFFFFF, as_before = 0;
constexpr std::array<std::uint32_t, 2> daqmx_index = {0x1269, 0x126A};

/// Values of an object in each chunk of a segment.
struct Index {
  std::uint32_t type = 0;
  std::uint64_t count = 0, bytes = 0;
};

/// What is known of an object while the segments are gone through.
struct State {
  Index stated;                        // the last one
  Index listed;                        // by which its values stand in the segment
  std::optional<std::uint64_t> place;  // in the segment's list; nothing: it is not in it
  std::map<std::string, std::size_t> properties;
};

using WantedValues = std::map<std::size_t, std::vector<double>*>;

class Parser {
 public:
  /// wanted: objects of which the values are read, too.
  explicit Parser(const InputFile& file, WantedValues wanted = {}) : file_(file), wanted_(std::move(wanted)) {}

  std::vector<TdmsObject> parse() {
    for (std::uint64_t at = 0; at < file_.size();) at = segment(at);
    return std::move(objects_);
  }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  [[noreturn]] void refuse(std::uint64_t at, const std::string& problem, const char* advice = nullptr) const {
    throw InputError(fmt::format("byte {}: {}", at, problem),
                     advice != nullptr ? advice : "the file is cut off or damaged; copy or export it again",
                     {file_.path(), 0, ""});
  }
  [[noreturn]] void refuse_daqmx(std::uint64_t at, const std::string& path) const {
    refuse(at, fmt::format("the values of {} are raw ones of DAQmx, which need its scaling", path),
           "export the channel scaled, as a TDMS file of doubles or as CSV");
  }

  /// Reads a segment and returns where the next one begins.
  std::uint64_t segment(std::uint64_t begin) {
    const std::string lead = file_.read_text(begin, lead_bytes);
    if (lead.size() < lead_bytes) refuse(begin, "the head of a segment is cut off");
    if (!lead.starts_with("TDSm")) refuse(begin, "no segment begins here");
    mask_ = number_at<std::uint32_t>(lead, 4, false);
    big_endian_ = (mask_ & contents::big_endian) != 0;
    const auto version = number_at<std::uint32_t>(lead, 8, big_endian_);
    if (version != 4712 && version != 4713)
      refuse(begin + 8, fmt::format("version {} of the format is not known", version));
    const auto length = number_at<std::uint64_t>(lead, 12, big_endian_);
    const auto raw = number_at<std::uint64_t>(lead, 20, big_endian_);
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
    begin_ = begin;
    described_.emplace(file_.read_text(begin, size), [this](std::uint64_t wanted, std::uint64_t there) {
      refuse(at(), fmt::format("{} bytes are wanted where {} are left", wanted, there));
    });
    if ((mask_ & contents::new_list) != 0) {
      for (const std::size_t k : list_) take_off_list(k);
      list_.clear();
    }
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
      objects_.push_back({path, names_of(path), k, 0, 0, {}});
      states_.emplace_back();
    }
    const std::uint64_t index_at = at();
    const auto index = number<std::uint32_t>();
    if (std::ranges::find(daqmx_index, index) != daqmx_index.end()) refuse_daqmx(index_at, path);
    if (index != no_values && index != as_before) states_[k].stated = read_index(index_at, objects_[k]);
    if (index == no_values) {
      take_off_list(k);
    } else {
      put_on_list(k);
    }
    for (auto count = number<std::uint32_t>(); count > 0; --count) property(k);
  }

  void put_on_list(std::size_t k) {
    if (!states_[k].place) {
      states_[k].place = next_place_++;
      list_.push_back(k);
    }
    set_listed(k, states_[k].stated);
  }
  void take_off_list(std::size_t k) {
    set_listed(k, {});
    states_[k].place.reset();
  }
  /// Those of no bytes are left out, or a file of many objects and many segments would cost their product.
  void set_listed(std::size_t k, const Index& index) {
    State& state = states_[k];
    if (!state.place) return;
    const auto sample = [](const Index& i) { return i.bytes > 0 ? bytes_of(i.type) : 0; };
    chunk_ += index.bytes - state.listed.bytes;
    sample_ += sample(index) - sample(state.listed);
    state.listed = index;
    if (index.bytes > 0) {
      with_values_.emplace(*state.place, k);
    } else {
      with_values_.erase(*state.place);
    }
  }

  Index read_index(std::uint64_t index_at, TdmsObject& object) {
    Index index;
    index.type = number<std::uint32_t>();
    const auto dimensions = number<std::uint32_t>();
    index.count = number<std::uint64_t>();
    if (index.type == no_values) refuse_daqmx(index_at, object.path);
    if (dimensions != 1) refuse(index_at, fmt::format("{} is of {} dimensions, not one", object.path, dimensions));
    const std::size_t size = bytes_of(index.type);
    if (index.type == tdms::text) {
      index.bytes = number<std::uint64_t>();
    } else if (size == 0) {
      refuse(index_at, fmt::format("{} is of the type {:#x}, which is not read", object.path, index.type));
    } else if (index.count > file_.size() && !unfinished_) {
      refuse(index_at, fmt::format("{} values of {} in a file of {} bytes", index.count, object.path, file_.size()));
    } else {
      index.bytes = std::min(index.count, file_.size() + 1) * size;
    }
    if (index.bytes > file_.size() && !unfinished_)
      refuse(index_at, fmt::format("{} holds {} bytes, more than the file", object.path, index.bytes));
    index.bytes = std::min(index.bytes, file_.size() + 1);  // of which no whole chunk can be there
    if (object.count > 0 && object.type != index.type)
      refuse(index_at, fmt::format("the type of {} changes", object.path));
    object.type = index.type;
    return index;
  }

  void property(std::size_t k) {
    TdmsObject& object = objects_[k];
    TdmsProperty property;
    property.name = text();
    const std::uint64_t type_at = at();
    const auto type = number<std::uint32_t>();
    const std::size_t size = bytes_of(type);
    property.is_text = type == tdms::text;
    if (property.is_text) {
      property.text = text();
    } else if (size == 0) {
      refuse(type_at, fmt::format("the property {} is of the type {:#x}, which is not known", property.name, type));
    } else {
      described_->need(1, size);
      property.number = value_at(described_->bytes(), described_->position(), type, big_endian_, 0);
      described_->skip(size);
    }
    const auto [known, is_new] = states_[k].properties.emplace(property.name, object.properties.size());
    if (!is_new) {
      object.properties[known->second] = std::move(property);
      return;
    }
    if (object.properties.size() >= kMostTdmsProperties)
      refuse(type_at, fmt::format("more than {} properties of {}", kMostTdmsProperties, object.path));
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

  /// Goes through the values of a segment: chunks of the same build, as many as it holds; where the channels are
  /// interleaved, samples of all of them.
  void values(std::uint64_t begin, std::uint64_t size) {
    if ((mask_ & contents::daqmx) != 0)
      refuse(begin, "raw values of DAQmx, which need its scaling",
             "export the channels scaled, as a TDMS file of doubles or as CSV");
    if (chunk_ == 0 || size == 0) return;
    const bool interleaved = (mask_ & contents::interleaved) != 0;
    if (interleaved) refuse_unlike(begin);
    const std::uint64_t part = interleaved ? sample_ : chunk_;
    if (unfinished_) size -= size % part;
    if (size % part != 0)
      refuse(begin, fmt::format("{} bytes of values in {} of {}", size, interleaved ? "samples" : "chunks", part));
    std::uint64_t at = begin;
    for (const auto& [place, k] : with_values_) {
      const Index& index = states_[k].listed;
      const std::size_t bytes = bytes_of(index.type);
      const std::uint64_t count = interleaved ? 1 : index.count;
      if (bytes > 0) objects_[k].count += count * (size / part);
      if (wanted_.contains(k)) read_chunks(k, at, count, size / part, part);
      at += interleaved ? bytes : index.bytes;
    }
  }

  /// Throws InputError for channels that cannot be interleaved.
  void refuse_unlike(std::uint64_t begin) const {
    const Index& first = states_[with_values_.begin()->second].listed;
    for (const auto& [place, k] : with_values_) {
      const Index& index = states_[k].listed;
      if (index.type == tdms::text || index.count != first.count)
        refuse(begin, fmt::format("{} cannot be interleaved with the other channels", objects_[k].path));
    }
  }

  /// Reads `count` values from each of the chunks; single ones with what is between them.
  void read_chunks(std::size_t k, std::uint64_t begin, std::uint64_t count, std::uint64_t chunks, std::uint64_t chunk) {
    constexpr std::uint64_t most_between = 4096;
    if (count == 1 && chunk <= most_between) return read_values(k, begin, chunks, chunk);
    for (std::uint64_t c = 0; c < chunks; ++c)
      read_values(k, begin + c * chunk, count, bytes_of(states_[k].listed.type));
  }

  /// Values at even distances, from a byte on.
  void read_values(std::size_t k, std::uint64_t begin, std::uint64_t count, std::uint64_t stride) {
    const std::uint32_t type = states_[k].listed.type;
    std::vector<double>& out = *wanted_.at(k);
    const std::uint64_t most = std::max<std::uint64_t>(1, (1 << 20) / stride);
    for (std::uint64_t done = 0; done < count;) {
      const std::uint64_t now = std::min(most, count - done), size = (now - 1) * stride + bytes_of(type);
      const std::string bytes = file_.read_text(begin + done * stride, size);
      if (bytes.size() < size) {
        throw InputError(fmt::format("byte {}: the values are cut off", file_.size()), "copy the file again",
                         {file_.path(), 0, objects_[k].path});
      }
      if (out.empty() && type == tdms::timestamp) epoch_[k] = std::floor(value_at(bytes, 0, type, big_endian_, 0));
      const double epoch = type == tdms::timestamp ? epoch_[k] : 0;
      for (std::uint64_t i = 0; i < now; ++i)
        out.push_back(value_at(bytes, static_cast<std::size_t>(i * stride), type, big_endian_, epoch));
      done += now;
    }
  }

  const InputFile& file_;
  std::vector<std::string> notes_;
  std::uint32_t mask_ = 0;
  bool big_endian_ = false, unfinished_ = false;  // the segment
  std::optional<ByteCursor> described_;           // a copy of what describes the objects of a segment
  std::uint64_t begin_ = 0;                       // of it, in the file
  std::vector<TdmsObject> objects_;
  std::vector<State> states_;                         // of the objects
  std::map<std::string, std::size_t> object_of_;      // path
  std::vector<std::size_t> list_;                     // objects that were put on the list of the segment
  std::map<std::uint64_t, std::size_t> with_values_;  // those with values in it: place, object
  std::uint64_t next_place_ = 0;
  std::uint64_t chunk_ = 0, sample_ = 0;  // bytes of a chunk, and of one value of each
  WantedValues wanted_;
  std::map<std::size_t, double> epoch_;  // of wanted times [s]
};

}  // namespace

const TdmsProperty* TdmsObject::find(std::string_view name) const {
  const auto at = std::ranges::find(properties, name, &TdmsProperty::name);
  return at != properties.end() ? &*at : nullptr;
}

std::vector<TdmsObject> read_tdms_objects(const InputFile& file, std::vector<std::string>& notes) {
  Parser parser(file);
  std::vector<TdmsObject> objects = parser.parse();
  notes.insert(notes.end(), parser.notes().begin(), parser.notes().end());
  return objects;
}

void read_tdms_values(const InputFile& file, const std::map<std::size_t, std::vector<double>*>& wanted) {
  Parser(file, wanted).parse();
}

}  // namespace tribofit
