#ifndef FINRAY_TESTS_CALIB_CALIBRATED_H_
#define FINRAY_TESTS_CALIB_CALIBRATED_H_

#include <memory>

#include "calib/standard_log.h"
#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/robust_solve.h"

namespace finray {

/// A solved problem and its analysis, without the comparison with the force
/// sensor, which takes longer than all of this.
struct Calibrated {
  Calibrated(const Plan& plan, const std::vector<std::string>& logs,
             const Finger& start = Nominal())
      : problem(std::make_unique<CalibrationProblem>(
            start, plan, ReadCalibrationLogs(logs, start, plan),
            Discretization(), 2)),
        solution(SolveOnce(problem.get())) {
    EXPECT_TRUE(solution.solve.converged);
    found = AnalyzeIdentifiability(problem.get(), solution.at);
  }

  /// Index into free() of a name.
  int Free(const std::string& name) const {
    const CalibrationParameters& parameters = problem->parameters();
    for (std::size_t i = 0; i < parameters.free().size(); ++i) {
      if (parameters.FreeParameter(i).name == name) {
        return static_cast<int>(i);
      }
    }
    ADD_FAILURE() << name << " is not free";
    return 0;
  }
  double Variable(const std::string& name) const {
    const CalibrationParameters& parameters = problem->parameters();
    return *parameters.FreeParameter(Free(name)).variable;
  }
  double Std(const std::string& name) const { return found.std[Free(name)]; }

  std::unique_ptr<CalibrationProblem> problem;
  CalibrationSolution solution;
  Identifiability found;
};

}  // namespace finray

#endif  // FINRAY_TESTS_CALIB_CALIBRATED_H_
