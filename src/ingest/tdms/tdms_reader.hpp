#pragma once

#include "ingest/reader.hpp"

namespace tribofit {

/// NI's TDMS: channels of numbers or times, of either order of bytes, contiguous or interleaved, in any number of
/// segments. Channels of one length and sampling share rows; wf_increment gives the sampling, unit_string the unit. The
/// properties of the file and its groups are facts. Raw values of DAQmx, which are to be scaled, are refused.
///
/// After "TDMS File Format Internal Structure" (NI).
extern const Reader tdms_reader;

}  // namespace tribofit
