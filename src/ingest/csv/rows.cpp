#include "rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstring>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>

#include "decimal.hpp"
#include "ingest/huge_pages.hpp"
#include "ingest/limits.hpp"
#include "ingest/memory.hpp"
#include "row_parser.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/statistics/parallel.hpp"

namespace tribofit {
namespace {

// A chunk and its numbers stay in the cache of a core, and its share of the work is large against that of handing over.
// Chunks end where lines do and depend on the file only, not on the number of threads.
constexpr std::uint64_t chunk_bytes = std::uint64_t{1} << 17;
// Chunks that wait for one before them: as many as are read while memory is made present for the rows to come.
constexpr std::size_t most_waiting = 4;
constexpr std::size_t chunks_ahead = 6 * most_waiting;

/// What one chunk of lines gave; lines count from 1 at the chunk's beginning.
struct Chunk {
  std::vector<std::unique_ptr<double[]>> numbers;  // of each wanted cell
  std::vector<double*> values;                     // where they begin
  std::size_t capacity = 0, rows = 0;
  std::vector<std::pair<std::size_t, std::size_t>> line_starts;  // row, line
  std::size_t lines = 0;
  std::size_t text_rows = 0;
  std::vector<TextLine> text;  // rows and lines of the chunk
  std::optional<RawDefect> first_gap;
  std::size_t wrong_line = 0;
  std::optional<RowParser::Defect> defect;
  std::optional<std::size_t> long_line;
  std::exception_ptr failure;

  /// Empty, with the memory that it had.
  void clear() {
    Chunk empty;
    empty.numbers = std::move(numbers);
    empty.values = std::move(values);
    empty.capacity = capacity;
    *this = std::move(empty);
  }

  /// Memory that is not touched costs nothing.
  void make_room(std::size_t columns, std::size_t most_rows) {
    if (most_rows <= capacity && columns == numbers.size()) return;
    capacity = most_rows;
    numbers.resize(columns);
    values.clear();
    for (auto& column : numbers) {
      column = std::make_unique_for_overwrite<double[]>(capacity);
      values.push_back(column.get());
    }
  }
};

class RowReader {
 public:
  RowReader(const InputFile& file, const Dialect& dialect, const std::vector<WantedCell>& wanted)
      : file_(file), dialect_(dialect), wanted_(wanted), next_line_(dialect.data_line) {
    const std::uint64_t bytes = dialect.data_end - dialect.data_begin;
    chunks_ = static_cast<std::size_t>((bytes + chunk_bytes - 1) / chunk_bytes);
    // Memory that is reserved and not used costs nothing, growing a vector twice its size does.
    const auto estimate = static_cast<std::size_t>(1.2 * rows_in(bytes)) + 64;
    refuse_beyond_memory(rows_in(bytes), wanted.size(), file.path());
    rows_expected_ = static_cast<std::size_t>(rows_in(bytes));
    rows_.values.resize(wanted.size());
    for (auto& values : rows_.values) {
      values.reserve(estimate);
      prefer_huge_pages(values, rows_expected_);
      reserved_.push_back(values.data());
    }
  }

  Rows read(int threads) {
    const std::size_t available = static_cast<std::size_t>(threads > 0 ? threads : available_threads());
    const std::size_t helpers = std::min(available, chunks_) - (chunks_ > 0 ? 1 : 0);
    for (std::size_t k = 0; k < most_waiting + helpers + 1; ++k) spare_.push_back(std::make_unique<Chunk>());
    wanted_rows_ = static_cast<std::size_t>(rows_in(chunks_ahead * chunk_bytes));
    {
      const HelperThreads others(helpers, [this] { work(); });
      work();
    }
    if (failure_) std::rethrow_exception(failure_);
    return std::move(rows_);
  }

 private:
  void work() {
    std::vector<char> text;
    for (std::size_t i = next_chunk_++; i < chunks_; i = next_chunk_++) {
      std::unique_ptr<Chunk> chunk = place_for(i);
      if (!chunk) return;
      try {
        make_present_ahead();
        parse(i, text, *chunk);
      } catch (...) {
        chunk->failure = std::current_exception();
      }
      if (!hand_over(i, std::move(chunk))) return;
    }
  }

