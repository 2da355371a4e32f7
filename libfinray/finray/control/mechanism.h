#ifndef FINRAY_CONTROL_MECHANISM_H_
#define FINRAY_CONTROL_MECHANISM_H_

#include <Eigen/Core>
#include <optional>

#include "finray/chain/se2.h"

namespace finray {

/// The four joints at crank angle 0: the pivots of crank and rocker on the
/// ground, and their joints with the coupler.
struct FourBarJoints {
  Eigen::Vector2d crank_pivot_mm, crank_joint_mm, rocker_pivot_mm,
      rocker_joint_mm;
};

/// The position problem of a four-bar linkage. At the crank angle q the crank's
/// joint is B = A + R(q) (B_0 - A). The rocker's joint C is an intersection of
/// two circles: about B with the coupler's length, and about the rocker's pivot
/// D with the rocker's length. It is on the same side of BD as C_0 of B_0 D.
/// The coupler moves with B and C.
class FourBar {
 public:
  /// Throws std::invalid_argument for joints that coincide, and if coupler and
  /// rocker are in line at angle 0, where C has no side.
  explicit FourBar(const FourBarJoints& joints);

  /// The displacement of the coupler since angle 0; nothing where the linkage
  /// cannot close.
  std::optional<Pose<double>> Coupler(double crank_rad) const;

 private:
  FourBarJoints joints_;
  double coupler_mm_, rocker_mm_, side_;
};

/// Moves a finger with a drive. The world frame is frame S of the finger at
/// drive 0. A growing drive u moves the finger along -x, towards the object.
///
///  - Linear stage: u in mm, the finger is at (-u, 0).
///  - Gripper: u in rad is the crank angle, positive when it closes, of a
///  four-bar
///    linkage whose coupler carries the finger. The same motor drives a second
///    finger, the mirror image of the first in a mirrored world of its own.
class Mechanism {
 public:
  /// A linear stage.
  Mechanism() = default;
  /// A gripper. Throws std::invalid_argument for a linkage that does not move
  /// the finger towards the object.
  explicit Mechanism(const FourBar& four_bar);

  bool is_gripper() const { return four_bar_.has_value(); }
  int fingers() const { return is_gripper() ? 2 : 1; }

  /// Frame S in the world; nothing where the linkage cannot close.
  std::optional<Pose<double>> FingerPose(double drive) const;

  /// -dx/du of the finger's point at (0, y_mm) of the world, in mm per unit of
  /// the drive, by a central difference.
  double ApproachPerDrive(double drive, double y_mm) const;

 private:
  std::optional<FourBar> four_bar_;
  double sense_ = 1;  // of the crank when it closes
};

}  // namespace finray

#endif  // FINRAY_CONTROL_MECHANISM_H_
