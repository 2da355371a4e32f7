#include "finray/perception/finger_variations.h"

namespace finray {

std::vector<Finger> FingerVariations(const Finger& finger) {
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