  /// Somewhere to read a chunk into, once few enough wait; null after a failure.
  std::unique_ptr<Chunk> place_for(std::size_t i) {
    std::unique_lock lock(mutex_);
    turn_changed_.wait(lock, [&] { return i < turn_ + most_waiting || failure_; });
    if (failure_) return nullptr;
    std::unique_ptr<Chunk> chunk = std::move(spare_.back());  // its memory has been touched
    spare_.pop_back();
    return chunk;
  }

  /// Appends what has its turn: this chunk and those that wait for it, or neither. False after a failure.
  bool hand_over(std::size_t i, std::unique_ptr<Chunk> chunk) {
    const std::lock_guard lock(mutex_);
    waiting_[i % most_waiting] = std::move(chunk);
    while (!failure_ && waiting_[turn_ % most_waiting]) {
      std::unique_ptr<Chunk> next = std::move(waiting_[turn_ % most_waiting]);
      try {
        append(*next);
      } catch (...) {
        failure_ = std::current_exception();
      }
      wanted_rows_ = rows_.size() + chunks_ahead * next->rows;
      next->clear();
      spare_.push_back(std::move(next));
      ++turn_;
    }
    turn_changed_.notify_all();
    return !failure_;
  }

  double rows_in(std::uint64_t bytes) const { return static_cast<double>(bytes) / std::max(2.0, dialect_.row_bytes); }

  /// Memory for the rows of the chunks to come: whoever appends would wait for it, and all others for him.
  void make_present_ahead() {
    constexpr std::size_t kRowsAtOnce = std::size_t{1} << 15;
    const std::size_t rows = std::min<std::size_t>(rows_expected_, wanted_rows_);
    for (std::size_t from = present_; from < rows; from = present_) {
      if (!present_.compare_exchange_strong(from, from + kRowsAtOnce)) continue;
      const std::size_t to = std::min(from + kRowsAtOnce, rows_expected_);
      for (double* values : reserved_) make_present(values, from, to);
    }
  }

  std::uint64_t chunk_begin(std::size_t i) const {
    const std::uint64_t nominal = dialect_.data_begin + i * chunk_bytes;
    return i == 0 ? nominal : file_.line_start(std::min(nominal, dialect_.data_end), dialect_.data_end);
  }

  void parse(std::size_t i, std::vector<char>& text, Chunk& chunk) const {
    const std::uint64_t begin = chunk_begin(i);
    std::uint64_t end = begin;
    try {
      end = chunk_begin(i + 1);
    } catch (const InputError&) {
      chunk.long_line = find_long_line(begin);
      return;
    }
    if (begin >= end) return;
    const std::size_t size = read_text(begin, end, text, chunk);
    parse_lines(text.data(), size, chunk);
  }

  /// The bytes of a chunk, up to a NUL that would cut a line unseen.
  std::size_t read_text(std::uint64_t begin, std::uint64_t end, std::vector<char>& text, Chunk& chunk) const {
    const auto wanted = static_cast<std::size_t>(end - begin);
    if (text.size() < wanted + 1 + kReadBeyond) text.resize(wanted + 1 + kReadBeyond);
    const std::size_t count = file_.read(begin, std::span(text).first(wanted));
    const void* zero = std::memchr(text.data(), '\0', count);
    if (zero == nullptr) return count;
    const char* at = static_cast<const char*>(zero);
    chunk.wrong_line = 1 + static_cast<std::size_t>(std::count<const char*>(text.data(), at, '\n'));
    chunk.defect =
        RowParser::Defect{"the line holds a NUL byte", "the file is damaged here or binary; export it again", ""};
    return static_cast<std::size_t>(at - text.data());  // the lines before may hold an earlier defect
  }

  /// A line too long to be found the end of begins after the last line end of the chunk.
  std::size_t find_long_line(std::uint64_t begin) const {
    std::string text(static_cast<std::size_t>(chunk_bytes), '\0');
    text.resize(file_.read(begin, text));
    return 1 + static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }

  /// Rows of at least this many bytes follow from the cells that a row has, if all have them.
  std::size_t shortest_row() const { return dialect_.blocks_apart ? 1 : std::max<std::size_t>(1, dialect_.columns); }

