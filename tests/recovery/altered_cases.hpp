#pragma once

#include <optional>
#include <string>
#include <vector>

#include "../kinematics/stick_slip_truth.hpp"
#include "more_alterations.hpp"
#include "tribofit/ingest/instruments.hpp"

namespace tribofit::altered {

/// Swings or steps of a load that nobody recorded: friction is Ft over the nominal load.
struct UnrecordedLoad {
  double swing = 0, period = 1;  ///< [1] of the load, [s]
  double step = 0;               ///< [1] of the load, from the middle of the record on
};

/// A record of known truth and what was done to it.
struct AlteredCase {
  std::string name, group;
  truth::Rig rig;
  double slower = 1;  ///< the same record of a rig so many times slower
  Alter apply;
  std::vector<std::string> may_name;  ///< effects that are what was done, or what these data cannot tell from it
  UnrecordedLoad load = {};
  Instruments instruments = {};
};

/// What came of it. wrong: a parameter is off without a word, or an effect is named that is not there.
enum class Outcome { right, named, refused, wrong };

struct Judged {
  Outcome outcome = Outcome::wrong;
  std::string text;                        ///< what was off, and what was said
  bool strict = true;                      ///< every parameter within three standard errors
  int inside = 0;                          ///< of the three parameters, within their 95 % intervals
  std::vector<std::string> possible = {};  ///< effects that are said to be possible
  double seconds = 0;
};

struct AlteredOptions {
  unsigned seed = 0;                           ///< other noise and scatter for other seeds
  std::optional<Discretisation> filters = {};  ///< of the low-pass filters, in place of those that kinematics/ undoes
};

/// More than two hundred, every kind in several strengths, on several rigs.
std::vector<AlteredCase> altered_cases(const AlteredOptions& options = {});

/// Diagnoses it. A parameter is right within three standard errors or two per cent.
Judged judge(const AlteredCase& what);

}  // namespace tribofit::altered
