#pragma once

#include <functional>
#include <string>

namespace tribofit {

/// The bytes that `work` returns, run in a process of its own: what a damaged file does to the libraries that read it
/// ends that process and not this one. Throws the InputError that `work` throws, std::bad_alloc likewise, and an
/// InputError for `path` where the process crashed or took minutes of processor time.
/// Cost: a fork, and a copy of the bytes.
std::string run_apart(const std::string& path, const std::function<std::string()>& work);

}  // namespace tribofit
