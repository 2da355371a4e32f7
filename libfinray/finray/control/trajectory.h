#ifndef FINRAY_CONTROL_TRAJECTORY_H_
#define FINRAY_CONTROL_TRAJECTORY_H_

#include <limits>
#include <utility>
#include <variant>
#include <vector>

namespace finray {

/// value
struct ConstantTrajectory {
  double value = 0;
};

/// mean + amplitude sin(2 pi t / period)
struct HarmonicTrajectory {
  double mean, amplitude, period_s;
};

/// The same with straight lines: mean at t = 0, mean + amplitude at a quarter
/// of the period, mean - amplitude at three quarters.
struct TriangularTrajectory {
  double mean, amplitude, period_s;
};

/// Each level for `hold_s`, the last one for ever. A step takes `ramp_s`,
/// at most hold_s, from when the level before ends; 0: it is a jump.
struct StepTrajectory {
  std::vector<double> levels;
  double hold_s;
  double ramp_s = 0;
};

/// A prescribed course of a force (N) or a position (mm) over time.
class Trajectory {
 public:
  using Shape = std::variant<ConstantTrajectory, HarmonicTrajectory,
                             TriangularTrajectory, StepTrajectory>;

  Trajectory() = default;
  Trajectory(Shape shape) : shape_(std::move(shape)) {}

  const Shape& shape() const { return shape_; }

  /// The value at a time; before 0 that at 0.
  double At(double time_s) const;
  /// Time since the last step began; infinite before the first one.
  double SinceStep(double time_s) const;
  /// The middle of the values that it takes.
  double Middle() const;

 private:
  Shape shape_;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_TRAJECTORY_H_
