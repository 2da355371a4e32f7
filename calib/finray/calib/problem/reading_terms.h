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

/// The terms of a reading beside gain * angle, with what the plan frees:
///
///   offset + drift + kappa (T - T_ref).
///
/// The offset is one for all logs, or one for each. The drift is either a rate
/// times the time since t_0, the log's first row if it has an offset of its own
/// and else the earliest row of all logs; or a walk, linear between knots that
/// are equally far apart from the log's first row to its last:
///
///   sum_k z_k clamp((t - t_(k-1)) / (t_k - t_(k-1)), 0, 1).
///
/// The offset is what an unbent gauge reads at t_0 and T_ref. Rows on the bench
/// do not drift, and count as at T_ref if no temperature was recorded there.
class ReadingTerms {
 public:
  /// Throws InputError for a walk of too many knots.
  ReadingTerms(const Finger& finger, const Plan& plan,
               const CalibrationLogs& logs);
  ReadingTerms(const ReadingTerms&) = delete;

  /// The offset first, then what else there is in this frame.
  std::vector<ReadingTerm> Of(const CalibrationFrame& frame, int gauge);
  /// Their sum at the present values.
  double Sum(const CalibrationFrame& frame, int gauge);

  /// `log` counts only where offsets are per log.
  double* offset_V(int gauge, int log) {
    return &offsets_V_[per_log_ ? log * gauges_ + gauge : gauge];
  }
  double* drift_V_per_h(int gauge) { return &rates_V_per_h_[gauge]; }
  double* temperature_coefficient_V_per_C(int gauge) {
    return &temperature_V_per_C_[gauge];
  }
  /// Changes from knot to knot; none in logs that are held out as a whole.
  int walk_steps(int log) const { return spans_[log].steps; }
  double* walk_step_V(int gauge, int log, int step) {
    return &walks_V_[log][gauge * spans_[log].steps + step];
  }
  /// The prior's std of these.
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
