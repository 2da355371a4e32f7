#include "finray/view/estimate_solver.h"

#include <cmath>

namespace finray {

EstimateSolver::EstimateSolver(const Finger& finger,
                               const Discretization& discretization)
    : gauges_(finger.gauges), solver_(finger, discretization) {}

bool EstimateSolver::Solve(const std::vector<PointContact>& contacts) {
  if (solver_.Solve(contacts)) return true;
  if (++failures_ == kPatience) solver_.set_near_only(true);
  return false;
}

void EstimateSolver::FindResiduals(const Measurements& readings,
                                   const std::vector<PointContact>& contacts,
                                   const std::vector<double>& offsets_V,
                                   float* residuals) {
  const bool solved = Solve(contacts);
  for (std::size_t j = 0; j < gauges_.size(); ++j) {
    Gauge gauge = gauges_[j];
    if (!offsets_V.empty()) gauge.offset_V = offsets_V[j];
    const double read_V = readings.gauges_V[j];
    residuals[j] =
        solved && gauge.IsMeasured(read_V)
            ? static_cast<float>((read_V - gauge.Volts(solver_.gauge_angle(
                                               static_cast<int>(j)))) /
                                 readings.GaugeStd_V(j, gauge.noise_V))
            : std::nanf("");
  }
}

}  // namespace finray
