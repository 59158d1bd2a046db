#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "tribofit/ingest/input_error.hpp"

namespace tribofit {

/// The way of a process of its own to answer the one that started it.
class Answers {
 public:
  explicit Answers(int pipe) : pipe_(pipe) {}
  void send(std::string_view bytes) const;
  void refuse(const InputError& error) const;

 private:
  int pipe_;
};

/// Work in a process of its own: what a damaged file does to the libraries that read it ends that process and not this
/// one. Cost: a fork, and a copy of what is answered.
class Apart {
 public:
  /// `memory`: bytes that the process may take beside those that this one has. An InputError that `work` throws is its
  /// last answer.
  Apart(std::string path, std::uint64_t memory, const std::function<void(const Answers&)>& work);
  ~Apart();
  Apart(const Apart&) = delete;
  Apart& operator=(const Apart&) = delete;

  /// The next answer, a string or a vector of numbers. Throws the InputError that came in its place, and one for the
  /// file where the process crashed, asked for more memory or took minutes of processor time.
  template <class Values>
  Values next() {
    Values values;
    values.resize(next_size() / sizeof values[0]);
    receive({reinterpret_cast<char*>(values.data()), values.size() * sizeof values[0]});
    return values;
  }

 private:
  std::size_t next_size();
  void receive(std::span<char> bytes);
  [[noreturn]] void refuse_broken_off();

  std::string path_;
  std::uint64_t most_;  // bytes of an answer
  int pipe_ = -1;
  pid_t child_ = -1;
  int status_ = 0;
};

}  // namespace tribofit
