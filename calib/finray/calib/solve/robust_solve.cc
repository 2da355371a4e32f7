#include "finray/calib/solve/robust_solve.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "finray/calib/solve/modelled_readings.h"
#include "finray/calib/solve/outliers.h"
#include "finray/calib/solve/summed_solve.h"
#include "finray/calib/solve/undecided.h"

namespace finray {
namespace {

constexpr int kMostRounds = 6;
// A frame has about six measurements more than unknowns.
constexpr std::size_t kFramesPerParameter = 6;
// The limits kFirst are enough to show which frames are far out. The limits
// kStart find the solution of a start to a small part of a std, even if chi2 is
// 10^5 times what it should be. A step of Gauss and Newton that lowers chi2 / 2
// by so little leaves much less to the next one.
constexpr JointLimits kFirst = {15, 1e-4}, kStart = {80, 1e-10, 1e-3};

struct Start {
  const char* name;
  double front, back, gains;  // factors that multiply the given finger's
};
// The starts are far enough apart to reach another basin if there is one.
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

struct StartSolution {
  StartReport report;
  Eigen::VectorXd values;
  Contacts contacts;
};

const StartSolution& LeastCost(const std::vector<StartSolution>& solutions) {
  const StartSolution* best = nullptr;
  for (const StartSolution& solution : solutions) {
    const SolveReport& report = solution.report.solve;
    if (best == nullptr) best = &solution;
    const SolveReport& least = best->report.solve;
    if ((report.converged && !least.converged) ||
        (report.converged == least.converged &&
         report.final_cost < least.final_cost * (1 - 1e-6))) {
      best = &solution;
    }
  }
  return *best;
}

// Far from any solution each pass over the frames would take as long again.
void RefuseExhausted(const std::vector<StartSolution>& solutions,
                     const StartReport& best) {
  if (!std::all_of(solutions.begin(), solutions.end(),
                   [](const StartSolution& solution) {
                     return solution.report.solve.exhausted;
                   })) {
    return;
  }
  throw std::runtime_error(
      std::string("no start comes near a solution within its bound of work; "
                  "the best one, '") +
      best.name + "': " + best.solve.message +
      "; look for rows between which gauges, stage or force sensor change");
}

// Holds the schedule of SolveRobustly.
class RobustSolve {
 public:
  explicit RobustSolve(CalibrationProblem* problem)
      : problem_(*problem), contacts_(problem) {}

  CalibrationSolution Run() {
    const SolveReport first =
        SolveJointly(StartFrames(problem_), kFirst, &problem_, &contacts_);
    RejectAmong(StartFrames(problem_));
    std::vector<StartReport> starts = SolveFromStarts(first.iterations);
    DecideContacts(problem_.candidates(), &problem_, &contacts_);
    int iterations =
        std::min_element(starts.begin(), starts.end(),
                         [](const StartReport& a, const StartReport& b) {
                           return a.distance_std < b.distance_std;
                         })
            ->solve.iterations;
    if (problem_.candidates().size() > 4 * kStageFrames) {
      iterations +=
          RejectAndSolve(problem_.SpreadFrames(kStageFrames)).report.iterations;
    }
    SummedSolution solved = RejectAndSolve(problem_.candidates());
    CalibrationSolution result{{}, std::move(solved.at), {}, std::move(starts)};
    for (; result.rounds < kMostRounds; ++result.rounds) {
      const Outliers outliers = FindOutliers(result.at, &problem_, &contacts_);
      const bool other_history = KeepHistory(result.at, &problem_);
      const bool other_friction = problem_.KeepFriction();
      const auto same_frame = [](const auto& a, const auto& b) {
        return a.first == b.first;
      };
      if (std::equal(outliers.reasons.begin(), outliers.reasons.end(),
                     problem_.rejected().begin(), problem_.rejected().end(),
                     same_frame) &&
          !other_history && !other_friction) {
        result.settled = true;
        result.outliers_too_many = outliers.too_many;
        break;
      }
      Reject(outliers.reasons);
      iterations += solved.report.iterations;
      solved = SolveSummed(problem_.FittedFrames(), {}, &problem_, &contacts_);
      result.at = std::move(solved.at);
    }
    result.solve = solved.report;
    result.solve.iterations += iterations;
    for (const auto& [frame, reason] : problem_.rejected()) {
      contacts_.Forget(frame);
    }
    result.contacts = contacts_.all();
    return result;
  }

 private:
  // Rejects the outliers among these frames and solves by the other ones of
  // them.
  SummedSolution RejectAndSolve(const std::vector<int>& frames) {
    std::optional<Linearization> start = RejectAmong(frames);
    std::vector<int> rest;
    std::copy_if(frames.begin(), frames.end(), std::back_inserter(rest),
                 [&](int i) { return problem_.rejected().count(i) == 0; });
    return SolveSummed(rest, std::move(start), &problem_, &contacts_);
  }

