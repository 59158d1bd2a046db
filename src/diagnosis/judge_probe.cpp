#include "judge_probe.hpp"

#include <algorithm>

#include "tribofit/statistics/stop.hpp"

namespace tribofit::diagnosis {

Eigen::VectorXd judge_probe(const DiagnosisContext& context, const Level& level, const Trial& trial,
                            const ModelResiduals::FurtherColumns& columns, double places, Probe& probe) {
  stop_point();
  const Observations& observations = level.observations;
  const std::vector<std::size_t> all = all_slips(observations);
  ModelResiduals residuals(trial.model, observations, all);
  residuals.weaken_stick(trial.whitening.stick);
  if (trial.whitening.any()) residuals.whiten(trial.whitening);
  Linearised wide;
  wide.rows = residuals.white_rows(trial.p.data(), columns);
  if (!wide.finite()) return {};
  const auto width = static_cast<std::size_t>(wide.rows[0].cols() - 1), own = trial.p.size();
  wide.free = trial.linear.free;
  wide.free.resize(width, true);
  wide.level = trial.linear.level;
  wide.known_flicker = trial.linear.known_flicker;
  const Eigen::VectorXd step = gauss_newton_step(wide);
  const double before = sum(squares_after(trial.linear, gauss_newton_step(trial.linear)));
  const double after = sum(squares_after(wide, step));
  probe.fall = sum(held_out_squares(trial.linear, context.blocks)) - sum(held_out_squares(wide, context.blocks));
  ModelResiduals plain(trial.model, observations, all);
  plain.weaken_stick(trial.whitening.stick);
  Linearised flat;
  flat.rows = plain.white_rows(trial.p.data(), columns);
  flat.free = wide.free;
  const double left = sum(squares_after(flat, gauss_newton_step(flat))) - trial.stick.rigid;
  const double fall = trial.plain_squares - left;
  probe.size = std::max(probe.fall / context.noise_squares(), fall / context.floor_squares(trial.whitening));
  for (Eigen::MatrixXd& rows : wide.rows) rows.col(rows.cols() - 1) += rows.leftCols(rows.cols() - 1) * step;
  const double noise = (after - trial.stick.left) / level.values;
  double design = 1;
  const SlowNoise slow = slow_noise_of(wide);
  for (const DesignEffect& of_column : design_effects(wide, own, width - own, noise, slow)) {
    design = std::max({design, of_column.of_cycles, of_column.of_slow});
  }
  const double freedom = few_frequencies(static_cast<double>(wide.rows.size()));
  probe.p_value = std::min(1.0, places * fall_p_value(before - after, width - own, noise, design, freedom));
  return step.tail(static_cast<Eigen::Index>(width - own));
}

}  // namespace tribofit::diagnosis
