#ifndef FINRAY_LADDER_RIGID_LINK_ELEMENT_H_
#define FINRAY_LADDER_RIGID_LINK_ELEMENT_H_

#include "finray/ladder/element.h"
#include "finray/ladder/lanes.h"

namespace finray {
inline namespace FINRAY_ISA {

/// One segment of the paper's rigid chain: half a link, an elastic joint of
/// stiffness k = EI / h, half a link,
///
///   M_j     = M_0 - h/2 (t_0 x N),    theta_1 = theta_0 + M_j / k,
///   M_1     = M_j - h/2 (t_1 x N),    r_1 = r_0 + h/2 (t_0 + t_1),
///
/// which is the leapfrog integrator of the beam equation (order 2). An angle
/// inside the segment includes the share of the joint's turn that lies before
/// it, so a gauge that covers part of a segment reads that part of its joint.
/// Rigid links do not stretch: the axial flexibility is ignored.
template <class V = double>
class RigidLinkElement {
 public:
  using Scalar = typename ValueTraits<V>::Scalar;

  void Solve(const BasicElementStart<V>& start, const V& stiffness,
             const V& /*axial_flexibility*/, const V& length) {
    start_ = start;
    stiffness_ = stiffness;
    length_ = length;
    half_ = length * Scalar(0.5);
    flexibility_ = length / stiffness;
    SinCos(start.theta_rad, &s0_, &c0_);
    cross0_ = c0_ * start.force_y_N - s0_ * start.force_x_N;
    joint_moment_ = start.moment_N_mm - half_ * cross0_;
    const V theta1 = start.theta_rad + flexibility_ * joint_moment_;
    SinCos(theta1, &s1_, &c1_);
    cross1_ = c1_ * start.force_y_N - s1_ * start.force_x_N;
    map_.end[0] = half_ * (c0_ + c1_);
    map_.end[1] = half_ * (s0_ + s1_);
    map_.end[2] = theta1;
    map_.end[3] = joint_moment_ - half_ * cross1_;
  }

  void SolveAndDifferentiate(const BasicElementStart<V>& start,
                             const V& stiffness, const V& axial_flexibility,
                             const V& length) {
    Solve(start, stiffness, axial_flexibility, length);
    const V nx = start_.force_x_N, ny = start_.force_y_N;
    const V one = V{} + Scalar(1);
    const V d_moment[4] = {half_ * (s0_ * ny + c0_ * nx), one, half_ * s0_,
                           -half_ * c0_};
    V d_theta[4];
    for (int p = 0; p < 4; ++p) d_theta[p] = flexibility_ * d_moment[p];
    d_theta[0] += one;
    for (int p = 0; p < 4; ++p) Column(d_theta[p], d_moment[p], p);
    map_.d_start[0][0] -= half_ * s0_;
    map_.d_start[1][0] += half_ * c0_;
    map_.d_start[3][2] += half_ * s1_;
    map_.d_start[3][3] -= half_ * c1_;
  }

  void DifferentiateByStiffness() {
    Spread(-flexibility_ * joint_moment_ / stiffness_, V{}, map_.d_stiffness);
  }

  void DifferentiateByLength() {
    Spread(TurnByLength(), cross0_ * Scalar(-0.5), map_.d_length);
    map_.d_length[0] += (c0_ + c1_) * Scalar(0.5);
    map_.d_length[1] += (s0_ + s1_) * Scalar(0.5);
    map_.d_length[3] -= cross1_ * Scalar(0.5);
  }

  const BasicElementMap<V>& map() const { return map_; }

  BasicAngleReadout<V> AngleAt(const V& offset) const {
    // A segment of no length has no joint to share.
    const V safe = length_ > V{} ? length_ : V{} + Scalar(1);
    const V share = offset / safe;
    const V turn = map_.end[2] - start_.theta_rad;
    BasicAngleReadout<V> readout;
    readout.theta_rad = start_.theta_rad + share * turn;
    for (int p = 0; p < 4; ++p) {
      readout.d_start[p] = share * map_.d_start[2][p];
    }
    readout.d_start[0] += Scalar(1) - share;
    readout.d_stiffness = -share * flexibility_ * joint_moment_ / stiffness_;
    readout.d_offset = turn / safe;
    readout.d_length = share * (TurnByLength() - readout.d_offset);
    return readout;
  }

  /// Coefficients of (x, y, theta, M) as polynomials of the offset.
  static constexpr int kDegree = 1;
  void DenseOutput(V (*coefficients)[4]) const {
    const V safe = length_ > V{} ? length_ : V{} + Scalar(1);
    const V ends[4] = {map_.end[0], map_.end[1], map_.end[2] - start_.theta_rad,
                       V{}};
    for (int i = 0; i < 4; ++i) {
      coefficients[0][i] = V{};
      coefficients[1][i] = ends[i] / safe;
    }
    coefficients[0][2] = start_.theta_rad;
    coefficients[0][3] = joint_moment_;
  }

  /// The scheme has no estimate of its error.
  V Truncation() const { return V{}; }

 private:
  V TurnByLength() const {
    return (joint_moment_ - half_ * cross0_) / stiffness_;
  }
  // The end's derivatives by a quantity that turns link 1 by d_theta and
  // changes the joint's moment by d_moment.
  void Spread(const V& d_theta, const V& d_moment, V* column) const {
    column[0] = -half_ * s1_ * d_theta;
    column[1] = half_ * c1_ * d_theta;
    column[2] = d_theta;
    column[3] =
        d_moment +
        half_ * (s1_ * start_.force_y_N + c1_ * start_.force_x_N) * d_theta;
  }
  void Column(const V& d_theta, const V& d_moment, int p) {
    V column[4];
    Spread(d_theta, d_moment, column);
    for (int i = 0; i < 4; ++i) map_.d_start[i][p] = column[i];
  }

  BasicElementStart<V> start_;
  V stiffness_, length_, half_, flexibility_;
  V c0_, s0_, c1_, s1_, cross0_, cross1_, joint_moment_;
  BasicElementMap<V> map_;
};

}  // namespace FINRAY_ISA
}  // namespace finray

#endif  // FINRAY_LADDER_RIGID_LINK_ELEMENT_H_
