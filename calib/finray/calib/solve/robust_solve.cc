#include "finray/calib/solve/robust_solve.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "finray/calib/solve/outliers.h"

namespace finray {
namespace {

constexpr int kMostRounds = 6;
// To see which frames are far out; and to tell a start's solution to a small
// part of a std, also where chi2 is some 10^5 times what it should be.
constexpr JointSolve::Limits kFirst = {15, 1e-4}, kStart = {80, 1e-10};

struct Start {
  const char* name;
  double front, back, gains;  // factors on the given finger
};
// Far enough to reach another basin if there is one.
constexpr Start kStarts[] = {
    {"as given", 1, 1, 1},
    {"three times as stiff", 3, 3, 1},
    {"a third as stiff", 1 / 3.0, 1 / 3.0, 1},
    {"front stiffer, gains doubled", 2, 0.5, 2},
    {"back stiffer, gains halved", 0.5, 2, 0.5},
};

Finger Changed(const CalibrationProblem& problem, const Start& start) {
  Finger finger = problem.finger();
  finger.front_stiffness_N_mm2 *= start.front;
  finger.back_stiffness_N_mm2 *= start.back;
  for (Gauge& gauge : finger.gauges) gauge.gain_V_per_rad *= start.gains;
  return finger;
}

const StartReport& BestOf(const std::vector<StartReport>& starts) {
  return *std::min_element(starts.begin(), starts.end(),
                           [](const StartReport& a, const StartReport& b) {
                             return a.distance_std < b.distance_std;
                           });
}

// Each start's solution, that with the least cost being left in the problem.
// The first one goes on from where it is. Each is solved in one thread, so that
// their results do not depend on how many there are.
std::vector<StartReport> SolveFromStarts(CalibrationProblem* problem,
                                         int iterations_so_far) {
  struct Solution {
    StartReport report;
    CalibrationProblem::Point point;
  };
  std::vector<Solution> solutions(std::size(kStarts));
  const std::vector<int> frames = problem->SomeFrames();
  const auto solve = [&](std::size_t k) {
    const std::unique_ptr<CalibrationProblem> part = problem->Part(frames);
    if (k > 0) part->StartFrom(Changed(*problem, kStarts[k]));
    const SolveReport joint = part->SolveJointly(kStart);
    StartReport& report = solutions[k].report;
    report.name = kStarts[k].name;
    report.converged = joint.converged;
    report.iterations = joint.iterations + (k == 0 ? iterations_so_far : 0);
    report.cost = joint.final_cost;
    solutions[k].point = part->Save();
  };
  tbb::task_arena(problem->threads()).execute([&] {
    tbb::parallel_for(std::size_t{0}, solutions.size(), solve);
  });
  const Solution* best = nullptr;
  for (const Solution& solution : solutions) {
    const StartReport& report = solution.report;
    if (best == nullptr || (report.converged && !best->report.converged) ||
        (report.converged == best->report.converged &&
         report.cost < best->report.cost * (1 - 1e-6))) {
      best = &solution;
    }
  }
  problem->Restore(best->point);
  const Eigen::MatrixXd information = problem->InformationOfSome();
  std::vector<StartReport> reports;
  for (Solution& solution : solutions) {
    const Eigen::VectorXd off = solution.point.values - best->point.values;
    solution.report.distance_std =
        std::sqrt(std::max(0.0, off.dot(information * off)));
    solution.report.agrees =
        solution.report.converged &&
        solution.report.distance_std < StartReport::kSameSolution;
    reports.push_back(solution.report);
  }
  return reports;
}

}  // namespace

RobustSolution SolveRobustly(CalibrationProblem* problem) {
  RobustSolution result;
  if (problem->SomeFrames().empty()) {  // nothing but priors
    result.solve = problem->Solve();
    result.settled = true;
    return result;
  }
  const auto solve = [&] {
    return problem->few() ? problem->Solve() : problem->SolveOn();
  };
  // Those of other frames stay rejected.
  double scale = 1;
  const auto reject_among = [&](const std::vector<int>& frames) {
    std::map<int, std::string> reasons = problem->rejected();
    for (const int frame : frames) reasons.erase(frame);
    Outliers outliers = FindOutliersAmong(frames, scale, problem);
    scale = outliers.scale;
    reasons.merge(std::move(outliers.reasons));
    problem->SetRejected(std::move(reasons));
  };
  const SolveReport first = problem->SolveSome(kFirst);
  reject_among(problem->SomeFrames());
  result.starts = SolveFromStarts(problem, first.iterations);
  int iterations = BestOf(result.starts).iterations;
  // More and more frames, each time spared their outliers.
  if (const std::vector<int> many = problem->ManyFrames(); !many.empty()) {
    reject_among(many);
    iterations += problem->SolveMany().iterations;
  }
  reject_among(problem->candidates());
  result.solve = solve();
  for (; result.rounds < kMostRounds; ++result.rounds) {
    const Outliers outliers = FindOutliers(problem);
    const auto same_frame = [](const auto& a, const auto& b) {
      return a.first == b.first;
    };
    if (outliers.reasons.size() == problem->rejected().size() &&
        std::equal(outliers.reasons.begin(), outliers.reasons.end(),
                   problem->rejected().begin(), same_frame)) {
      result.settled = true;
      result.outliers_too_many = outliers.too_many;
      break;
    }
    problem->SetRejected(outliers.reasons);
    iterations += result.solve.iterations;
    result.solve = solve();
  }
  result.solve.iterations += iterations;
  return result;
}

}  // namespace finray
