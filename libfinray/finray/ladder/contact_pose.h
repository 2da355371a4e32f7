#ifndef FINRAY_LADDER_CONTACT_POSE_H_
#define FINRAY_LADDER_CONTACT_POSE_H_

#include <Eigen/Core>
#include <cmath>

#include "finray/ladder/ladder_frame.h"
#include "finray/ladder/lanes.h"

namespace finray {

/// (x, y, theta) of contact `c` of the frame after an evaluation, on the
/// surface of its beam; x and y in l_0.
template <class T>
Eigen::Vector3d ContactPose(const LadderFrame<T>& f, int c, int lane) {
  const int slot = f.elements + c;
  Eigen::Vector3d pose(LaneOf(f.slot_x[slot], lane),
                       LaneOf(f.slot_y[slot], lane),
                       LaneOf(f.slot_theta[slot], lane));
  if (f.lifted) {
    const double lift = LaneOf(f.contacts[c].lift, lane);
    pose.x() -= lift * std::sin(pose.z());
    pose.y() += lift * std::cos(pose.z());
  }
  return pose;
}

}  // namespace finray

#endif  // FINRAY_LADDER_CONTACT_POSE_H_
