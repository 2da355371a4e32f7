#include "finray/calib/analysis/finger_covariance.h"

#include <algorithm>

namespace finray {

void KeepCovariance(const CalibrationParameters& parameters,
                    const Identifiability& found, Finger* finger) {
  ParameterCovariance covariance;
  std::vector<int> kept;  // indices into parameters.free()
  std::vector<double> std;
  for (std::size_t i = 0; i < parameters.free().size(); ++i) {
    const CalibrationParameter& p = parameters.FreeParameter(i);
    if (!p.of_finger) continue;
    kept.push_back(static_cast<int>(i));
    covariance.parameters.push_back(*p.of_finger);
    std.push_back(p.ValueStd(*p.variable, found.bounded_std[i]));
  }
  if (kept.empty()) return;
  const auto n = static_cast<Eigen::Index>(kept.size());
  covariance.std = Eigen::Map<const Eigen::VectorXd>(std.data(), n);
  covariance.correlations = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      // Rounding may give a correlation above 1.
      covariance.correlations(i, j) = covariance.correlations(j, i) =
          std::clamp(found.correlation(kept[i], kept[j]), -1.0, 1.0);
    }
  }
  finger->calibration = std::move(covariance);
}

}  // namespace finray
