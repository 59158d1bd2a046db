#include "rows.hpp"

#include <fast_float/fast_float.h>
#include <fmt/format.h>
#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <iterator>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>

#include "dialect.hpp"
#include "ingest/limits.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

// A chunk and its numbers stay in the cache of a core. Chunks end where lines do and depend on the file only, not on
// the number of threads.
constexpr std::uint64_t chunk_bytes = std::uint64_t{1} << 17;

/// Asks for memory in pages of 2 MB for so many values: a column of millions of numbers is touched for the first time
/// here, and page by page that costs as much as reading the numbers. Only an advice; nothing depends on it.
void prefer_huge_pages(std::vector<double>& values, std::size_t count) {
  constexpr std::uintptr_t page = std::uintptr_t{1} << 21;
  const auto begin = (reinterpret_cast<std::uintptr_t>(values.data()) + page - 1) & ~(page - 1);
  const auto end = reinterpret_cast<std::uintptr_t>(values.data() + std::min(count, values.capacity())) & ~(page - 1);
  if (begin < end) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

/// What one chunk of lines gave; lines count from 1 at the chunk's beginning.
struct Chunk {
  std::vector<std::vector<double>> values;  // of each wanted cell; as many as there is room for
  std::vector<double*> columns;             // where they begin
  std::size_t rows = 0, lines = 0, text_rows = 0;
  std::vector<std::pair<std::size_t, std::size_t>> line_starts;  // row, line
  std::vector<TextLine> text;                                    // rows and lines of the chunk
  std::optional<RawDefect> first_gap, defect;                    // the row of a defect is its line

  /// Empty, with room for so many rows.
  void begin(std::size_t cells, std::size_t most_rows) {
    rows = lines = text_rows = 0;
    line_starts.clear();
    text.clear();
    first_gap.reset();
    defect.reset();
    values.resize(cells);
    columns.clear();
    for (auto& column : values) {
      if (column.size() < most_rows) column.resize(most_rows);
      columns.push_back(column.data());
    }
  }
};

/// Turns lines into the numbers of the wanted cells.
class RowParser {
 public:
  RowParser(const Dialect& dialect, const std::vector<WantedCell>& wanted) : dialect_(dialect), wanted_(wanted) {}

  /// Reads the line at `at`, which ends with a line feed before `end`, as the next row of the chunk, where it holds
  /// plain numbers without quotes in the right number of cells. Returns the beginning of the next line; nullptr leaves
  /// this one to take_line().
  const char* parse_plain(const char* at, const char* end, const Chunk& chunk) const {
    const char separator = dialect_.separator;  // which the values cannot alias
    const fast_float::parse_options form(fast_float::chars_format::general, dialect_.decimal);
    const bool by_blanks = separator == blanks;
    const auto is_blank = [&](char c) { return c == ' ' || (by_blanks && c == '\t'); };
    const auto ends_cell = [&](char c) { return by_blanks ? is_blank(c) : c == separator; };
    const auto ends_line = [](char c) { return c == '\n' || c == '\r'; };
    const char* begin = at;
    std::size_t cell = 0, next = 0;
    for (;; ++cell) {
      while (is_blank(*at)) ++at;
      if (by_blanks && ends_line(*at)) break;
      begin = at;
      if (next < wanted_.size() && cell == wanted_[next].index) {
        double& value = chunk.columns[next++][chunk.rows];
        const auto [after, error] = fast_float::from_chars_advanced(at, end, value, form);
        if (error != std::errc{} || !(std::abs(value) < kLargestValue)) return nullptr;
        at = after;
      } else {
        while (!ends_cell(*at) && !ends_line(*at) && *at != '"' && *at != '\0') ++at;
      }
      while (!by_blanks && *at == ' ') ++at;
      if (!ends_cell(*at)) {
        ++cell;
        break;
      }
      ++at;
    }
    const bool is_whole = cell == dialect_.columns || (!by_blanks && cell == dialect_.columns + 1 && at == begin);
    if (*at == '\r') ++at;
    return is_whole && next == wanted_.size() && *at == '\n' ? at + 1 : nullptr;
  }

  /// Whether a line, without its end, gives the next row of the chunk: a number for each wanted cell, as written; NaN
  /// where a cell holds none of a usable size.
  bool take_line(std::string_view line, Chunk& chunk) const {
    const std::string_view text = trimmed(line);
    if (line.size() > kLongestLine) {
      chunk.defect = too_long_line();
      return false;
    }
    if (text.empty() || text.front() == '\x1A') return false;
    if (is_comment(text)) return keep_text(text, chunk);
    if (line.find('\0') != std::string_view::npos)
      return refuse("the line holds a NUL byte", "the file is damaged here or binary; export it again", chunk);
    if (std::count(line.begin(), line.end(), '"') % 2 != 0)
      return refuse("a quote is opened and not closed", "close or remove it", chunk);
    const std::vector<std::string> cells = split_cells(line, dialect_.separator);
    std::size_t count = 0, filled = 0, numbers = 0;  // cells without empty ones at the end
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells[i].empty()) continue;
      count = i + 1;
      ++filled;
      if (number_in(cells[i], dialect_.decimal)) ++numbers;
    }
    if (count == 0) return false;
    const bool whole = count == dialect_.columns && dialect_.separator != blanks;  // words of a sentence are many cells
    if (numbers == 0 || !(whole || 2 * numbers >= filled)) return keep_text(text, chunk);
    if (!has_right_count(count, cells.size(), chunk)) return false;
    for (std::size_t k = 0; k < wanted_.size(); ++k) {
      const std::size_t index = wanted_[k].index;
      const std::string cell = index < cells.size() ? cells[index] : std::string();
      chunk.columns[k][chunk.rows] = number_of(cell, wanted_[k].column, chunk);
    }
    return true;
  }

 private:
  static bool refuse(std::string problem, std::string advice, Chunk& chunk) {
    chunk.defect = {0, std::move(problem), std::move(advice), {}};
    return false;
  }

  static bool keep_text(std::string_view text, Chunk& chunk) {
    ++chunk.text_rows;
    if (chunk.text.size() < kMostTextLines)
      chunk.text.push_back({chunk.rows, chunk.lines, std::string(text.substr(0, kLongestText))});
    return false;
  }

  bool has_right_count(std::size_t count, std::size_t cells, Chunk& chunk) const {
    const std::size_t columns = dialect_.columns;
    if (count > columns) {
      return refuse(fmt::format("the row has {} cells where the file has {} columns", count, columns),
                    dialect_.decimal == '.' && count == 2 * columns
                        ? "with a decimal comma, separate the columns by semicolons or tabs"
                        : "remove the extra cells or export the trace again",
                    chunk);
    }
    if (cells >= columns || dialect_.blocks_apart) return true;  // some blocks end before the others
    return refuse(
        fmt::format("the row has {} cell{} where the file has {} columns", cells, cells == 1 ? "" : "s", columns),
        "complete or remove the row", chunk);
  }

  double number_of(const std::string& cell, const std::string& column, Chunk& chunk) const {
    const std::optional<double> clock = clock_time(cell), number = clock ? clock : number_in(cell, dialect_.decimal);
    if (number && std::abs(*number) < kLargestValue) return *number;
    if (!chunk.first_gap) {
      const std::string shown = fmt::format("'{}'", std::string_view(cell).substr(0, 40));
      chunk.first_gap = {chunk.rows, shown + " is not a finite number of a usable size", "fill it in or remove the row",
                         column};
      if (cell.empty()) {
        chunk.first_gap->problem = "the cell is empty";
      } else if (!number) {
        chunk.first_gap->problem = shown + " is not a number";
        chunk.first_gap->advice = "correct it, remove the row, or name another column with " + setting("columns");
      }
    }
    return std::numeric_limits<double>::quiet_NaN();
  }

  const Dialect& dialect_;
  const std::vector<WantedCell>& wanted_;
};

