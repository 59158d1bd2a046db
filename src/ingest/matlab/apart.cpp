#include "apart.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

#include "ingest/byte_cursor.hpp"
#include "ingest/byte_writer.hpp"
#include "ingest/limits.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

enum class Answer : std::uint8_t { bytes, refused, no_memory };

/// What the process answers: the bytes, or the parts of the error.
std::pair<Answer, std::string> answer_of(const std::function<std::string()>& work) {
  try {
    return {Answer::bytes, work()};
  } catch (const InputError& error) {
    ByteWriter out;
    out.text(error.problem()).text(error.advice()).text(error.where().file).text(error.where().column);
    return {Answer::refused, out.take()};
  } catch (const std::bad_alloc&) {
    return {Answer::no_memory, {}};
  }
}

bool send(int pipe, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(pipe, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

/// The end of this process, which is the child: it leaves nothing of what the parent has half done.
[[noreturn]] void answer(int pipe, const std::function<std::string()>& work) {
#ifdef __linux__
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  const rlimit no_core = {0, 0}, time = {kLongestMatRead, kLongestMatRead + 1};
  ::setrlimit(RLIMIT_CORE, &no_core);
  ::setrlimit(RLIMIT_CPU, &time);
  int status = EXIT_FAILURE;
  try {
    const auto [answer, bytes] = answer_of(work);
    const std::string head = ByteWriter().number(answer).number(static_cast<std::uint64_t>(bytes.size())).take();
    if (send(pipe, head) && send(pipe, bytes)) status = EXIT_SUCCESS;
  } catch (...) {  // nobody is left to report it to
  }
  ::_exit(status);
}

/// What comes through the pipe until its end. `expected`: bytes for which there is room at once.
std::string receive(int pipe, std::size_t expected, std::size_t most) {
  std::string bytes;
  bytes.reserve(expected);
  std::array<char, 1 << 16> part;
  while (bytes.size() < most) {
    const ssize_t count = ::read(pipe, part.data(), std::min(part.size(), most - bytes.size()));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    bytes.append(part.data(), static_cast<std::size_t>(count));
  }
  return bytes;
}

/// What the process answered; nothing where it broke off.
struct Reply {
  std::optional<Answer> answer;
  std::string bytes;
};

Reply reply_of(int pipe) {
  constexpr std::size_t head_bytes = 1 + sizeof(std::uint64_t), most_at_once = std::size_t{1} << 30;
  const std::string head = receive(pipe, head_bytes, head_bytes);
  if (head.size() < head_bytes) return {};
  const auto size = number_at<std::uint64_t>(head, 1, native_big_endian);
  Reply reply{static_cast<Answer>(head.front()), {}};
  reply.bytes = receive(pipe, std::min<std::uint64_t>(size, most_at_once), std::string::npos);
  if (reply.bytes.size() != size) reply.answer.reset();
  return reply;
}

[[noreturn]] void refuse(const std::string& path, const std::string& problem) {
  throw InputError(problem, "the file is damaged; copy it again, or save it again with save(..., '-v7')",
                   {path, 0, ""});
}

std::string result_of(const std::string& path, Reply reply) {
  if (!reply.answer) refuse(path, "the reading of the file broke off");
  if (*reply.answer == Answer::bytes) return std::move(reply.bytes);
  if (*reply.answer == Answer::no_memory) throw std::bad_alloc();
  ByteCursor cursor(std::move(reply.bytes),
                    [&](std::uint64_t, std::uint64_t) { refuse(path, "the reading of the file broke off"); });
  std::string problem = cursor.text(native_big_endian), advice = cursor.text(native_big_endian),
              file = cursor.text(native_big_endian), column = cursor.text(native_big_endian);
  throw InputError(std::move(problem), std::move(advice), {std::move(file), 0, std::move(column)});
}

}  // namespace

std::string run_apart(const std::string& path, const std::function<std::string()>& work) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) refuse(path, std::string("cannot be read: ") + std::strerror(errno));
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    answer(ends[1], work);
  }
  const int error = errno;
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    refuse(path, std::string("cannot be read: ") + std::strerror(error));
  }
  Reply reply;
  std::exception_ptr failure;
  try {
    reply = reply_of(ends[0]);
  } catch (...) {
    failure = std::current_exception();
  }
  ::close(ends[0]);  // a child that still writes ends by it
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (failure) std::rethrow_exception(failure);
  if (WIFSIGNALED(status)) {
    refuse(path, WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL
                     ? "the library that reads version 7.3 did not come to an end with it"
                     : "the library that reads version 7.3 crashed on it");
  }
  return result_of(path, std::move(reply));
}

}  // namespace tribofit
