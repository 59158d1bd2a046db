#pragma once

// fast-cpp-csv-parser, without its reading thread: we read in several.
#define CSV_IO_NO_THREAD
#pragma GCC diagnostic push
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wstringop-truncation"  // its file names are cut to a buffer on purpose
#endif
#include <libfccp/csv.h>
#pragma GCC diagnostic pop
