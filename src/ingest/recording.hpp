#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
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
  std::vector<double> step_column;  ///< which step of a recipe each row belongs to; empty when absent
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
  std::string unused_displacement;        ///< column of a displacement of which nothing more is known

  bool is_points() const { return kind == RecordKind::points; }
  bool is_driven() const { return is_driven_in_steps(kind); }
  /// The values of a channel, or of another one that goes to the same place: has() says which is there.
  std::vector<double>& operator[](Channel channel) {
    return channel == Channel::step ? step_column : this->*info_of(channel).target;
  }
  const std::vector<double>& operator[](Channel channel) const { return const_cast<FileRecord&>(*this)[channel]; }
  bool has(Channel channel) const {
    const bool is_there = channel == Channel::time || columns.find(channel) != nullptr;
    return is_there && !(*this)[channel].empty();
  }
  std::vector<Channel> present() const;
  /// Values of the longest channel.
  std::size_t rows() const;
  /// Whether a force was recorded over an area [Pa].
  bool is_stress(Channel channel) const { return columns.has(channel, Quantity::pressure); }
  bool has_friction() const {
    return has(Channel::mu) || has(Channel::force) || has(Channel::torque) || has(Channel::spring);
  }
  bool has_velocity() const { return has(Channel::v_b) || has(Channel::v_r); }
  bool has_position() const { return has(Channel::x_b) || has(Channel::x_d); }
  /// Keeps rows [begin, end) of all channels, at their times.
  void keep_rows(std::size_t begin, std::size_t end);
  InputLocation file() const { return {path, 0, ""}; }
  /// Where a row came from, for messages.
  InputLocation location(std::size_t row, Channel channel) const;
  /// Rows as lines of the file, or as values where it has none: "lines 3, 8" (at most 12 of them).
  std::string places_of(const std::vector<std::size_t>& rows) const;
  std::size_t recipe_size() const { return steps.empty() ? 0 : steps.back().recipe + 1; }
};

/// Reads one file with the reader that recognises it; its time is made to start at 0 and to increase, its steps are
/// found. Channels with rows of their own are brought together on the clock of the file.
FileRecord read_recording(const std::string& path, const ReadOptions& options, std::span<const Reader> readers);
/// The same of a table that was read from it, without the checksum.
FileRecord read_recording(RawTable table, const std::string& path, const ReadOptions& options);

/// Throws the InputError for columns that are missing; says which there are.
[[noreturn]] void refuse_columns(const FileRecord& recording, const std::string& problem);

/// Adds a file that continues the run. Its clock goes on where it was where it does so by itself, else it is set
/// to follow.
void continue_recording(FileRecord& run, FileRecord next, std::size_t number);

/// Of each condition what is known, by `first` before `second`.
Conditions first_known(const Conditions& first, const Conditions& second);

/// Makes a trace of a recording: friction from mu, force or torque; velocity in m/s; steps with their conditions.
/// Throws InputError when friction or velocity cannot be made of what there is. needs_radius: set where the radius
/// alone is missing, and some radius then taken.
Trace assemble(FileRecord run, const ReadOptions& options, bool* needs_radius = nullptr);

// ---- what the rows are (recognise.cpp)

/// Whether these columns are those of points: a friction and a sliding velocity. The velocity of a block (v_b) is one
/// only where its column is not called after the block.
bool are_columns_of_points(const Columns& columns);

/// Whether rows, in SI, are points: they have no times, or none that a clock made. may_be_points: as far as the columns
/// show it, and nobody said what the record is.
void recognise_points(bool may_be_points, FileRecord& recording);

/// Friction beside a load point, and no motion of the contact, is a record of velocity steps. A displacement of which
/// nothing more is known is that of a load point where it goes one way; else it says nothing.
void recognise_steps(FileRecord& recording);

/// Numbers the rows of points in place of a time, as one step.
void set_points(FileRecord& recording);

/// Sorts points by velocity, then by their other values: the order in the file says nothing. The checksum is that of
/// the sorted values.
void sort_points(Trace& trace);

// ---- rows that are left out (gaps.cpp)

/// Rows in which a used column holds no finite number of a usable size, in their order: few enough and isolated, so
/// that they may be left out. Throws InputError, for the first of them, where they are not.
std::vector<std::size_t> find_gappy_rows(const RawTable& table, const std::vector<Column>& used,
                                         const FileRecord& recording);

/// Rows whose time is that of the row before: a machine writes one where it changes its sampling.
std::vector<std::size_t> find_repeated_rows(const FileRecord& recording);

/// Excludes rows from the channels, lines and stated steps, and warns with their number and places. The time must be
/// known: what remains has gaps. what: the rows, as "with a cell that is not a number".
void exclude(const std::vector<std::size_t>& rows, std::string_view what, FileRecord& recording);

/// Leaves out the rows before the block is loaded and after it is lifted, where friction is made of force over load,
/// and warns: in them there is no friction.
void leave_out_unloaded_ends(FileRecord& recording);

// ---- clocks (clock.cpp)

/// When rows were recorded, where no column holds their time.
struct Sampling {
  double start = 0;      ///< [s] of the first row
  double rate = 0;       ///< [Hz]; 0: the interval is given instead
  double interval = 0;   ///< [s]
  bool by_user = false;  ///< else by the file
  std::string source;    ///< for the note: "the sampling rate of 1000 Hz"

  bool is_possible() const;
};

/// The sampling of a set of rows: what the user says, else what the file states of these rows, else a fact of the
/// file that is named as a rate or an interval (fs, dt, "Sampling rate"). Nothing when none is stated.
std::optional<Sampling> stated_sampling(const RawTable& table, std::size_t rows, std::optional<double> rate);

/// Gives the rows their time where no column holds it. Throws InputError for a sampling that is not possible.
void set_time(FileRecord& recording, const Sampling& sampling);

/// Makes the recording's time start at 0 and increase strictly, and divides it into steps.
///
/// - A new step begins where the file sets one apart, where the step column changes and where the clock restarts: goes
///   back to where the step's clock began. The clock of a restarted step continues one sampling interval after the
///   last one's end.
/// - A gap, an interval of more than 1.5 times the median, keeps its time and begins a step too, because nothing
///   may be taken across it; a warning names it. It belongs to the same step of the recipe.
/// Throws InputError where time goes backwards or repeats otherwise, and where more than one interval in a
/// thousand (and more than 20) is a gap: such a clock is not one of samples.
void set_clock(FileRecord& recording, const std::optional<Sampling>& sampling);

/// The median of up to 4096 evenly spread intervals [s]; 0 for fewer than two times.
double typical_interval(const std::vector<double>& time);

// ---- channels of several instruments (join.cpp)

/// Adds the channels of a second instrument to those of the first.
///
/// The time base is that of the file with the friction; the other's channels are interpolated linearly on it, and
/// what only one of them recorded is cut off. `find` gives the offset between the clocks where one file holds friction
/// and the other velocity; where it finds none, or is empty, the times are taken as written, or both files to start
/// together, with a warning.
/// Throws InputError when both files hold the same channels, or do not overlap in time.
void join(FileRecord& run, FileRecord other, const ClockOffsetFinder& find);

/// Adds the channels of other rows of the same file: as above, but their clock is the same, and no offset is estimated.
void join_on_one_clock(FileRecord& run, FileRecord other);

}  // namespace tribofit
