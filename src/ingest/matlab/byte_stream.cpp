#include "byte_stream.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "contents.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {

ByteStream::ByteStream(const InputFile& file, std::uint64_t begin, std::uint64_t end, bool inflate, std::uint64_t most)
    : file_(file), begin_(begin), at_(begin), end_(end), most_(most), inflates_(inflate) {
  if (inflates_ && inflateInit(&z_) != Z_OK) refuse("cannot be inflated");
}

ByteStream::~ByteStream() {
  if (inflates_) inflateEnd(&z_);
}

void ByteStream::read(std::span<char> buffer) {
  if (inflates_) {
    read_inflated(buffer);
  } else {
    if (buffer.size() > end_ - at_ || file_.read(at_, buffer) < buffer.size()) refuse("the variable is cut off");
    at_ += buffer.size();
  }
  position_ += buffer.size();
}

void ByteStream::read_inflated(std::span<char> buffer) {
  if (buffer.size() > most_left()) refuse_bomb();
  constexpr std::size_t most = 1 << 30;  // zlib counts in 32 bits
  while (!buffer.empty()) {
    const std::size_t wanted = std::min(buffer.size(), most);
    z_.next_out = reinterpret_cast<Bytef*>(buffer.data());
    z_.avail_out = static_cast<uInt>(wanted);
    while (z_.avail_out > 0) {
      if (z_.avail_in == 0) {
        const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(packed_.size(), end_ - at_));
        z_.avail_in = static_cast<uInt>(file_.read(at_, std::span(packed_).first(count)));
        z_.next_in = reinterpret_cast<Bytef*>(packed_.data());
        at_ += z_.avail_in;
      }
      const uInt before = z_.avail_out;
      const int state = inflate(&z_, Z_NO_FLUSH);
      if (state == Z_STREAM_END && z_.avail_out == 0) break;
      if (state != Z_OK || (z_.avail_in == 0 && at_ >= end_ && z_.avail_out == before)) {
        refuse(state == Z_STREAM_END || state == Z_BUF_ERROR ? "the variable is cut off"
                                                             : "the variable cannot be inflated");
      }
    }
    buffer = buffer.subspan(wanted);
  }
}

void ByteStream::skip(std::uint64_t count) {
  if (!inflates_) {
    if (count > end_ - at_) refuse("the variable is cut off");
    at_ += count;
    position_ += count;
    return;
  }
  std::array<char, 1 << 14> ignored;
  while (count > 0) {
    const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(ignored.size(), count));
    read(std::span(ignored).first(part));
    count -= part;
  }
}

std::uint64_t ByteStream::most_left() const {
  if (!inflates_) return end_ - at_;
  return most_ - std::min(most_, position_);
}

void ByteStream::refuse_bomb() const {
  throw InputError(fmt::format("byte {}: the variables inflate to more than the {} bytes that a file of {} may hold",
                               begin_, most_mat_bytes(file_.size()), file_.size()),
                   "save the variables that are needed, with save(..., '-v6')", {file_.path(), 0, ""});
}

void ByteStream::expect(std::uint64_t size, const std::string& what) const {
  if (size <= most_left()) return;
  if (inflates_) refuse_bomb();
  refuse(fmt::format("{} of {} bytes, of which {} can follow", what, size, most_left()));
}

void ByteStream::refuse(const std::string& problem) const {
  const std::uint64_t at = inflates_ ? begin_ : at_;
  throw InputError(fmt::format("byte {}: {}{}", at, problem,
                               inflates_ ? fmt::format(" ({} bytes into what is inflated)", position_) : std::string()),
                   "the file is cut off or damaged; copy or save it again", {file_.path(), 0, ""});
}

}  // namespace tribofit
