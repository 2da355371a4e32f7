#ifndef FINRAY_PERCEPTION_FINGER_VARIATIONS_H_
#define FINRAY_PERCEPTION_FINGER_VARIATIONS_H_

#include <vector>

#include "finray/finger/finger.h"

namespace finray {

/// The finger moved by each principal error of its calibration: with
/// C_pp = F F' the covariance of its parameters p, one finger for each column
/// of F that is not zero. Empty if the finger has no calibration. The
/// calibration's share in the error of any result y(p) is, to first order,
///
///   cov y = sum_k (y(p + F_k) - y(p)) (y(p + F_k) - y(p))'.
///
/// All frames share these errors, so y may be computed from any number of them.
inline std::vector<Finger> FingerVariations(const Finger& finger) {
  std::vector<Finger> fingers;
  if (!finger.calibration) return fingers;
  const ParameterCovariance& calibration = *finger.calibration;
  const Eigen::MatrixXd factor = calibration.Factor();
  for (Eigen::Index k = 0; k < factor.cols(); ++k) {
    if (factor.col(k).isZero(0)) continue;
    Finger varied = finger;
    for (std::size_t i = 0; i < calibration.parameters.size(); ++i) {
      const FingerParameter& parameter = calibration.parameters[i];
      SetParameter(parameter,
                   ParameterValue(finger, parameter) +
                       factor(static_cast<Eigen::Index>(i), k),
                   &varied);
    }
    fingers.push_back(varied);
  }
  return fingers;
}

}  // namespace finray

#endif  // FINRAY_PERCEPTION_FINGER_VARIATIONS_H_
