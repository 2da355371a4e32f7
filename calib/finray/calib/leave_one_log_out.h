#ifndef FINRAY_CALIB_LEAVE_ONE_LOG_OUT_H_
#define FINRAY_CALIB_LEAVE_ONE_LOG_OUT_H_

#include <vector>

#include "finray/calib/calibration_problem.h"
#include "finray/calib/identifiability.h"

namespace finray {

/// Do the logs agree? The calibration is repeated without each log (without
/// each of kMostGroups groups of them, if there are more), and the estimates
/// theta_k are held against the std that all logs together should have:
///
///   spread^2 = (G - 1) / G sum_k (theta_k - mean)^2     (the jackknife's)
///
/// estimates the variance whatever makes logs differ; (G - 1) (spread / std)^2
/// is about chi-squared with G - 1 degrees of freedom if the std is right.
struct LeaveOneLogOut {
  static constexpr int kMostGroups = 10;
  /// A parameter whose logs agree so badly by chance in one calibration of a
  /// hundred, all parameters together.
  static constexpr double kSignificant = 0.01;

  struct Row {
    int parameter;       ///< index into CalibrationParameters::all()
    double spread, std;  ///< in the parameter's unit
    double p_value;      ///< that noise alone spreads them so far
    double ratio() const { return spread / std; }
  };
  int groups = 0;  ///< 0: not done
  bool all_converged = true;
  /// Free parameters of the finger, not of one log, whose std is finite.
  std::vector<Row> rows;

  /// The row whose logs disagree most, if they do significantly.
  const Row* Worst() const;
};

/// Nothing for fewer than two logs with fitted frames.
LeaveOneLogOut LeaveLogsOut(CalibrationProblem& problem,
                            const Identifiability& found,
                            const Discretization& discretization, int threads);

}  // namespace finray

#endif  // FINRAY_CALIB_LEAVE_ONE_LOG_OUT_H_