  void Reject(std::map<int, std::string> reasons) {
    problem_.SetRejected(std::move(reasons));
    for (const auto& [frame, reason] : problem_.rejected()) {
      contacts_.Forget(frame);
    }
  }

  // Judges these frames. All other frames stay as they are, rejected or not.
  // Returns the linearization of the good frames, for a solve to start with.
  std::optional<Linearization> RejectAmong(const std::vector<int>& frames) {
    problem_.Tell(std::to_string(frames.size()) + " frames, outliers");
    std::map<int, std::string> reasons = problem_.rejected();
    for (const int frame : frames) reasons.erase(frame);
    Outliers outliers =
        FindOutliersAmong(frames, scale_, &problem_, &contacts_);
    scale_ = outliers.scale;
    reasons.merge(std::move(outliers.reasons));
    Reject(std::move(reasons));
    return std::move(outliers.rest);
  }

  // Solves from all starts and sets the problem to the solution with the least
  // cost. The first start goes on from where it is. One thread solves each
  // start, so results do not depend on the number of threads.
  std::vector<StartReport> SolveFromStarts(int iterations_so_far) {
    std::vector<StartSolution> solutions(std::size(kStarts));
    const std::vector<int> frames = StartFrames(problem_);
    const auto solve = [&](std::size_t k) {
      const std::unique_ptr<CalibrationProblem> part = problem_.Part(frames, 1);
      part->TellProgress([&, k](const std::string& step) {
        problem_.Tell(std::string("start '") + kStarts[k].name + "', " + step);
      });
      ContactStore contacts(part.get());
      if (k == 0) {
        contacts.Set(contacts_.all());
      } else {
        part->StartFrom(Changed(problem_, kStarts[k]));
      }
      StartReport report = {
          kStarts[k].name, SolveJointly(frames, kStart, part.get(), &contacts)};
      if (k == 0) report.solve.iterations += iterations_so_far;
      solutions[k] = {report, part->Values(), contacts.all()};
    };
    tbb::task_arena(problem_.threads()).execute([&] {
      tbb::parallel_for(std::size_t{0}, solutions.size(), solve);
    });
    const StartSolution& best = LeastCost(solutions);
    RefuseExhausted(solutions, best.report);
    problem_.SetValues(best.values);
    contacts_.Set(best.contacts);
    contacts_.RenewStates();
    const auto at = FitFrames(frames, &problem_, &contacts_);
    if (!at) {
      throw std::runtime_error("the model cannot be evaluated at the solution");
    }
    const Eigen::MatrixXd information =
        SumsWithPriors(*at, problem_.parameters()).information;
    std::vector<StartReport> reports;
    for (StartSolution& solution : solutions) {
      const Eigen::VectorXd off = solution.values - best.values;
      StartReport& report = solution.report;
      report.distance_std =
          std::sqrt(std::max(0.0, off.dot(information * off)));
      report.agrees = report.solve.converged &&
                      report.distance_std < StartReport::kSameSolution;
      reports.push_back(report);
    }
    return reports;
  }

  CalibrationProblem& problem_;
  ContactStore contacts_;
  double scale_ = 1;  // the last Outliers::scale
};

}  // namespace

int CalibrationSolution::agreeing() const {
  return static_cast<int>(
      std::count_if(starts.begin(), starts.end(),
                    [](const StartReport& start) { return start.agrees; }));
}

std::vector<int> StartFrames(const CalibrationProblem& problem) {
  return problem.SpreadFrames(
      std::clamp(kFramesPerParameter * problem.parameters().free().size(),
                 kLeastStartFrames, kMostStartFrames));
}

CalibrationSolution SolveRobustly(CalibrationProblem* problem) {
  if (problem->candidates().empty()) {  // there are only priors
    CalibrationSolution solution = SolveOnce(problem);
    solution.settled = true;
    return solution;
  }
  return RobustSolve(problem).Run();
}

CalibrationSolution SolveOnce(CalibrationProblem* problem) {
  ContactStore contacts(problem);
  const SolveReport joint =
      SolveJointly(StartFrames(*problem), kStart, problem, &contacts);
  SummedSolution solved =
      SolveSummed(problem->FittedFrames(), {}, problem, &contacts);
  for (int round = 0; round < kMostRounds; ++round) {
    const bool other_history = KeepHistory(solved.at, problem);
    const bool other_friction = problem->KeepFriction();
    if (!other_history && !other_friction) break;
    const int before = solved.report.iterations;
    solved = SolveSummed(problem->FittedFrames(), {}, problem, &contacts);
    solved.report.iterations += before;
  }
  solved.report.iterations += joint.iterations;
  return {solved.report, std::move(solved.at), contacts.all(), {}};
}

}  // namespace finray
