#include "finray/finger/known_friction.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

// Adds or removes the last parameters. New ones are known exactly.
void Resize(Eigen::Index size, ParameterCovariance* covariance) {
  const Eigen::Index old = covariance->std.size();
  covariance->parameters.resize(static_cast<std::size_t>(size),
                                {FingerParameterKind::kFriction});
  covariance->std.conservativeResize(size);
  covariance->correlations.conservativeResize(size, size);
  for (Eigen::Index i = old; i < size; ++i) {
    covariance->std[i] = 0;
    covariance->correlations.row(i).setZero();
    covariance->correlations.col(i).setZero();
    covariance->correlations(i, i) = 1;
  }
}

}  // namespace

bool IsFrictionOf(const ParameterCovariance& calibration, double coefficient) {
  constexpr double kRounding = 1e-3;  // of a coefficient that was copied
  const double std = calibration.HasFriction()
                         ? calibration.std[calibration.std.size() - 1]
                         : 0;
  return std::abs(coefficient - calibration.friction) <=
         std::max(kRounding, std);
}

Finger ForFriction(const Finger& finger, const KnownFriction& friction) {
  Finger result = finger;
  if (!result.calibration && friction.std == 0) return result;
  if (!result.calibration) result.calibration.emplace();
  ParameterCovariance& covariance = *result.calibration;
  if (covariance.HasFriction() &&
      !IsFrictionOf(covariance, friction.coefficient)) {
    Resize(covariance.std.size() - 1, &covariance);
  }
  if (!covariance.HasFriction() && friction.std > 0) {
    Resize(covariance.std.size() + 1, &covariance);
  }
  covariance.friction = friction.coefficient;
  const Eigen::Index last = covariance.std.size() - 1;
  if (last < 0) {
    result.calibration.reset();
  } else if (friction.std > covariance.std[last] && covariance.HasFriction()) {
    const double share = covariance.std[last] / friction.std;
    covariance.correlations.row(last).head(last) *= share;
    covariance.correlations.col(last).head(last) *= share;
    covariance.std[last] = friction.std;
  }
  return result;
}

}  // namespace finray
