#ifndef FINRAY_CALIB_ANALYSIS_LEAVE_ONE_LOG_OUT_H_
#define FINRAY_CALIB_ANALYSIS_LEAVE_ONE_LOG_OUT_H_

#include <vector>

#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/robust_solve.h"

namespace finray {

/// Says whether the logs agree. The calibration is repeated without each log,
/// or, if there are more than kMostGroups logs, without each of kMostGroups
/// groups of them. The data without a group are part of all data. So their
/// estimate theta_k differs from the estimate theta of all data by what the
/// group adds:
///
///   var(theta_k - theta) = s_k^2 - s^2,
///   z_k = (theta_k - theta) / sqrt(s_k^2 - s^2).
///
/// This holds however much or little the group knows, so logs need not be
/// alike. s_k and s come from the linearization of all data. If residuals are
/// correlated, both are enlarged alike. A change of less than kNegligible s
/// does not matter and is not linear either, so that much is added to the std.
/// The z_k of a parameter depend on each other, so the largest is compared with
/// Bonferroni's bound.
///
/// A prior that all data contradict, by kContradicted std, is left out of both
/// estimates: it pulls more the fewer data there are, and theta_k would differ
/// though the logs agree.
struct LeaveOneLogOut {
  static constexpr int kMostGroups = 10;
  static constexpr double kNegligible = 0.03;
  static constexpr double kContradicted = 3;
  /// If nothing is wrong, one calibration of a hundred has a parameter whose
  /// logs agree so badly.
  static constexpr double kSignificant = 0.01;

  struct Row {
    int parameter;  ///< index into CalibrationParameters::all()
    /// `std` is that of all data. With a std of `spread` = std max_k |z_k| the
    /// largest change would be one of one std. Both are in the unit of the
    /// parameter.
    double spread, std;
    double p_value;  ///< Of a z_k so large by noise alone.
    double ratio() const { return spread / std; }
  };
  int groups = 0;  ///< 0 if it was not done.
  bool all_converged = true;
  /// The free parameters of the finger that do not belong to one log and that
  /// the data without some group determine.
  std::vector<Row> rows;

  /// The row whose logs disagree most; null if none disagree significantly.
  const Row* Worst() const;
};

/// Repeats the solve from the solution, without the frames of each group.
/// Does nothing for fewer than two logs with fitted frames.
LeaveOneLogOut LeaveLogsOut(CalibrationProblem* problem,
                            const CalibrationSolution& solution,
                            const Identifiability& found);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_LEAVE_ONE_LOG_OUT_H_
