#pragma once

#include "ingest/reader.hpp"

namespace tribofit {

/// MATLAB's files of version 5 to 7 and 7.3, by libmatio. Every numeric vector, row or column, is a column; those of a
/// matrix are columns "a(:,1)", those of a structure "a.b". Vectors of one length share rows. Scalars and lines of text
/// are facts: fs and dt give the sampling where no vector holds the time. Cells, objects, complex and sparse arrays are
/// named and not read.
extern const Reader matlab_reader;

}  // namespace tribofit
