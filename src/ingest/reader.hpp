#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "input_file.hpp"
#include "raw_table.hpp"
#include "tribofit/ingest/read_trace.hpp"

namespace tribofit {

/// How to add a reader
/// -------------------
/// 1. A folder or file of its own in ingest/ that defines one `const Reader`, as csv/csv_reader.cpp does.
/// 2. Its name below and in the list of reader.cpp, before those that are less particular (CSV takes any text and
///    stands last).
/// 3. One test in tests/ingest/, on files that the test itself writes, and a seed in tests/fuzz/write_seeds.cpp.
/// Units, channels, clocks, steps, continued files and joins then work; nothing else knows of formats.
///
/// A reader says two things:
///
///   recognises(head)   a test of the content, never of the file's name: whether the first bytes are of its format. It
///                      must not throw, and must be false for any other format of the list.
///   read(file)         a RawTable (raw_table.hpp): columns with name, unit and place, the rows they share, facts.
///
/// What read() has to do:
/// - Numbers stay as written; units are text as the file gives it ("mm/s"). Conversion is done once, behind the seam.
/// - Columns of one length that were recorded together share a RawRows. Channels of another length, rate or block
///   have one of their own; they are brought together on the common clock of the file.
/// - Sampling: a time column needs nothing. A start and an interval go into RawRows. A scalar (fs, dt, "Sampling rate")
///   goes into `facts`, where the clock looks for it; so does whatever else the preamble or the variables state.
/// - Steps of a recipe go into RawRows::steps, with the conditions (radius, speed, load) the file states for each.
/// - Where columns cost time or memory, `load` reads those that are asked for and no others; else it stays empty.
/// - Places: a text file fills RawRows::lines and the columns' `line`; where lines have no meaning they stay 0,
///   messages then count values ("value 12"), and `place` says where a column stands.
/// - Defects are refused with an InputError that names the offset, variable or line and says what to do: a file cut
///   off, a wrong version, counts beyond the file's size. Check every count against InputFile::size() before memory is
///   asked for. Numbers that are not finite are refused behind the seam.
struct Reader {
  std::string_view format;  ///< for messages: "CSV", "MATLAB 5"
  bool (*recognises)(std::string_view head);
  RawTable (*read)(std::shared_ptr<const InputFile> file);
};

/// Bytes of a file that `recognises` is shown.
inline constexpr std::size_t signature_bytes = 4096;

extern const Reader csv_reader, matlab_reader, tdms_reader, uff_reader;

/// The readers of the library, those of the more particular formats first.
std::span<const Reader> all_readers();

/// What the file holds, by the first reader that recognises it. Throws InputError where none does (with what the file
/// is, if that is known), or where the reader refuses it.
RawTable read_table(const std::string& path, std::span<const Reader> readers = all_readers());

/// read_trace with readers of one's own.
Trace read_trace(const std::string& path, const ReadOptions& options, std::span<const Reader> readers);

}  // namespace tribofit
