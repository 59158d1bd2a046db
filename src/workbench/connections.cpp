#include "connections.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <exception>
#include <optional>
#include <string>
#include <system_error>
#include <thread>

namespace tribofit::workbench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kReceiving = std::chrono::seconds(1);  // a whole request
constexpr auto kSending = std::chrono::seconds(10);   // a whole answer, from its first byte
constexpr std::size_t kMostBytes = 1 << 20;           // of a request with its head
constexpr std::size_t kMostConnections = 2048;
constexpr int kBacklog = 512;  // the library listens with 5: further callers would wait for a second to call again

/// One request and its answer, each within its time.
class Connection : public httplib::Stream {
 public:
  explicit Connection(int socket) : socket_(socket) {}
  ~Connection() override {
    ::shutdown(socket_, SHUT_RDWR);
    ::close(socket_);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool is_readable() const override { return at_ < end_ || waits_for(POLLIN, receive_until_); }
  bool is_writable() const override { return waits_for(POLLOUT, send_until_.value_or(Clock::now() + kSending)); }

  ssize_t read(char* to, std::size_t size) override {
    if (at_ == end_ && !fill()) return -1;
    const std::size_t count = std::min(size, end_ - at_);
    std::memcpy(to, buffer_.data() + at_, count);
    at_ += count;
    return static_cast<ssize_t>(count);
  }

  ssize_t write(const char* from, std::size_t size) override {
    if (!send_until_) send_until_ = Clock::now() + kSending;
    for (std::size_t done = 0; done < size;) {
      if (!is_writable()) return -1;
      const ssize_t count = ::send(socket_, from + done, size - done, MSG_NOSIGNAL | MSG_DONTWAIT);
      if (count < 0 && errno != EAGAIN && errno != EINTR) return -1;
      done += static_cast<std::size_t>(std::max<ssize_t>(0, count));
    }
    return static_cast<ssize_t>(size);
  }

  void get_remote_ip_and_port(std::string& ip, int& port) const override { ip = "127.0.0.1", port = 0; }
  void get_local_ip_and_port(std::string& ip, int& port) const override { get_remote_ip_and_port(ip, port); }
  int socket() const override { return socket_; }

 private:
  bool waits_for(short what, Clock::time_point until) const {
    for (;;) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
      if (left <= 0) return false;
      pollfd waiting = {socket_, what, 0};
      const int ready = ::poll(&waiting, 1, static_cast<int>(left));
      if (ready > 0) return true;
      if (ready < 0 && errno != EINTR) return false;
    }
  }

  bool fill() {
    if (received_ >= kMostBytes || !is_readable()) return false;
    const ssize_t count = ::recv(socket_, buffer_.data(), buffer_.size(), 0);
    at_ = 0;
    end_ = static_cast<std::size_t>(std::max<ssize_t>(0, count));
    received_ += end_;
    return end_ > 0;
  }

  int socket_;
  Clock::time_point receive_until_ = Clock::now() + kReceiving;
  std::optional<Clock::time_point> send_until_;
  std::array<char, 4096> buffer_;
  std::size_t at_ = 0, end_ = 0, received_ = 0;
};

}  // namespace

LoopbackServer::~LoopbackServer() {
  if (const int socket = svr_sock_.exchange(INVALID_SOCKET); socket != INVALID_SOCKET) ::close(socket);
}

void LoopbackServer::serve() {
  ::listen(svr_sock_, kBacklog);
  while (!ended_) {
    const int socket = ::accept4(svr_sock_, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket >= 0) {
      begin(socket);
    } else if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));  // the connections there are end soon
    } else if (errno != EINTR && errno != ECONNABORTED) {
      break;
    }
  }
  std::unique_lock lock(mutex_);
  left_.wait(lock, [&] { return connections_ == 0; });
}

void LoopbackServer::end() {
  ended_ = true;
  ::shutdown(svr_sock_, SHUT_RDWR);  // wakes who waits for a connection
}

void LoopbackServer::begin(int socket) {
  {
    const std::lock_guard lock(mutex_);
    if (connections_ == kMostConnections) {
      ::close(socket);
      return;
    }
    ++connections_;
  }
  try {
    std::thread([this, socket] { answer(socket); }).detach();
  } catch (const std::system_error&) {  // no more threads: one after another, then
    answer(socket);
  }
}

void LoopbackServer::answer(int socket) {
  try {
    constexpr int kOn = 1;
    ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &kOn, sizeof kOn);
    Connection connection(socket);
    bool closed = false;
    if (connection.is_readable()) process_request(connection, true, closed, nullptr);
  } catch (const std::exception&) {  // without memory for it the connection is dropped
  }
  leave();
}

void LoopbackServer::leave() {
  const std::lock_guard lock(mutex_);
  --connections_;
  left_.notify_all();
}

}  // namespace tribofit::workbench
