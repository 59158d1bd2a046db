#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "tribofit/study/map.hpp"

/// map.csv in a folder, with the rows so far in map.rows beside it until all are there.
///
/// Every row is appended to map.rows and on the disc before the next is counted as done; the file begins with what it
/// is a map of, and is begun anew where that differs. So a map that was interrupted goes on where it stopped, and ends
/// the same to the last bit.
class MapFile {
 public:
  /// folder: empty keeps everything in memory. again: what is there is not used. Throws tribofit::InputError where the
  /// folder cannot be written.
  MapFile(const std::string& folder, const tribofit::MapRequest& request, bool again);

  const std::vector<bool>& done() const { return done_; }
  std::size_t known_count() const;
  void add(std::size_t row, const std::vector<tribofit::MapCell>& cells);
  /// Writes map.csv whole and removes map.rows.
  void finish();
  const std::vector<std::vector<tribofit::MapCell>>& rows() const { return rows_; }

 private:
  void read_known(const std::string& head);
  /// As map.rows has it.
  std::string text_of(std::size_t row) const;

  const tribofit::MapRequest& request_;
  std::string rows_path_, map_path_;
  std::ofstream out_;
  std::vector<bool> done_;
  std::vector<std::vector<tribofit::MapCell>> rows_;
};
