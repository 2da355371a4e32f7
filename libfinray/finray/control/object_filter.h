#ifndef FINRAY_CONTROL_OBJECT_FILTER_H_
#define FINRAY_CONTROL_OBJECT_FILTER_H_

#include <Eigen/Core>

namespace finray {

/// What is assumed of an unknown object.
struct ObjectPrior {
  /// Std of the acceleration of its motion, in mm/s^2, anew in every period.
  double acceleration_mm_s2 = 10;
  /// Std of its compliance, mm/N; 0: held rigidly.
  double compliance_mm_per_N = 0.5;
  /// Std of the time of a reading against the drive: what it says of the place
  /// is as uncertain as the drive's way in that time.
  double timing_std_s = 0.01;
};

/// Where an object is that nobody measures but the finger. The finger's model
/// turns an estimated force into the object's place z along x (PushModel). An
/// object on a spring of compliance c yields to the force F, so that
///
///   z = o - c F + noise,
///
/// o being where it would be without the force, v its velocity: a Kalman filter
/// for x = (o, v, c),
///
///   o += v T + a T^2 / 2,    v += a T,    a ~ N(0, acceleration^2),
///
/// linear, as F is known but for noise. c >= 0. With F constant c is not told
/// apart from o, and need not be.
class ObjectFilter {
 public:
  ObjectFilter(const ObjectPrior& prior, double period_s);

  bool started() const { return started_; }
  /// Forgets all but the compliance: the next place begins anew.
  void Restart() { started_ = false; }

  /// A period goes by.
  void Predict();
  /// A place seen under a force, with its std.
  void Update(double place_mm, double force_N, double std_mm);

  /// o in `seconds` from now.
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
