#ifndef FINRAY_CALIB_ANALYSIS_BENCH_LINEARITY_H_
#define FINRAY_CALIB_ANALYSIS_BENCH_LINEARITY_H_

#include <string>
#include <vector>

#include "finray/calib/problem/calibration_log.h"
#include "finray/calib/problem/plan.h"
#include "finray/finger/finger.h"

namespace finray {

/// Tests whether a gauge is linear, by its readings on the bench at angles a =
/// w / R. Least squares fit
///
///   V = offset + gain a + q a^2.
///
/// Student's t says whether q is there, with the scatter of the readings
/// themselves. The scatter counts as at least the std of a reading (that of the
/// plan, else the noise of the gauge), because a coarse converter may have
/// rounded repeats to the same number. If radii were repeated, the test of the
/// lack of fit (F) also compares a line with a value for each radius, and so
/// sees any other shape. If the plan has an offset for each log, this fit has
/// one too.
struct BenchLinearity {
  int gauge = 0;
  int readings = 0;
  double largest_angle_rad = 0;  ///< The largest magnitude.
  double quadratic_V_per_rad2 = 0, quadratic_std = 0;
  double quadratic_p_value = 1;
  /// The gains of the quadratic fit at the smallest and at the largest angle.
  double first_gain_V_per_rad = 0, last_gain_V_per_rad = 0;
  /// The largest distance of that fit from the line through its ends.
  double bow_V = 0;
  double lack_of_fit_F = 0;        ///< NaN if no radius was repeated.
  double lack_of_fit_p_value = 1;  ///< NaN if no radius was repeated.

  /// A p-value below this is no accident.
  static constexpr double kSignificant = 0.01;
  bool IsCurved() const { return quadratic_p_value < kSignificant; }
  bool IsLinear() const {
    return !IsCurved() && !(lack_of_fit_p_value < kSignificant);
  }
  /// One clause for people, if the gauge is not linear.
  std::string Words() const;
};

/// Tests every gauge that has at least four bench readings at three angles that
/// are not held out.
std::vector<BenchLinearity> TestBenchLinearity(const Finger& finger,
                                               const Plan& plan,
                                               const CalibrationLogs& logs);

/// Returns P(X > f) if X has Fisher's distribution with (d1, d2) degrees of
/// freedom. That is the regularized incomplete beta function I_x(d2/2, d1/2) at
/// x = d2 / (d2 + d1 f). With d1 = 1 it is the two-sided tail of Student's t,
/// with f = t^2. Returns NaN if a number of degrees is below 1 or f is NaN.
double FTail(double f, int d1, int d2);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_BENCH_LINEARITY_H_