class RowReader {
 public:
  RowReader(const InputFile& file, const Dialect& dialect, const std::vector<WantedCell>& wanted)
      : file_(file), dialect_(dialect), wanted_(wanted), next_line_(dialect.data_line) {
    const std::uint64_t bytes = dialect.data_end - dialect.data_begin;
    chunks_ = static_cast<std::size_t>((bytes + chunk_bytes - 1) / chunk_bytes);
    const double rows = static_cast<double>(bytes) / std::max(2.0, dialect.row_bytes);
    refuse_beyond_memory(rows, wanted.size(), file.path());
    rows_.values.resize(wanted.size());
    for (auto& values : rows_.values) {  // what is reserved and not used costs nothing, growing twice the size does
      values.reserve(static_cast<std::size_t>(1.2 * rows) + 64);
      prefer_huge_pages(values, static_cast<std::size_t>(rows));
    }
  }

  Rows read(int threads) {
    const std::size_t available = static_cast<std::size_t>(threads > 0 ? threads : available_threads());
    {
      const HelperThreads others(std::max<std::size_t>(1, std::min(available, chunks_)) - 1, [this] { work(); });
      work();
    }
    if (failure_) std::rethrow_exception(failure_);
    return std::move(rows_);
  }

 private:
  /// Reads chunks, each of which is appended in its turn.
  void work() {
    std::string text;
    Chunk chunk;
    for (std::size_t i = next_chunk_++; i < chunks_; i = next_chunk_++) {
      std::exception_ptr failure;
      try {
        parse(i, text, chunk);
      } catch (...) {
        failure = std::current_exception();
      }
      std::unique_lock lock(mutex_);
      turn_changed_.wait(lock, [&] { return i == turn_ || failure_; });
      if (failure_) return;
      try {
        if (failure) std::rethrow_exception(failure);
        append(chunk);
      } catch (...) {
        failure_ = std::current_exception();
      }
      ++turn_;
      turn_changed_.notify_all();
    }
  }

