#include "report/charts/gnuplot_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string_view>

#include "report/charts/gnuplot_text.hpp"
#include "tribofit/ingest/input_error.hpp"

extern char** environ;

namespace tribofit {
namespace {

[[noreturn]] void fail(const std::string& reason) {
  throw InputError("the pictures cannot be drawn: " + reason,
                   "check that gnuplot runs and that there is room for its files");
}

/// A file without a name that is gone when nobody has it open any more, also where the program is killed. gnuplot
/// inherits it and opens it again by its number.
class NamelessFile {
 public:
  NamelessFile() : file_(std::tmpfile()) {
    if (!file_) fail(std::string("there is no place for temporary files: ") + std::strerror(errno));
  }
  int descriptor() const { return ::fileno(file_.get()); }
  std::string name() const { return "/dev/fd/" + std::to_string(descriptor()); }
  void write(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() || std::fflush(file_.get()) != 0) {
      fail(std::strerror(errno));
    }
    std::rewind(file_.get());
  }
  std::string content() {
    std::rewind(file_.get());
    std::string out;
    std::array<char, 1 << 16> buffer{};
    while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file_.get()))
      out.append(buffer.data(), count);
    return out;
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
};

/// Streams of the child: script, nothing, messages.
class FileActions {
 public:
  FileActions(const NamelessFile& script, const NamelessFile& messages) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_adddup2(&actions_, script.descriptor(), STDIN_FILENO);
    ::posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions_, messages.descriptor(), STDERR_FILENO);
  }
  ~FileActions() { ::posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

/// Status of the program as waitpid() gives it.
int run(const NamelessFile& script, const NamelessFile& messages) {
  const FileActions actions(script, messages);
  std::string program = "gnuplot", defaults = "-d";  // nothing of the user's own settings
  std::array<char*, 3> arguments{program.data(), defaults.data(), nullptr};
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, program.c_str(), actions.get(), nullptr, arguments.data(), environ);
  if (error != 0) fail(std::string("gnuplot does not start: ") + std::strerror(error));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) fail(std::strerror(errno));
  }
  return status;
}

/// The last lines of what gnuplot says, on one.
std::string said(NamelessFile& messages) {
  std::string text = messages.content();
  if (text.size() > 400) text = text.substr(text.size() - 400);
  std::string out;
  for (const char c : one_line(text)) {
    if (c != ' ' || (!out.empty() && out.back() != ' ')) out += c;
  }
  while (out.ends_with(' ')) out.pop_back();
  return out.empty() ? "" : ": " + out;
}

}  // namespace

bool gnuplot_is_installed() {
  const char* path = std::getenv("PATH");
  std::string_view folders = path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin";
  for (;;) {
    const std::size_t end = folders.find(':');
    const std::string folder(folders.substr(0, end));
    if (::access(((folder.empty() ? "." : folder) + "/gnuplot").c_str(), X_OK) == 0) return true;
    if (end == std::string_view::npos) return false;
    folders.remove_prefix(end + 1);
  }
}

std::vector<std::string> run_gnuplot(
    std::size_t count, const std::function<std::string(const std::vector<std::string>& outputs)>& write_script) {
  if (!gnuplot_is_installed()) {
    throw InputError("gnuplot, which draws the pictures, is not installed",
                     "install it (Debian: apt install gnuplot-nox, or scripts/setup figures)");
  }
  NamelessFile script, messages;
  std::vector<NamelessFile> outputs(count);
  std::vector<std::string> names;
  for (const NamelessFile& output : outputs) names.push_back(output.name());
  script.write(write_script(names));
  const int status = run(script, messages);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail("gnuplot failed" + said(messages));
  std::vector<std::string> written;
  for (NamelessFile& output : outputs) {
    written.push_back(output.content());
    if (written.back().empty()) fail("gnuplot wrote an empty picture" + said(messages));
  }
  return written;
}

}  // namespace tribofit
