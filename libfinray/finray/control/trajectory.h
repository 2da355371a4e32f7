#ifndef FINRAY_CONTROL_TRAJECTORY_H_
#define FINRAY_CONTROL_TRAJECTORY_H_

#include <vector>

namespace finray {

/// A prescribed force (N) or position (mm) over time: a level and a wave about
/// it.
struct Trajectory {
  /// Each level is held for `hold_s`, the last one for ever. A step starts when
  /// the previous level ends and takes `ramp_s`, at most hold_s; 0 is a jump.
  std::vector<double> levels = {0};
  double hold_s = 1, ramp_s = 0;
  /// The wave amplitude sin(2 pi t / period). A triangular one has straight
  /// lines between the extrema of that.
  double amplitude = 0, period_s = 1;
  bool triangular = false;

  static Trajectory Wave(double mean, double amplitude, double period_s,
                         bool triangular = false) {
    return {{mean}, 1, 0, amplitude, period_s, triangular};
  }

  /// The value at a time; before 0 it is that at 0.
  double At(double time_s) const;
  /// Time since the last step began; infinite before the first one.
  double SinceStep(double time_s) const;
  /// The middle between the least and the largest value.
  double Middle() const;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_TRAJECTORY_H_
