#ifndef FINRAY_STATICS_RIGID_LINK_ELEMENT_H_
#define FINRAY_STATICS_RIGID_LINK_ELEMENT_H_

#include <cmath>

#include "finray/statics/element.h"

namespace finray {

/// One segment of the paper's rigid chain: half a link, an elastic joint of
/// stiffness k = EI / h, half a link,
///
///   M_j     = M_0 - h/2 (t_0 x N),    theta_1 = theta_0 + M_j / k,
///   M_1     = M_j - h/2 (t_1 x N),    r_1 = r_0 + h/2 (t_0 + t_1),
///
/// which is the leapfrog integrator of the beam equation (order 2). An angle
/// inside the segment takes the share of the joint that lies before it, so that
/// a gauge which covers part of a segment reads part of its joint.
class RigidLinkElement {
 public:
  void Compute(const ElementStart& start, double stiffness, double length) {
    start_ = start;
    stiffness_ = stiffness;
    length_ = length;
    const double nx = start.force_x_N, ny = start.force_y_N;
    const double half = 0.5 * length;
    c0_ = std::cos(start.theta_rad);
    s0_ = std::sin(start.theta_rad);
    const double cross0 = c0_ * ny - s0_ * nx;
    joint_moment_ = start.moment_N_mm - half * cross0;
    const double flexibility = length / stiffness;
    const double theta1 = start.theta_rad + flexibility * joint_moment_;
    const double c1 = std::cos(theta1), s1 = std::sin(theta1);
    const double cross1 = c1 * ny - s1 * nx;

    map_.end[0] = half * (c0_ + c1);
    map_.end[1] = half * (s0_ + s1);
    map_.end[2] = theta1;
    map_.end[3] = joint_moment_ - half * cross1;

    // by (theta, M, N_x, N_y), then by EI, then by h
    const double d_moment[6] = {half * (s0_ * ny + c0_ * nx),
                                1,
                                half * s0_,
                                -half * c0_,
                                0,
                                -0.5 * cross0};
    double d_theta[6];
    for (int p = 0; p < 6; ++p) d_theta[p] = flexibility * d_moment[p];
    d_theta[0] += 1;
    d_theta[4] -= flexibility * joint_moment_ / stiffness;
    d_theta[5] += joint_moment_ / stiffness;
    for (int p = 0; p < 6; ++p) {
      double column[4] = {
          -half * s1 * d_theta[p], half * c1 * d_theta[p], d_theta[p],
          d_moment[p] + half * (s1 * ny + c1 * nx) * d_theta[p]};
      if (p == 0) {
        column[0] -= half * s0_;
        column[1] += half * c0_;
      } else if (p == 2) {
        column[3] += half * s1;
      } else if (p == 3) {
        column[3] -= half * c1;
      } else if (p == 5) {
        column[0] += 0.5 * (c0_ + c1);
        column[1] += 0.5 * (s0_ + s1);
        column[3] -= 0.5 * cross1;
      }
      for (int i = 0; i < 4; ++i) {
        (p < 4    ? map_.d_start[i][p]
         : p == 4 ? map_.d_stiffness[i]
                  : map_.d_length[i]) = column[i];
      }
    }
  }

  const ElementMap& map() const { return map_; }

  AngleReadout AngleAt(double offset) const {
    const double share = length_ > 0 ? offset / length_ : 0;
    AngleReadout readout;
    readout.theta_rad =
        start_.theta_rad + share * (map_.end[2] - start_.theta_rad);
    for (int p = 0; p < 4; ++p) {
      readout.d_start[p] = share * map_.d_start[2][p];
    }
    readout.d_start[0] += 1 - share;
    readout.d_stiffness = share * map_.d_stiffness[2];
    readout.d_offset =
        length_ > 0 ? (map_.end[2] - start_.theta_rad) / length_ : 0;
    readout.d_length = share * (map_.d_length[2] - readout.d_offset);
    return readout;
  }

  BeamPoint PointAt(double offset) const {
    const double share = length_ > 0 ? offset / length_ : 0;
    return {share * map_.end[0], share * map_.end[1], AngleAt(offset).theta_rad,
            joint_moment_};
  }

 private:
  ElementStart start_;
  double stiffness_, length_, c0_, s0_, joint_moment_;
  ElementMap map_;
};

}  // namespace finray

#endif  // FINRAY_STATICS_RIGID_LINK_ELEMENT_H_
