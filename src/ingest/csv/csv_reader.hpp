#pragma once

#include "ingest/reader.hpp"

namespace tribofit {

/// Lines of cells: comma, semicolon or tab; decimal comma; BOM; CR LF; quotes; preamble and comment lines; units in the
/// header or in a row of their own; Latin-1 and GBK headers; trailing separators; text rows between data. Lines of the
/// preamble such as "Sampling rate: 1000 Hz" are facts. Only the columns asked for must be numbers.
/// Takes every text that no other reader recognises.
extern const Reader csv_reader;

}  // namespace tribofit
