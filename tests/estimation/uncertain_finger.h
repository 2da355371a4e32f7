#ifndef FINRAY_TESTS_ESTIMATION_UNCERTAIN_FINGER_H_
#define FINRAY_TESTS_ESTIMATION_UNCERTAIN_FINGER_H_

#include <cmath>
#include <random>

#include "finray/finger/finger.h"
#include "test_finger.h"

namespace finray {

/// A covariance as a calibration leaves it: stiffness known to 0.8 %, gains to
/// 0.4 %, offsets to 0.1 mV, ribs to 0.035 mm, with correlations of +-0.5 or
/// so.
inline ParameterCovariance TypicalCovariance(const Finger& finger) {
  ParameterCovariance covariance;
  covariance.parameters = ParametersOf(finger);
  const auto n = static_cast<Eigen::Index>(covariance.parameters.size());
  covariance.std.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const FingerParameter& p = covariance.parameters[i];
    const double value = std::abs(ParameterValue(finger, p));
    const double std[kFingerParameterKinds] = {0.008 * value, 0.008 * value,
                                               0.004 * value, 1e-4, 0.035};
    covariance.std[i] = std[static_cast<int>(p.kind)];
  }
  std::mt19937_64 generator(8);
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd root =
      Eigen::MatrixXd::NullaryExpr(n, n + 3, [&] { return normal(generator); });
  const Eigen::MatrixXd product = root * root.transpose();
  const Eigen::VectorXd unit = product.diagonal().cwiseSqrt().cwiseInverse();
  covariance.correlations = unit.asDiagonal() * product * unit.asDiagonal();
  return covariance;
}

/// What a model may miss: errors that go together in all gauges, and more in
/// the first; under 5 N some 0.5 mrad.
inline GaugeDiscrepancy TypicalDiscrepancy(int gauges) {
  Eigen::MatrixXd near = Eigen::MatrixXd::Constant(gauges, gauges, 4e-9);
  near.diagonal().array() += 4e-9;
  Eigen::MatrixXd far = 2 * near;
  far(0, 0) *= 2;
  return {1, {{40, near}, {100, far}}};
}

/// The paper's finger with gauges of other signs and zeros, and that
/// covariance.
inline Finger UncertainFinger() {
  Finger finger = PaperFinger();
  finger.gauges[1].gain_V_per_rad = -2.1;
  finger.gauges[3].offset_V = 0.4;
  finger.ribs[2].length_mm += 0.2;
  finger.calibration = TypicalCovariance(finger);
  return finger;
}

}  // namespace finray

#endif  // FINRAY_TESTS_ESTIMATION_UNCERTAIN_FINGER_H_