  /// The lines that begin in a chunk, each with its end, but for one that is too long.
  std::string_view read_lines(std::size_t i, std::string& text) const {
    constexpr std::uint64_t kLineMore = 4096;  // a chunk ends with its last line
    const std::uint64_t begin = dialect_.data_begin + i * chunk_bytes;
    std::uint64_t at = i == 0 ? begin : begin - 1;  // the end of a line before it shows that one begins with it
    text.clear();
    const auto read_to = [&](std::uint64_t end) {
      const std::size_t before = text.size();
      text.resize(before + static_cast<std::size_t>(std::min(end, dialect_.data_end) - at));
      text.resize(before + file_.read(at, std::span(text).subspan(before)));
      at += text.size() - before;
      return before;
    };
    read_to(begin + chunk_bytes);
    const std::size_t first = i == 0 ? 0 : text.find('\n') + 1;
    if (first == 0 && i > 0) return {};
    while (text.back() != '\n' && at < dialect_.data_end && text.size() < chunk_bytes + 2 * kLongestLine) {
      const std::size_t before = read_to(at + kLineMore), end = text.find('\n', before);
      if (end != std::string::npos) text.resize(end + 1);
      if (text.size() == before) break;
    }
    if (at >= dialect_.data_end && text.back() != '\n') text += '\n';
    return std::string_view(text).substr(first);
  }

  void parse(std::size_t i, std::string& text, Chunk& chunk) const {
    const std::string_view lines = read_lines(i, text);
    // Rows of at least this many bytes follow from the cells that a row has, if all have them.
    const std::size_t shortest_row = dialect_.blocks_apart ? 1 : std::max<std::size_t>(1, dialect_.columns);
    chunk.begin(wanted_.size(), std::max<std::size_t>(lines.size(), chunk_bytes) / shortest_row + 2);
    const RowParser parser(dialect_, wanted_);
    bool follows = false;  // the line before gave a row too
    const char* const end = lines.data() + lines.size();
    for (const char* at = lines.data(); at < end && !chunk.defect;) {
      ++chunk.lines;
      const char* next = parser.parse_plain(at, end, chunk);
      if (next == nullptr) {
        const std::string_view line(at, static_cast<std::size_t>(std::find(at, end, '\n') - at));
        next = at + line.size() + 1;
        if (!parser.take_line(line, chunk)) {
          follows = false;
          at = next;
          continue;
        }
      }
      at = next;
      if (!follows) chunk.line_starts.emplace_back(chunk.rows, chunk.lines);
      follows = true;
      ++chunk.rows;
    }
  }

  /// Called in the order of the file, one chunk at a time.
  void append(const Chunk& chunk) {
    if (chunk.defect) {
      throw InputError(chunk.defect->problem, chunk.defect->advice,
                       {file_.path(), next_line_ + chunk.lines - 1, chunk.defect->column});
    }
    const std::size_t before = rows_.size();
    if (chunk.first_gap && !rows_.first_gap) {
      rows_.first_gap = chunk.first_gap;
      rows_.first_gap->row += before;
    }
    for (const TextLine& text : chunk.text) {
      if (rows_.text.size() >= kMostTextLines) break;
      rows_.text.push_back({before + text.row, next_line_ + text.line - 1, text.text});
    }
    for (const auto& [row, line] : chunk.line_starts) rows_.lines.set(before + row, next_line_ + line - 1);
    for (std::size_t k = 0; k < wanted_.size(); ++k)
      rows_.values[k].insert(rows_.values[k].end(), chunk.columns[k], chunk.columns[k] + chunk.rows);
    rows_.text_rows += chunk.text_rows;
    next_line_ += chunk.lines;
  }

  const InputFile& file_;
  const Dialect& dialect_;
  const std::vector<WantedCell>& wanted_;
  std::size_t chunks_ = 0;

  std::atomic<std::size_t> next_chunk_ = 0;
  std::mutex mutex_;
  std::condition_variable turn_changed_;
  std::size_t turn_ = 0;  // the chunk whose turn it is to be appended
  std::exception_ptr failure_;
  std::size_t next_line_;
  Rows rows_;
};

}  // namespace

Rows read_rows(const InputFile& file, const Dialect& dialect, const std::vector<WantedCell>& wanted, int threads) {
  return RowReader(file, dialect, wanted).read(threads);
}

}  // namespace tribofit
