#ifndef FINRAY_CALIB_ANALYSIS_BENCH_LINEARITY_H_
#define FINRAY_CALIB_ANALYSIS_BENCH_LINEARITY_H_

#include <string>
#include <vector>

#include "finray/calib/problem/calibration_log.h"
#include "finray/calib/problem/plan.h"
#include "finray/finger/finger.h"

namespace finray {

/// Tests a gauge's readings on the bench (angle a = w / R) for linearity:
///
///   V = offset + gain a + q a^2,
///
/// fitted by least squares with the scatter taken from the readings themselves,
/// tells whether q is there (Student's t). The scatter counts as no less than
/// the std of a reading (the plan's, else the gauge's noise): repeats that a
/// coarse converter has rounded to the same number are not that good. Where
/// radii were repeated, a line is also compared with a value of its own for
/// each radius (lack of fit, F), which sees any other shape. Where the plan has
/// offsets per log there is one for each log here too.
struct BenchLinearity {
  int gauge = 0;
  int readings = 0;
  double largest_angle_rad = 0;  ///< by magnitude
  double quadratic_V_per_rad2 = 0, quadratic_std = 0;
  double quadratic_p_value = 1;
  /// Gains of the quadratic fit at the smallest and at the largest angle.
  double first_gain_V_per_rad = 0, last_gain_V_per_rad = 0;
  /// How far that fit's curve is from the line through its ends, at most.
  double bow_V = 0;
  double lack_of_fit_F = 0;        ///< NaN where no radius was repeated
  double lack_of_fit_p_value = 1;  ///< NaN likewise

  /// Below this it is no accident.
  static constexpr double kSignificant = 0.01;
  bool IsCurved() const { return quadratic_p_value < kSignificant; }
  bool IsLinear() const {
    return !IsCurved() && !(lack_of_fit_p_value < kSignificant);
  }
  /// One clause for people, if it is not linear.
  std::string Words() const;
};

/// For every gauge with at least four bench readings at three angles that are
/// not held out.
std::vector<BenchLinearity> TestBenchLinearity(const Finger& finger,
                                               const Plan& plan,
                                               const CalibrationLogs& logs);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_BENCH_LINEARITY_H_
