#ifndef FINRAY_CONTROL_FOUR_BAR_H_
#define FINRAY_CONTROL_FOUR_BAR_H_

#include <Eigen/Core>
#include <optional>

#include "finray/chain/se2.h"

namespace finray {

/// Four joints in the plane as they are at crank angle 0: two pivots on the
/// ground and the joints of crank and rocker with the coupler.
struct FourBarJoints {
  Eigen::Vector2d crank_pivot_mm, crank_joint_mm, rocker_pivot_mm,
      rocker_joint_mm;
};

/// A four-bar linkage, position problem. With the crank at angle q the crank's
/// joint is B = A + R(q) (B_0 - A); the rocker's joint C is where the circles
/// about B and about the rocker's pivot D with the lengths of coupler and
/// rocker meet, on the side of BD where C_0 is of B_0 D; the coupler's motion
/// takes B_0, C_0 to B, C.
class FourBar {
 public:
  /// Throws std::invalid_argument for joints that coincide, and if coupler and
  /// rocker lie in one line at the start, where the side is not told.
  explicit FourBar(const FourBarJoints& joints);

  /// The coupler's displacement from where it is at angle 0; nothing where the
  /// linkage cannot be closed.
  std::optional<Pose<double>> Coupler(double crank_rad) const;

 private:
  FourBarJoints joints_;
  double coupler_mm_, rocker_mm_, side_;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_FOUR_BAR_H_
