#include "finray/control/mechanism.h"

#include <cmath>
#include <stdexcept>

namespace finray {

using Eigen::Vector2d;

Mechanism::Mechanism(const FourBar& four_bar) : four_bar_(four_bar) {
  const double approach = ApproachPerDrive(0, 0);
  if (!(std::abs(approach) > 1e-6)) {
    throw std::invalid_argument(
        "the linkage does not move the finger towards the object");
  }
  if (approach < 0) sense_ = -1;
}

std::optional<Pose<double>> Mechanism::FingerPose(double drive) const {
  if (four_bar_) return four_bar_->Coupler(sense_ * drive);
  return MakePose<double>(0, Vector2d(-drive, 0));
}

double Mechanism::ApproachPerDrive(double drive, double y_mm) const {
  constexpr double kStep = 1e-4;
  const auto here = FingerPose(drive), before = FingerPose(drive - kStep),
             after = FingerPose(drive + kStep);
  if (!here || !before || !after) return 0;
  const Vector2d point = here->Inverse() * Vector2d(0, y_mm);
  return ((*before * point) - (*after * point)).x() / (2 * kStep);
}

}  // namespace finray
