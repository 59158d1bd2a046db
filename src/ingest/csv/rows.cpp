#include "rows.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>

#include "ingest/huge_pages.hpp"
#include "ingest/limits.hpp"
#include "ingest/memory.hpp"
#include "row_parser.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

// A chunk and its numbers stay in the cache of a core. Chunks end where lines do and depend on the file only, not on
// the number of threads.
constexpr std::uint64_t chunk_bytes = std::uint64_t{1} << 17;

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
    RowParser parser(wanted_, dialect_.columns, dialect_.separator, dialect_.decimal, dialect_.blocks_apart);
    std::vector<double> row(wanted_.size());
    bool follows = false;  // the line before gave a row too
    const char* const end = lines.data() + lines.size();
    for (const char* at = lines.data(); at < end && !chunk.defect;) {
      ++chunk.lines;
      const char* next = parser.parse_plain(at, end, chunk.columns, chunk.rows);
      if (next == nullptr) {
        const std::string_view line(at, static_cast<std::size_t>(std::find(at, end, '\n') - at));
        next = at + line.size() + 1;
        if (!take_line(line, parser, row, chunk)) {
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

  /// Whether a line that is not plain gives a row.
  static bool take_line(std::string_view line, RowParser& parser, std::vector<double>& row, Chunk& chunk) {
    if (line.size() > kLongestLine) chunk.defect = too_long_line();
    if (chunk.defect) return false;
    switch (parser.parse(line, row)) {
      case RowParser::Outcome::numbers:
        if (parser.is_gappy() && !chunk.first_gap) {
          chunk.first_gap = parser.defect();
          chunk.first_gap->row = chunk.rows;
        }
        for (std::size_t k = 0; k < row.size(); ++k) chunk.columns[k][chunk.rows] = row[k];
        return true;
      case RowParser::Outcome::text:
        ++chunk.text_rows;
        if (chunk.text.size() < kMostTextLines)
          chunk.text.push_back({chunk.rows, chunk.lines, std::string(trimmed(line).substr(0, kLongestText))});
        return false;
      case RowParser::Outcome::wrong:
        chunk.defect = parser.defect();
        return false;
      case RowParser::Outcome::blank:
        break;
    }
    return false;
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
