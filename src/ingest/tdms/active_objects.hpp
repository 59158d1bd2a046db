#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "tdms_file.hpp"

namespace tribofit {

/// Values of an object in each chunk of a segment.
struct TdmsIndex {
  std::uint32_t type = 0;
  std::uint64_t count = 0, bytes = 0;
};

/// The objects with values in a segment, in their order; those of no bytes are left out, or a file of many objects and
/// many segments would cost their product.
class ActiveTdmsObjects {
 public:
  void clear() {
    ++list_;
    with_values_.clear();
    chunk_ = sample_ = 0;
  }
  /// The object is in the list, with this index; or no longer.
  void put(std::size_t k, const TdmsIndex& index) {
    if (entries_.size() <= k) entries_.resize(k + 1);
    Entry& entry = entries_[k];
    if (entry.list != list_) entry = {list_, next_++, {}};
    set(k, index);
  }
  void remove(std::size_t k) {
    if (entries_.size() <= k || entries_[k].list != list_) return;
    set(k, {});
    entries_[k].list = 0;
  }

  std::uint64_t chunk_bytes() const { return chunk_; }
  std::uint64_t sample_bytes() const { return sample_; }  ///< of one value of each
  const std::map<std::uint64_t, std::size_t>& with_values() const { return with_values_; }

 private:
  struct Entry {
    std::uint64_t list = 0, place = 0;
    TdmsIndex index;
  };

  void set(std::size_t k, const TdmsIndex& index) {
    Entry& entry = entries_[k];
    count(entry.index, false);
    entry.index = index;
    count(entry.index, true);
    if (index.bytes > 0) {
      with_values_.emplace(entry.place, k);
    } else {
      with_values_.erase(entry.place);
    }
  }
  void count(const TdmsIndex& index, bool more) {
    const std::uint64_t sample = index.bytes > 0 ? tdms::bytes_of(index.type) : 0;
    chunk_ = more ? chunk_ + index.bytes : chunk_ - index.bytes;
    sample_ = more ? sample_ + sample : sample_ - sample;
  }

  std::vector<Entry> entries_;
  std::map<std::uint64_t, std::size_t> with_values_;  // place, object
  std::uint64_t list_ = 1, next_ = 0, chunk_ = 0, sample_ = 0;
};

}  // namespace tribofit
