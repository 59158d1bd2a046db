#include "apart.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>
#include <utility>

#include "ingest/byte_cursor.hpp"
#include "ingest/byte_writer.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

constexpr rlim_t longest = 120;  // [s] of processor time

enum class Answer : std::uint8_t { bytes, refused, no_memory };

/// What the process answers: what it is, then the bytes, or the parts of the error.
std::string answer_of(const std::function<std::string()>& work) {
  try {
    const std::string bytes = work();
    return ByteWriter().number(Answer::bytes).take() + bytes;
  } catch (const InputError& error) {
    ByteWriter out;
    out.number(Answer::refused).text(error.problem()).text(error.advice());
    out.text(error.where().file).text(error.where().column);
    return out.take();
  } catch (const std::bad_alloc&) {
    return ByteWriter().number(Answer::no_memory).take();
  }
}

/// The end of this process, which is the child: it leaves nothing of what the parent has half done.
[[noreturn]] void answer(int pipe, const std::function<std::string()>& work) {
#ifdef __linux__
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  const rlimit no_core = {0, 0}, time = {longest, longest + 1};
  ::setrlimit(RLIMIT_CORE, &no_core);
  ::setrlimit(RLIMIT_CPU, &time);
  int status = EXIT_FAILURE;
  try {
    const std::string bytes = answer_of(work);
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t count = ::write(pipe, bytes.data() + done, bytes.size() - done);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) break;
      done += static_cast<std::size_t>(count);
    }
    if (done == bytes.size()) status = EXIT_SUCCESS;
  } catch (...) {  // nobody is left to be told
  }
  ::_exit(status);
}

std::string read_to_end(int pipe) {
  std::string bytes;
  std::array<char, 1 << 16> part;
  while (true) {
    const ssize_t count = ::read(pipe, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return bytes;
    bytes.append(part.data(), static_cast<std::size_t>(count));
  }
}

[[noreturn]] void refuse(const std::string& path, const std::string& problem) {
  throw InputError(problem, "the file is damaged; copy it again, or save it again with save(..., '-v7')",
                   {path, 0, ""});
}

std::string result_of(const std::string& path, std::string bytes) {
  if (!bytes.empty() && bytes.front() == static_cast<char>(Answer::bytes)) return std::move(bytes.erase(0, 1));
  ByteCursor cursor(std::move(bytes),
                    [&](std::uint64_t, std::uint64_t) { refuse(path, "the reading of the file broke off"); });
  if (cursor.number<Answer>(native_big_endian) == Answer::no_memory) throw std::bad_alloc();
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
  std::string bytes;
  std::exception_ptr failure;
  try {
    bytes = read_to_end(ends[0]);
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
  return result_of(path, std::move(bytes));
}

}  // namespace tribofit
