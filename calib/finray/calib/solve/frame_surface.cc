#include "finray/calib/solve/frame_surface.h"

#include <algorithm>

namespace finray {

ModelSurface SurfaceOf(const CalibrationProblem& problem, double exact_std,
                       double most_rad, bool by_parameter) {
  const CalibrationParameters& parameters = problem.parameters();
  const auto gauges = static_cast<int>(problem.finger().gauges.size());
  const int poses = problem.plan().tip_std_mm ? 2 : 1;  // contact, tip
  Eigen::VectorXd resolution(gauges + 3 * poses);
  double rad = most_rad;
  for (int j = 0; j < gauges; ++j) {
    const Gauge gauge = parameters.Present(problem.finger(), j);
    resolution[j] = std::min(most_rad, exact_std / gauge.AngleWeight());
    rad = std::min(rad, resolution[j]);
  }
  for (int i = 0; i < poses; ++i) {
    resolution.segment<2>(gauges + 3 * i)
        .setConstant(rad * problem.finger().front_length_mm);
    resolution[gauges + 3 * i + 2] = rad;
  }
  ModelSurface::Content content{resolution};
  content.by_parameter = by_parameter;
  return ModelSurface(
      EquilibriumSolver(problem.finger(), problem.discretization()),
      parameters.shared, parameters.friction(), problem.plan().MovesGauges(),
      content);
}

}  // namespace finray
