#ifndef FINRAY_CONTROL_TRAJECTORY_H_
#define FINRAY_CONTROL_TRAJECTORY_H_

#include <limits>
#include <utility>
#include <variant>
#include <vector>

namespace finray {

/// A constant value.
struct ConstantTrajectory {
  double value = 0;
};

/// mean + amplitude sin(2 pi t / period)
struct HarmonicTrajectory {
  double mean, amplitude, period_s;
};

/// Straight lines: mean at t = 0, mean + amplitude after a quarter of the
/// period, mean - amplitude after three quarters.
struct TriangularTrajectory {
  double mean, amplitude, period_s;
};

/// Holds each level for `hold_s` and the last one for ever. A step starts when
/// the previous level ends and takes `ramp_s`, at most hold_s; 0 is a jump.
struct StepTrajectory {
  std::vector<double> levels;
  double hold_s;
  double ramp_s = 0;
};

/// A prescribed force (N) or position (mm) over time.
class Trajectory {
 public:
  using Shape = std::variant<ConstantTrajectory, HarmonicTrajectory,
                             TriangularTrajectory, StepTrajectory>;

  Trajectory() = default;
  Trajectory(Shape shape) : shape_(std::move(shape)) {}

  const Shape& shape() const { return shape_; }

  /// The value at a time; before 0 it is that at 0.
  double At(double time_s) const;
  /// Time since the last step began; infinite before the first one.
  double SinceStep(double time_s) const;
  /// The middle between the least and the largest value.
  double Middle() const;

 private:
  Shape shape_;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_TRAJECTORY_H_
