#include "stress.hpp"

#include "tribofit/ingest/input_error.hpp"

namespace tribofit {

bool is_stress(const FileRecord& run, Channel channel) {
  const Column* column = run.columns.find(channel);
  return column != nullptr && column->stress;
}

void refuse_stress_beside_force(const FileRecord& run) {
  const bool stress = is_stress(run, Channel::force), load = run.has(Channel::load);
  if (load && stress != is_stress(run, Channel::load)) {
    throw InputError(
        stress ? "friction is a shear stress and the load a force" : "friction is a force and the load a normal stress",
        "give both as stresses or both as forces; --units states them (force=MPa,load=MPa)", {run.path, 0, ""});
  }
  if (!stress || load) return;
  throw InputError("the shear stress needs the normal stress, which is not known",
                   "name its column with --columns load=NAME:MPa, or name the column of mu", {run.path, 0, ""});
}

}  // namespace tribofit
