#ifndef FINRAY_CONTROL_OBJECT_FILTER_H_
#define FINRAY_CONTROL_OBJECT_FILTER_H_

#include <Eigen/Core>

namespace finray {

/// Assumptions about an unknown object.
struct ObjectPrior {
  /// Std of the acceleration of its motion, independent in every period.
  double acceleration_mm_s2 = 10;
  /// Std of its compliance; 0 for an object that is held rigidly.
  double compliance_mm_per_N = 0.5;
  /// Std of the time between a reading and the drive's position. The drive's
  /// motion in that time adds to the std of the place.
  double timing_std_s = 0.01;
};

/// Tracks an object that only the finger senses. PushModel turns an estimated
/// force F into the object's place z along x. An object on a spring of
/// compliance c yields to the force,
///
///   z = o - c F + noise,
///
/// with o its place without the force. A Kalman filter estimates x = (o, v, c),
///
///   o += v T + a T^2 / 2,    v += a T,    a ~ N(0, acceleration^2),    c >= 0.
///
/// It is linear, because F is known apart from its noise. A constant force does
/// not separate c from o; the control does not need it then.
class ObjectFilter {
 public:
  ObjectFilter(const ObjectPrior& prior, double period_s);

  bool started() const { return started_; }
  /// Forgets everything but the compliance.
  void Restart() { started_ = false; }

  /// Advances by a period.
  void Predict();
  /// Takes a place seen under a force, with its std.
  void Update(double place_mm, double force_N, double std_mm);

  /// o after `seconds` from now.
  double PlaceIn(double seconds) const { return x_[0] + seconds * x_[1]; }
  double velocity_mm_s() const { return x_[1]; }
  double compliance_mm_per_N() const { return x_[2]; }
  const Eigen::Matrix3d& covariance() const { return covariance_; }

 private:
  ObjectPrior prior_;
  double period_s_;
  bool started_ = false;
  Eigen::Vector3d x_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

}  // namespace finray

#endif  // FINRAY_CONTROL_OBJECT_FILTER_H_
