#include "apart.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef __linux__
#include <malloc.h>
#include <sys/prctl.h>
#endif

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

#include "ingest/input_file.hpp"
#include "ingest/limits.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

/// What stands before each answer.
struct Head {
  std::uint64_t is_refusal, size;
};

void answer(int pipe, bool is_refusal, std::string_view bytes) {
  const Head head = {is_refusal, bytes.size()};
  for (std::string_view part : {std::string_view(reinterpret_cast<const char*>(&head), sizeof head), bytes}) {
    while (!part.empty()) {
      const ssize_t count = ::write(pipe, part.data(), part.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) ::_exit(EXIT_FAILURE);  // nobody listens
      part.remove_prefix(static_cast<std::size_t>(count));
    }
  }
}

void limit_process(std::uint64_t memory) {
#ifdef __linux__
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::mallopt(M_PERTURB, 0x80);  // what is allocated and not filled, of doubles, is 1.4e306: no number of a usable size
#endif
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  const std::uint64_t most = used_memory() + memory;
  const rlimit no_core = {0, 0}, time = {kLongestMatRead, kLongestMatRead + 1}, space = {most, most};
  ::setrlimit(RLIMIT_CORE, &no_core);
  ::setrlimit(RLIMIT_CPU, &time);
  ::setrlimit(RLIMIT_AS, &space);
}

/// The end of this process, which is the child: it leaves nothing of what the parent has half done.
[[noreturn]] void work_apart(int pipe, std::uint64_t memory, const std::function<void(const Answers&)>& work) {
  limit_process(memory);
  const Answers answers(pipe);
  try {
    work(answers);
  } catch (const InputError& error) {
    answers.refuse(error);
  } catch (...) {
    ::_exit(EXIT_FAILURE);
  }
  ::_exit(EXIT_SUCCESS);
}

[[noreturn]] void refuse(const std::string& path, const std::string& problem) {
  throw InputError(problem, "the file is damaged; copy it again, or save it again with save(..., '-v7')",
                   {path, 0, ""});
}

}  // namespace

void Answers::send(std::string_view bytes) const {
  answer(pipe_, false, bytes);
}

void Answers::refuse(const InputError& error) const {
  std::string parts;
  for (const std::string& part : {error.problem(), error.advice(), error.where().file, error.where().column})
    parts += part + '\0';
  answer(pipe_, true, parts);
}

Apart::Apart(std::string path, std::uint64_t memory, const std::function<void(const Answers&)>& work)
    : path_(std::move(path)), most_(memory) {
  static std::mutex mutex;  // no child inherits the writing end of another's pipe
  const std::lock_guard lock(mutex);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) refuse(path_, std::string("cannot be read: ") + std::strerror(errno));
  child_ = ::fork();
  if (child_ == 0) {
    ::close(ends[0]);
    work_apart(ends[1], memory, work);
  }
  const int error = errno;
  ::close(ends[1]);
  pipe_ = ends[0];
  if (child_ < 0) {
    ::close(pipe_);
    refuse(path_, std::string("cannot be read: ") + std::strerror(error));
  }
}

Apart::~Apart() {
  ::close(pipe_);  // a child that still writes ends by it
  while (child_ > 0 && ::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

std::size_t Apart::next_size() {
  Head head{};
  receive({reinterpret_cast<char*>(&head), sizeof head});
  if (head.size > most_) refuse_broken_off();
  if (head.is_refusal == 0) return head.size;
  std::string bytes(head.size, '\0');
  receive(bytes);
  const std::vector<std::string> parts = split(bytes, '\0');
  throw InputError(parts[0], parts[1], {parts[2], 0, parts[3]});
}

void Apart::receive(std::span<char> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::read(pipe_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) refuse_broken_off();
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

void Apart::refuse_broken_off() {
  while (child_ > 0 && ::waitpid(child_, &status_, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
  const int signal = WIFSIGNALED(status_) ? WTERMSIG(status_) : 0;
  const bool took_long = signal == SIGXCPU || signal == SIGKILL;
  refuse(path_, took_long     ? "the library that reads MATLAB files did not come to an end with it"
                : signal != 0 ? "the library that reads MATLAB files crashed on it"
                              : "the reading of the file broke off");
}

}  // namespace tribofit
