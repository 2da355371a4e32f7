#ifndef FINRAY_CONTROL_MECHANISM_H_
#define FINRAY_CONTROL_MECHANISM_H_

#include <optional>

#include "finray/chain/se2.h"
#include "finray/control/four_bar.h"

namespace finray {

/// What a drive does to a finger. The world's frame is frame S of the finger
/// where the drive is at 0; a growing drive moves the finger along -x, towards
/// the object.
///
///  - a linear stage: u in mm, the finger at (-u, 0);
///  - a gripper: u in rad, the crank angle of a four-bar linkage (counted so
///    that it closes) whose coupler carries the finger. A second finger is its
///    mirror image, in its own mirrored world, driven by the same motor.
class Mechanism {
 public:
  /// A linear stage.
  Mechanism() = default;
  /// Throws std::invalid_argument for a linkage that does not move the finger
  /// towards the object.
  explicit Mechanism(const FourBar& four_bar);

  bool is_gripper() const { return four_bar_.has_value(); }
  int fingers() const { return is_gripper() ? 2 : 1; }

  /// Frame S in the world; nothing where the linkage cannot be closed.
  std::optional<Pose<double>> FingerPose(double drive) const;

  /// -dx/du of a finger's point at (0, y_mm) of the world: mm of approach by
  /// drive, by a central difference over 1e-4.
  double ApproachPerDrive(double drive, double y_mm) const;

 private:
  std::optional<FourBar> four_bar_;
  double sense_ = 1;  // of the crank, closing
};

}  // namespace finray

#endif  // FINRAY_CONTROL_MECHANISM_H_
