#include "finray/calib/analysis/leave_one_log_out.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "finray/calib/solve/information_spectrum.h"
#include "finray/calib/solve/summed_solve.h"

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

// Returns the bound on the probability that any of `tests` standard normal
// numbers is beyond +-z.
double Bonferroni(double z, int tests) {
  return std::min(1.0, tests * std::erfc(z / std::sqrt(2.0)));
}

// The free parameters whose prior is contradicted by all data. If the prior is
// true, values scatter about its mean by s_p^2 - s^2.
std::vector<std::size_t> ContradictedPriors(
    const CalibrationParameters& parameters, const Identifiability& found) {
  std::vector<std::size_t> contradicted;
  for (std::size_t k = 0; k < parameters.free().size(); ++k) {
    const CalibrationParameter& p = parameters.FreeParameter(k);
    if (!p.prior_std) continue;
    const double share =
        found.covariance.diagonal()[static_cast<Eigen::Index>(k)];
    if (std::abs(p.PriorResidual()) >
        LeaveOneLogOut::kContradicted * std::sqrt(std::max(0.0, 1 - share))) {
      contradicted.push_back(k);
    }
  }
  return contradicted;
}

}  // namespace

LeaveOneLogOut LeaveLogsOut(CalibrationProblem* problem,
                            const CalibrationSolution& solution,
                            const Identifiability& found) {
  LeaveOneLogOut result;
  const auto& by_log = solution.at.information;
  if (by_log.size() < 2) return result;
  result.groups =
      std::min(LeaveOneLogOut::kMostGroups, static_cast<int>(by_log.size()));
  std::map<int, int> group_of;  // by log
  for (const auto& [log, information] : by_log) {
    group_of.emplace(log, static_cast<int>(group_of.size()) % result.groups);
  }

  CalibrationParameters& all = problem->parameters();
  // A prior that is wrong pulls more the fewer data there are. The estimate and
  // its covariance are therefore those without it, by one Gauss-Newton step.
  const std::vector<std::size_t> contradicted = ContradictedPriors(all, found);
  Eigen::MatrixXd prior = found.prior;
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(prior.rows());
  for (const std::size_t k : contradicted) {
    const auto at = static_cast<Eigen::Index>(k);
    const CalibrationParameter& p = all.FreeParameter(k);
    pull[at] = prior(at, at) * (*p.variable - p.initial) / found.unit[at];
    prior(at, at) = 0;
  }
  const Eigen::MatrixXd covariance =
      BoundedCovariance(found.information + prior);
  const Eigen::VectorXd variance = covariance.diagonal();
  const Eigen::VectorXd estimates =
      problem->Values() +
      found.unit.cwiseProduct(Eigen::VectorXd(covariance * pull));
  std::vector<int> tests(all.free().size(), 0);
  std::vector<double> largest_z(all.free().size(), 0);
  for (int group = 0; group < result.groups; ++group) {
    std::vector<int> rest;
    for (const int i : solution.at.frames) {
      if (group_of.at(problem->frame(i).log) != group) rest.push_back(i);
    }
    const auto without = problem->Part(rest, problem->threads());
    without->TellProgress([&, group](const std::string& step) {
      problem->Tell("without " + std::to_string(group + 1) + " of " +
                    std::to_string(result.groups) + " groups of logs, " + step);
    });
    for (const std::size_t k : contradicted) {
      without->parameters().DropPrior(k);
    }
    ContactStore contacts(without.get());
    contacts.Set(solution.contacts);
    const SummedSolution solved =
        SolveSummed(rest, {}, without.get(), &contacts);
    if (!solved.report.converged) {
      result.all_converged = false;
      continue;  // there is no estimate
    }
    const Identifiability known =
        AnalyzeIdentifiability(without.get(), solved.at);
    Eigen::MatrixXd information = prior;
    for (const auto& [log, its] : by_log) {
      if (group_of[log] == group) continue;
      information += InUnits(solution.at.InformationOfGroup(log), found.unit);
    }
    const Eigen::VectorXd variance_without =
        BoundedCovariance(information).diagonal();
    for (std::size_t i = 0; i < all.free().size(); ++i) {
      const CalibrationParameter& p = all.FreeParameter(i);
      if (!p.of_finger || !std::isfinite(found.std[i])) continue;
      if (known.status[i] != ParameterStatus::kEstimated) continue;
      const double estimate = *without->parameters().FreeParameter(i).variable;
      const auto at = static_cast<Eigen::Index>(i);
      const double more =
          std::max(0.0, variance_without[at] / variance[at] - 1);
      const double std = found.std[i] * std::hypot(std::sqrt(more),
                                                   LeaveOneLogOut::kNegligible);
      ++tests[i];
      largest_z[i] =
          std::max(largest_z[i], std::abs(estimate - estimates[at]) / std);
    }
  }
  for (std::size_t i = 0; i < all.free().size(); ++i) {
    if (tests[i] == 0) continue;
    const CalibrationParameter& p = all.FreeParameter(i);
    const double std = p.ValueStd(*p.variable, found.std[i]);
    result.rows.push_back({all.free()[i], largest_z[i] * std, std,
                           Bonferroni(largest_z[i], tests[i])});
  }
  return result;
}

}  // namespace finray
