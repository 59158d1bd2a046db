#include "memory.hpp"

#include <cstdlib>  // says whether this is glibc

#ifdef __GLIBC__
#include <malloc.h>
#endif

void give_memory_back() {
#ifdef __GLIBC__
  ::mallopt(M_MMAP_THRESHOLD, 4 << 20);
  ::mallopt(M_TRIM_THRESHOLD, 4 << 20);  // small blocks are kept: asking for them anew costs more than they are worth
#endif
}

void keep_memory() {
#ifdef __GLIBC__
  ::mallopt(M_ARENA_MAX, 2);
  ::mallopt(M_MMAP_THRESHOLD, 8 << 20);  // channels of records of minutes go back
  ::mallopt(M_TRIM_THRESHOLD, 64 << 20);
#endif
}

void share_memory() {
#ifdef __GLIBC__
  ::mallopt(M_ARENA_MAX, 1);
#endif
}
