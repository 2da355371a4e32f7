#ifndef FINRAY_LADDER_CONTACT_POSE_H_
#define FINRAY_LADDER_CONTACT_POSE_H_

#include <Eigen/Core>
#include <cmath>

#include "finray/ladder/ladder_frame.h"

namespace finray {

/// (x, y, theta) of contact `c` of the frame after an evaluation, on the
/// surface of its beam; x and y in l_0.
inline Eigen::Vector3d ContactPose(const LadderFrame<double>& f, int c) {
  const int slot = f.elements + c;
  Eigen::Vector3d pose(f.slot_x[slot], f.slot_y[slot], f.slot_theta[slot]);
  if (f.lifted) {
    const double lift = f.contacts[c].lift;
    pose.x() -= lift * std::sin(pose.z());
    pose.y() += lift * std::cos(pose.z());
  }
  return pose;
}

}  // namespace finray

#endif  // FINRAY_LADDER_CONTACT_POSE_H_
