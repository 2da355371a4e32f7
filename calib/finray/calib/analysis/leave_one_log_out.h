#ifndef FINRAY_CALIB_ANALYSIS_LEAVE_ONE_LOG_OUT_H_
#define FINRAY_CALIB_ANALYSIS_LEAVE_ONE_LOG_OUT_H_

#include <vector>

#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/robust_solve.h"

namespace finray {

/// Do the logs agree? The calibration is repeated without each log (without
/// each of kMostGroups groups of them, if there are more). The data without a
/// group are part of all data, so that its estimate theta_k differs from that
/// of all, theta, by what the group adds:
///
///   var(theta_k - theta) = s_k^2 - s^2,
///   z_k = (theta_k - theta) / sqrt(s_k^2 - s^2),
///
/// however much or little the group knows: logs need not be alike. s_k and s
/// are of the same linearization, that of all data, with s enlarged where
/// residuals are correlated and s_k as much. What a group changes by less than
/// kNegligible s is no matter (and not linear): that is added to the std. The
/// z_k of a parameter depend on each other; the largest is held against
/// Bonferroni's bound.
struct LeaveOneLogOut {
  static constexpr int kMostGroups = 10;
  static constexpr double kNegligible = 0.03;
  /// A parameter whose logs agree so badly by chance in one calibration of a
  /// hundred, all parameters together.
  static constexpr double kSignificant = 0.01;

  struct Row {
    int parameter;  ///< index into CalibrationParameters::all()
    /// std is that of all data; spread = std max_k |z_k| is what it would have
    /// to be for the largest change to be one of one std. In the parameter's
    /// unit.
    double spread, std;
    double p_value;  ///< that noise alone makes a z_k so large
    double ratio() const { return spread / std; }
  };
  int groups = 0;  ///< 0: not done
  bool all_converged = true;
  /// Free parameters of the finger, not of one log, that some of the groups can
  /// be spared for: the others determine them.
  std::vector<Row> rows;

  /// The row whose logs disagree most, if they do significantly.
  const Row* Worst() const;
};

/// Repeats the solve from the solution, without the frames of each group.
/// Does nothing for fewer than two logs with fitted frames.
LeaveOneLogOut LeaveLogsOut(CalibrationProblem* problem,
                            const CalibrationSolution& solution,
                            const Identifiability& found);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_LEAVE_ONE_LOG_OUT_H_
