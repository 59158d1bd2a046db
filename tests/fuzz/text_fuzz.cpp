// Instruments, formulas, saved sessions: texts that a user writes or keeps.

#include <cmath>

#include "scratch.hpp"
#include "targets.hpp"
#include "tribofit/friction/formula.hpp"
#include "tribofit/ingest/instruments.hpp"
#include "tribofit/workbench/session.hpp"
#include "workbench/session_json.hpp"

namespace tribofit::fuzz {

void read_instruments_bytes(std::string_view bytes) {
  static const Folder scratch;
  const std::string path = scratch.write("lab.json", bytes);
  is_read([&] {
    const Instruments lab = read_instruments(path);
    require(!lab.vibrometer.gain || (std::isfinite(lab.vibrometer.gain->value) && lab.vibrometer.gain->value != 0));
  });
}

void read_formula_bytes(std::string_view bytes) {
  is_read([&] {
    const Formula formula(bytes);
    const EffectInfo info = formula.info();
    require(!info.key.empty() && formula.same_as(formula));
    for (const Parameter& parameter : info.parameters) require(std::isfinite(parameter.start));
  });
}

void read_session_bytes(std::string_view bytes) {
  is_read([&] { saved_workbench(bytes, "session.json"); });
  is_read([&] { workbench::choice_from(workbench::parsed(bytes, "session.json")); });
}

}  // namespace tribofit::fuzz
