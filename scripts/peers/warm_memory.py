"""Touches memory and gives it back, before a process that is timed.

A virtual machine may give pages that are free for some seconds back to its host; the first touch of such a page then
takes twenty times as long (measured: 440 to 860 MB/s against 10 to 12 GB/s), which would be counted as time of
whichever contender happens to meet it.

usage: warm_memory.py MEGABYTES
"""

import errno
import mmap
import sys

POPULATE_WRITE = 23  # MADV_POPULATE_WRITE of Linux 5.14, which the module has no name for

with mmap.mmap(-1, int(sys.argv[1]) << 20, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS) as memory:
    try:
        memory.madvise(mmap.MADV_HUGEPAGE)
        memory.madvise(POPULATE_WRITE)
    except OSError as error:
        if error.errno != errno.EINVAL:  # of a kernel that does not know it
            raise
        for page in range(0, len(memory), mmap.PAGESIZE):
            memory[page] = 1
