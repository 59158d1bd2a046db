#pragma once

#include <span>
#include <string>
#include <vector>

#include "columns.hpp"
#include "raw_table.hpp"
#include "reader.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/read_trace.hpp"

namespace tribofit {

/// A trace that is being read: channels in SI as recorded, before friction and motion are made of them, and where they
/// came from.
struct FileRecord : Trace {
  Columns columns;
  std::vector<std::string> column_names;
  bool has_names = true;            ///< the file names its columns
  std::vector<double> step_column;  ///< which step of a recipe each row belongs
                                    ///< to; empty when absent
  LineMap lines;
  struct Part {
    std::size_t begin;  ///< first row
    std::string path;
    LineMap lines;
  };
  std::vector<Part> parts;                ///< files that continue this one
  std::size_t cut_rows = 0;               ///< rows cut off at the beginning
  std::string second_path;                ///< of the other instrument's file
  std::vector<Channel> second_channels;   ///< that came from it
  double clock_start = 0, clock_end = 0;  ///< first and last time as written [s]
  Conditions file_conditions;             ///< that the file states for all its steps
  std::vector<RawStep> stated_steps;      ///< as the file divides itself
  std::vector<std::size_t> recipe_steps;  ///< per step: which step of the recipe it belongs to, from 0
  std::string unused_displacement;        ///< column of a displacement of which nothing more is known

  bool is_points() const { return kind == RecordKind::points; }
  bool is_driven() const { return is_driven_in_steps(kind); }
  /// The values of a channel, or of another one that goes to the same place:
  /// has() says which is there.
  std::vector<double>& operator[](Channel channel) {
    return channel == Channel::step ? step_column : this->*info_of(channel).target;
  }
  const std::vector<double>& operator[](Channel channel) const { return const_cast<FileRecord&>(*this)[channel]; }
  bool has(Channel channel) const {
    const bool is_there = channel == Channel::time || columns.find(channel) != nullptr;
    return is_there && !(*this)[channel].empty();
  }
  std::vector<Channel> present() const;
  /// Whether a force was recorded over an area [Pa].
  bool is_stress(Channel channel) const {
    const Column* column = columns.find(channel);
    return column != nullptr && column->stress;
  }
  bool has_friction() const {
    return has(Channel::mu) || has(Channel::force) || has(Channel::torque) || has(Channel::spring);
  }
  bool has_velocity() const { return has(Channel::v_b) || has(Channel::v_r); }
  bool has_position() const { return has(Channel::x_b) || has(Channel::x_d); }
  /// Where a row came from, for messages.
  InputLocation location(std::size_t row, Channel channel) const;
  /// "line 22", or "value 21" where the file has no lines.
  std::string place_of(std::size_t row) const;
  std::size_t recipe_size() const { return recipe_steps.empty() ? 0 : recipe_steps.back() + 1; }
};

/// Reads one file with the reader that recognises it; its time is made to start at 0 and to increase, its steps are
/// found (clock.hpp). Channels with rows of their own are brought together on the clock of the file (join.hpp).
FileRecord read_recording(const std::string& path, const ReadOptions& options, std::span<const Reader> readers);
/// The same of a table that was read from it, without the checksum.
FileRecord read_recording(RawTable table, const std::string& path, const ReadOptions& options);

/// Throws the InputError for columns that are missing; says which there are.
[[noreturn]] void refuse_columns(const FileRecord& recording, const std::string& problem);

/// Adds a file that continues the run. Its clock goes on where it was where it does so by itself, else it is set
/// to follow.
void continue_recording(FileRecord& run, FileRecord next, std::size_t number);

}  // namespace tribofit
