#ifndef FINRAY_TESTS_CALIB_RECOVERY_H_
#define FINRAY_TESTS_CALIB_RECOVERY_H_

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/robust_solve.h"

namespace finray {

/// A calibration and what it says of each parameter by name.
class Recovery {
 public:
  Recovery(const Finger& start, const Plan& plan,
           const std::vector<std::string>& logs)
      : problem_(start, plan, ReadCalibrationLogs(logs, start, plan), {}, 2) {
    const CalibrationSolution solution = SolveOnce(&problem_);
    EXPECT_TRUE(solution.solve.converged);
    found_ = AnalyzeIdentifiability(&problem_, solution.at);
    const auto& free = problem_.parameters().free();
    for (std::size_t i = 0; i < free.size(); ++i) {
      const CalibrationParameter& p = problem_.parameters().all()[free[i]];
      by_name_[p.name] = {p.Value(*p.variable),
                          p.ValueStd(*p.variable, found_.std[i])};
    }
  }

  /// That the truth is within 4 std, and these are no larger than told.
  void Expect(const std::string& name, double truth, double largest_std) const {
    ASSERT_TRUE(by_name_.count(name)) << name;
    const auto [value, std] = by_name_.at(name);
    EXPECT_LT(std::abs(value - truth), 4 * std)
        << name << ": " << value << " against " << truth;
    EXPECT_LT(std, largest_std) << name;
    EXPECT_GT(std, 0) << name;
  }
  void ExpectFinger(const Finger& truth, double largest_rib_std = 0.05) const {
    Expect("front_stiffness_N_mm2", truth.front_stiffness_N_mm2, 200);
    Expect("back_stiffness_N_mm2", truth.back_stiffness_N_mm2, 250);
    for (int i = 0; i < 5; ++i) {
      Expect("rib_" + std::to_string(i + 1) + "_length_mm",
             truth.ribs[i].length_mm, largest_rib_std);
    }
    for (int j = 0; j < 4; ++j) {
      Expect("gauge_" + std::to_string(j + 1) + "_gain_V_per_rad",
             truth.gauges[j].gain_V_per_rad, 0.02);
    }
  }
  bool Has(const std::string& name) const { return by_name_.count(name) > 0; }
  double Value(const std::string& name) const {
    return by_name_.at(name).value;
  }
  double Std(const std::string& name) const { return by_name_.at(name).std; }
  double Chi2PerDof(ResidualFamily family) const {
    const auto& noise = found_.noise[static_cast<int>(family)];
    return noise.chi2 / noise.dof;
  }

  double Chi2() const {
    double chi2 = 0;
    for (const auto& noise : found_.noise) chi2 += noise.chi2;
    return chi2;
  }

  CalibrationProblem& problem() { return problem_; }
  const Identifiability& found() const { return found_; }

 private:
  struct Estimate {
    double value, std;
  };
  CalibrationProblem problem_;
  Identifiability found_;
  std::map<std::string, Estimate> by_name_;
};

inline FamilyPlan& Free(ParameterFamily family, Plan* plan) {
  FamilyPlan& free = plan->families[static_cast<int>(family)];
  free.free = true;
  return free;
}

}  // namespace finray

#endif  // FINRAY_TESTS_CALIB_RECOVERY_H_
