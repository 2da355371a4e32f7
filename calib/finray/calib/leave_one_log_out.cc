#include "finray/calib/leave_one_log_out.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "finray/sensing/chi_squared.h"

namespace finray {

const LeaveOneLogOut::Row* LeaveOneLogOut::Worst() const {
  const auto worst = std::min_element(
      rows.begin(), rows.end(),
      [](const Row& a, const Row& b) { return a.p_value < b.p_value; });
  if (worst == rows.end()) return nullptr;
  const auto tests = static_cast<double>(rows.size());
  return worst->p_value * tests < kSignificant ? &*worst : nullptr;
}

namespace {

// The value that a parameter has without some logs; NaN if it is only theirs.
double ValueWithout(const CalibrationParameters& without,
                    const std::string& name) {
  for (const int i : without.free()) {
    const CalibrationParameter& p = without.all()[i];
    if (p.name == name) return *p.variable;
  }
  return std::nan("");
}

}  // namespace

LeaveOneLogOut LeaveLogsOut(CalibrationProblem& problem,
                            const Identifiability& found,
                            const Discretization& discretization, int threads) {
  LeaveOneLogOut result;
  std::set<int> used;
  for (const CalibrationFrame& frame : problem.logs().frames) {
    if (!frame.held_out) used.insert(frame.log);
  }
  if (used.size() < 2) return result;
  const std::vector<int> logs(used.begin(), used.end());
  result.groups =
      std::min(LeaveOneLogOut::kMostGroups, static_cast<int>(logs.size()));

  CalibrationParameters& all = problem.parameters();
  Eigen::MatrixXd left(all.free().size(), result.groups);
  for (int group = 0; group < result.groups; ++group) {
    CalibrationLogs rest = problem.logs();
    for (CalibrationFrame& frame : rest.frames) {
      const auto place =
          std::lower_bound(logs.begin(), logs.end(), frame.log) - logs.begin();
      if (place % result.groups == group) frame.held_out = true;
    }
    CalibrationProblem without(problem.finger(), problem.plan(), rest,
                               discretization, threads);
    result.all_converged &= without.Solve().converged;
    for (std::size_t i = 0; i < all.free().size(); ++i) {
      left(static_cast<Eigen::Index>(i), group) =
          ValueWithout(without.parameters(), all.all()[all.free()[i]].name);
    }
  }
  const double g = result.groups;
  for (std::size_t i = 0; i < all.free().size(); ++i) {
    const CalibrationParameter& p = all.all()[all.free()[i]];
    if (!p.of_finger || !std::isfinite(found.std[i])) continue;
    const auto values = left.row(static_cast<Eigen::Index>(i)).array();
    const double spread =
        std::sqrt((g - 1) / g * (values - values.mean()).square().sum());
    if (std::isnan(spread)) continue;
    const double ratio = spread / found.std[i];
    result.rows.push_back(
        {all.free()[i], p.ValueStd(*p.variable, spread),
         p.ValueStd(*p.variable, found.std[i]),
         ChiSquaredTail((g - 1) * ratio * ratio, result.groups - 1)});
  }
  return result;
}

}  // namespace finray
