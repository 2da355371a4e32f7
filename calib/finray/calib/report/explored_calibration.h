#ifndef FINRAY_CALIB_REPORT_EXPLORED_CALIBRATION_H_
#define FINRAY_CALIB_REPORT_EXPLORED_CALIBRATION_H_

#include <functional>
#include <memory>
#include <string>

#include "finray/calib/analysis/explore.h"
#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/report/calibration_result.h"

namespace finray {

/// A calibration with the effects free that the logs ask for.
struct ExploredCalibration {
  Exploration exploration;
  std::string plan_yaml;  ///< ExploredPlanYaml
  /// The result is that of the given plan, and a warning says why.
  bool as_given = false;
  std::unique_ptr<CalibrationProblem> problem;
  CalibrationResult result;
};

/// Returns the problem of a plan, with its logs.
using ProblemOfPlan =
    std::function<std::unique_ptr<CalibrationProblem>(const Plan&)>;

/// Explores and calibrates with the plan that it ends with. `text` is that of
/// the given plan, at `path`.
///  - If the calibration fails or does not converge, what was freed last is
///    fixed again, until one succeeds or nothing is free.
///  - If the verdict is not `good`, the given plan is calibrated too, and its
///    result taken if its intervals hold more often (WhyNotAdopted).
/// Each step that failed is in a warning. Throws what Calibrate throws if the
/// given plan cannot be calibrated either.
ExploredCalibration CalibrateExplored(const Plan& given,
                                      const std::string& path,
                                      const std::string& text,
                                      const ProblemOfPlan& problem_of,
                                      bool leave_logs_out);

}  // namespace finray

#endif  // FINRAY_CALIB_REPORT_EXPLORED_CALIBRATION_H_
