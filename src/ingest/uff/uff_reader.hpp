#pragma once

#include "ingest/reader.hpp"

namespace tribofit {

/// Universal files (UFF), datasets 58 and 58b: real functions of time, as text or binary of either order of bytes,
/// evenly spaced or not. Each is a column, named by its first line or its ordinate; those of the same spacing share
/// rows. Other datasets, complex functions and functions of anything but time (spectra, orders, ...) are named and not
/// read. An abscissa that states neither that it is time nor a unit of time gives no rate: the user states it.
///
/// After "Universal Dataset Number 58: Function at Nodal DOF" (SDRC, University of Cincinnati), whose binary form 58b
/// has the same eleven lines of text and then the values.
extern const Reader uff_reader;

}  // namespace tribofit
