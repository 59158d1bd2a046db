#pragma once

#include <cstdlib>  // says whether this is glibc

#ifdef __GLIBC__
#include <malloc.h>
#endif

/// How the memory that is freed is kept for what comes next. To be called before the first thread begins.
enum class Memory {
  /// Channels come and go by tens of megabytes. What is given back to the system is cleared by it before it comes
  /// again, which takes a tenth of the time of a fit.
  kept,
  /// Blocks of the size of a channel go back to the system when they are freed, whichever thread freed them: else each
  /// thread's own heap keeps the largest trace it has seen. Small blocks are kept.
  given_back,
  /// Threads that come and go take their memory from two heaps, which keep what is freed, but for channels of records
  /// of minutes: asking the system for it anew takes a fifth of the time of an answer.
  of_two_heaps,
  /// All threads take their memory from one heap: where they seldom ask for any, as in fits, a heap for each of them
  /// only costs 2 MB.
  of_one_heap
};

inline void set_memory([[maybe_unused]] Memory how) {
#ifdef __GLIBC__
  const auto set = [](int largest_kept, int unused_kept) {
    ::mallopt(M_MMAP_THRESHOLD, largest_kept << 20);
    ::mallopt(M_TRIM_THRESHOLD, unused_kept << 20);
  };
  if (how == Memory::kept) set(32, 1024);  // glibc takes no more for the first
  if (how == Memory::given_back) set(4, 4);
  if (how == Memory::of_two_heaps) set(8, 64);
  if (how == Memory::of_two_heaps) ::mallopt(M_ARENA_MAX, 2);
  if (how == Memory::of_one_heap) ::mallopt(M_ARENA_MAX, 1);
#endif
}
