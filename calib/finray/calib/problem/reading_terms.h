#ifndef FINRAY_CALIB_PROBLEM_READING_TERMS_H_
#define FINRAY_CALIB_PROBLEM_READING_TERMS_H_

#include <optional>
#include <string>
#include <vector>

#include "finray/calib/problem/calibration_log.h"
#include "finray/calib/problem/plan.h"
#include "finray/finger/finger.h"
#include "finray/residuals/frame_blocks.h"

namespace finray {

/// The terms that a reading has beside gain * angle, as far as the plan frees
/// them:
///
///   offset + drift + kappa (T - T_ref).
///
/// There is one offset for all logs or one for each. The offset is the reading
/// of an unbent gauge at t_0 and T_ref. The drift is either a rate or a walk. A
/// rate multiplies the time since t_0. t_0 is the first row of the log if each
/// log has an offset, else the earliest row of all logs. A walk is linear
/// between knots, which are equally far apart from the first row of the log to
/// its last:
///
///   sum_k z_k clamp((t - t_(k-1)) / (t_k - t_(k-1)), 0, 1).
///
/// Rows of the bench do not drift. They count as recorded at T_ref if they have
/// no temperature.
class ReadingTerms {
 public:
  /// Throws InputError if a walk has too many knots.
  ReadingTerms(const Finger& finger, const Plan& plan,
               const CalibrationLogs& logs);
  ReadingTerms(const ReadingTerms&) = delete;

  /// Returns the terms of a frame, the offset first.
  std::vector<ReadingTerm> Of(const CalibrationFrame& frame, int gauge);
  /// Returns the sum of these terms at the present values.
  double Sum(const CalibrationFrame& frame, int gauge);

  /// `log` matters only if offsets are per log.
  double* offset_V(int gauge, int log) {
    return &offsets_V_[per_log_ ? log * gauges_ + gauge : gauge];
  }
  double* drift_V_per_h(int gauge) { return &rates_V_per_h_[gauge]; }
  double* temperature_coefficient_V_per_C(int gauge) {
    return &temperature_V_per_C_[gauge];
  }
  /// The number of changes from knot to knot. A log that is held out as a whole
  /// has none.
  int walk_steps(int log) const { return spans_[log].steps; }
  double* walk_step_V(int gauge, int log, int step) {
    return &walks_V_[log][gauge * spans_[log].steps + step];
  }
  /// The std of such a change in the prior.
  double walk_step_std_V(int log) const;

 private:
  // The time that a log spans.
  struct Span {
    double first_s = 0, last_s = 0;
    int steps = 0;
  };
  double Step_s(int log) const {
    return (spans_[log].last_s - spans_[log].first_s) / spans_[log].steps;
  }

  int gauges_;
  bool per_log_, rate_, temperature_;
  std::optional<GaugeWalk> walk_;
  double reference_C_;
  double earliest_s_ = 0;
  std::vector<Span> spans_;  // by log
  std::vector<double> offsets_V_, rates_V_per_h_, temperature_V_per_C_;
  std::vector<std::vector<double>> walks_V_;  // by log, then gauge and step
};

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_READING_TERMS_H_
