#pragma once

#include <httplib.h>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <mutex>

namespace tribofit::workbench {

/// The library's server with connections that cannot hold one another up. The library gives those that wait to a few
/// threads in turn: behind hundreds that send nothing, or a byte a second, the user's page would not be answered.
/// Here each connection has a thread of its own, one request, which must arrive within a second, and an answer, which
/// must be taken within ten.
class LoopbackServer : public httplib::Server {
 public:
  LoopbackServer() = default;
  ~LoopbackServer() override;

  /// Answers on the port that was bound before, until end() is called; what is being answered then is waited for.
  void serve();
  /// Ends serve(), also one that is called later.
  void end();

 private:
  void begin(int socket);
  void answer(int socket);
  void leave();

  std::atomic<bool> ended_{false};
  std::mutex mutex_;
  std::condition_variable left_;
  std::size_t connections_ = 0;
};

}  // namespace tribofit::workbench