  /// `text` has kReadBeyond bytes and one more than `size`.
  void parse_lines(char* text, std::size_t size, Chunk& chunk) const {
    RowParser parser(wanted_, dialect_.columns, dialect_.separator, dialect_.decimal, dialect_.blocks_apart);
    constexpr std::size_t kLineMore = 4096;  // a chunk ends with its last line
    chunk.make_room(wanted_.size(), std::max<std::size_t>(size, chunk_bytes + kLineMore) / shortest_row() + 2);
    std::vector<double> row(wanted_.size());
    bool follows = false;  // the line before gave a row too
    const auto count_rows = [&](std::size_t from) {
      if (chunk.rows == from) return;
      if (!follows) chunk.line_starts.emplace_back(from, chunk.lines + 1);
      follows = true;
      chunk.lines += chunk.rows - from;
    };
    char* const end = text + size;
    *end = '\0';
    for (char* at = text; at < end;) {
      std::size_t before = chunk.rows;
      at = parser.parse_plain_rows(at, end, chunk.values, chunk.rows);
      count_rows(before);
      if (at >= end) return;
      const RowParser::Outcome outcome = parser.parse(ended_line(at, end), row.data());
      if (outcome == RowParser::Outcome::numbers) {
        if (parser.is_gappy() && !chunk.first_gap) chunk.first_gap = gap_of(parser, row, chunk);
        for (std::size_t k = 0; k < row.size(); ++k) chunk.values[k][chunk.rows] = row[k];
        before = chunk.rows++;
        count_rows(before);
        continue;
      }
      ++chunk.lines;
      follows = false;
      if (outcome == RowParser::Outcome::blank) continue;
      if (outcome == RowParser::Outcome::wrong) {
        if (!chunk.defect || chunk.lines < chunk.wrong_line) {
          chunk.defect = parser.defect();
          chunk.wrong_line = chunk.lines;
        }
        return;
      }
      ++chunk.text_rows;
      if (chunk.text.size() < kMostTextLines) chunk.text.push_back({chunk.rows, chunk.lines, parser.text()});
    }
  }

  /// The line at `at`, ended by NUL in place of its line end; `at` goes on to the next.
  static char* ended_line(char*& at, char* end) {
    char* const line = at;
    char* stop = static_cast<char*>(std::memchr(line, '\n', static_cast<std::size_t>(end - line)));
    if (stop == nullptr) stop = end;
    at = stop + 1;
    if (stop > line && stop[-1] == '\r') --stop;
    *stop = '\0';
    return line;
  }

  RawDefect gap_of(const RowParser& parser, const std::vector<double>& row, const Chunk& chunk) const {
    const auto cell = std::find_if(row.begin(), row.end(), [](double value) { return value != value; }) - row.begin();
    return {chunk.rows, wanted_[static_cast<std::size_t>(cell)].index, parser.defect().problem, parser.defect().advice};
  }

  /// Called in the order of the file, one chunk at a time.
  void append(const Chunk& chunk) {
    if (chunk.failure) std::rethrow_exception(chunk.failure);
    if (chunk.long_line) file_.refuse_long_line(next_line_ + *chunk.long_line - 1);
    if (chunk.defect) {
      throw InputError(chunk.defect->problem, chunk.defect->advice,
                       {file_.path(), next_line_ + chunk.wrong_line - 1, chunk.defect->column});
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
    for (const auto& [row, line] : chunk.line_starts) rows_.lines.set(rows_.size() + row, next_line_ + line - 1);
    for (std::size_t k = 0; k < wanted_.size(); ++k) {
      rows_.values[k].insert(rows_.values[k].end(), chunk.values[k], chunk.values[k] + chunk.rows);
    }
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
  std::atomic<std::size_t> present_ = 0, wanted_rows_ = 0;  // rows for which there is memory, and will be needed soon
  std::size_t rows_expected_ = 0;
  std::vector<double*> reserved_;                             // where the memory of each column begins, at first
  std::size_t turn_ = 0;                                      // the chunk whose turn it is to be appended
  std::array<std::unique_ptr<Chunk>, most_waiting> waiting_;  // read, at their number modulo the size
  std::vector<std::unique_ptr<Chunk>> spare_;
  std::exception_ptr failure_;
  std::size_t next_line_;
  Rows rows_;
};

}  // namespace

Rows read_rows(const InputFile& file, const Dialect& dialect, const std::vector<WantedCell>& wanted, int threads) {
  return RowReader(file, dialect, wanted).read(threads);
}

}  // namespace tribofit
