#pragma once

#include <cstddef>
#include <cstdint>

// The thresholds by which files are read, with their reasons and what moves when they change.

namespace tribofit {

// ---- clocks

/// Interval over the usual one, from which a row is missing: halfway between none and one. Larger: lone rows that are
/// lost shift all later times of a record without a clock; smaller: the jitter of a clock cuts a record into steps.
inline constexpr double kGapInterval = 1.5;
/// Intervals whose median is the usual one: more cost time and do not move it.
inline constexpr std::size_t kIntervalsForMedian = 4096;
/// Gaps in all, and one in so many rows, from which the clock is irregular: a recording that pauses has a few, and a
/// logger drops a value now and then, which is no loss. Fewer allowed: such a recording is refused; more: a clock
/// written too coarsely becomes hundreds of steps.
inline constexpr std::size_t kMostGaps = 20, kRowsPerGap = 1000;
/// Rows per row at the time of the one before, which a machine writes where it changes its sampling: more of them are a
/// clock that is written too coarsely.
inline constexpr std::size_t kRowsPerRepeat = 50;
/// Rows before a clock may restart without a step column that says so, and rows for which it must go on from there: a
/// lone wrong time stamp is followed by the old clock. Fewer: wrong time stamps pass for steps.
inline constexpr std::size_t kShortestStep = 10, kGoesOnFor = 5;
/// Changes of a column called "step", and of so many rows one, from which it counts samples and not steps of a recipe.
inline constexpr std::size_t kMostStepChanges = 10, kRowsPerStepChange = 10;
/// Stated sampling rate over that of the time column: a nominal rate is rounded by less.
inline constexpr double kSameRate = 0.01;
/// Break-aways that two clocks are compared by: two coincide at some offset whatever they are.
inline constexpr std::size_t kFewestBreakAways = 3;

// ---- rows that are left out

/// Rows that are lost in a row: more are more than a hiccup, and a phase of the motion may have begun in them.
inline constexpr std::size_t kMostLostInARow = 3;
/// Lines of text between rows, one in so many rows, from which dropping them is worth a warning.
inline constexpr std::size_t kRowsPerStrayLine = 100;

// ---- tables of points

/// Rows up to which a table without a time is taken for points: people tabulate some ten to a few thousand; more are
/// samples of a record whose rate must be stated.
inline constexpr std::size_t kMostTabulated = 5000;
/// Of so many intervals one that goes back shows that no clock made the times: a clock restarts once a step.
inline constexpr std::size_t kIntervalsPerReturn = 10;

// ---- conditions

/// What radius and speed of a machine are known to: a speed stated and one recorded differ by as much where both are
/// right. Smaller: a rounded nominal speed contradicts its column.
inline constexpr double kSpeedKnownTo = 0.02;
/// The same of a load: dead weights and springs are known less well, and a load channel has a zero of its own.
inline constexpr double kLoadKnownTo = 0.1;
/// Of the usual friction over load, from which on rows of a small load are a step of it, and not the zero of its cell.
inline constexpr double kFrictionOfLoad = 0.5;
/// Rounding of one condition in two places or two units (4 rpm, 0.418879 rad/s), and standard uncertainties of a
/// declared one within which both are the same.
inline constexpr double kConditionRounding = 1e-6, kDeclaredWithin = 2;
/// Radius of a contact [m]: smaller than an atom.
inline constexpr double kSmallestRadius = 1e-9;
/// Load [N] that friction can be divided by.
inline constexpr double kSmallestLoad = 1e-12;
/// Coefficient of friction beyond any dry contact: the column is a force.
inline constexpr double kLargestCoefficient = 5;
/// Range of an angle over one turn, up to which it wraps: rounding, no more.
inline constexpr double kOneTurn = 1.001;

// ---- text files

/// Lines at the head of a file among which its form is looked for, and rows by which blocks of columns are found: a
/// preamble is some ten to a few hundred lines.
inline constexpr std::size_t kHeadLines = 500, kRowsForBlocks = 50;
/// Bytes of the head that show its encoding and how its lines end, and bytes of the tail that hold its last lines.
inline constexpr std::size_t kHeadBytes = std::size_t{1} << 16, kTailBytes = std::size_t{1} << 16,
                             kLastRowBytes = std::size_t{1} << 14;
/// Part of zero bytes beyond which text is UTF-16 (half of it is zeros where the letters are Latin), and of control
/// characters beyond which it is no text.
inline constexpr double kZerosOfUtf16 = 0.4, kControlsOfText = 0.05;
/// Bytes of a line of text that are kept, and lines of it: a file of steps has a few for each.
inline constexpr std::size_t kLongestText = 400, kMostTextLines = 4096;

// ---- what is refused before it takes all memory; a larger limit reads more of what is damaged or made to do harm

/// Numbers are smaller than this: they stay finite when they are turned into SI and divided by a load.
inline constexpr double kLargestValue = 1e100;
/// Memory that a record takes while it is looked at, over its values; and a size that is not compared with what is free
/// [bytes].
inline constexpr double kMemoryOverValues = 1.5;
inline constexpr std::uint64_t kMemoryNotAsked = std::uint64_t{1} << 28;
/// Columns of a file; more are no channels of a trace. Names in a message of what was not read.
inline constexpr std::size_t kMostColumns = 4096, kMostNamed = 20;
/// Longest line that is read [bytes]. A row of numbers is far below it; a file that is one line of gigabytes is found
/// out without holding it. The same of a JSON file that people write, and 16 times as much of a manifest.
inline constexpr std::size_t kLongestLine = std::size_t{1} << 20, kLargestManifest = 16 * kLongestLine;
/// TDMS: properties of an object, and objects (groups and channels) of a file.
inline constexpr std::size_t kMostTdmsProperties = 4096, kMostTdmsObjects = 65536;
/// MATLAB: characters that are kept as a fact, arrays of a file with the fields of structures, and structures in one
/// another.
inline constexpr std::uint64_t kLongestMatText = 1000, kMostMatArrays = 65536, kDeepestMatStructure = 16;
/// Bytes that the values of a MATLAB file may take, inflated and as doubles, over its size, which counts as a megabyte
/// more. A recorded signal deflates to a tenth, a constant one to a thousandth of its size.
inline constexpr std::uint64_t kMostInflated = 128;
/// [s] of processor time that the library may take for a MATLAB file: a damaged one can keep it busy for ever.
inline constexpr unsigned kLongestMatRead = 120;

}  // namespace tribofit
