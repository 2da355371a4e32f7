#include "finray/calib/analysis/wide_linearization.h"

#include <algorithm>
#include <string>
#include <unordered_set>

#include "finray/calib/analysis/candidate_effects.h"
#include "finray/calib/solve/frame_pass.h"

namespace finray {
namespace {

// Neighbouring rows share what drifts, so folds are made of blocks of them.
constexpr std::size_t kMostBlockRows = 10;

// The derivatives of readings, from the residuals of a frame.
Eigen::MatrixXd ReadingsBy(const std::vector<Eigen::Index>& columns,
                           std::size_t gauges, const LinearizedFrame& at) {
  Eigen::MatrixXd readings_V =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(gauges),
                            static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < at.rows.size(); ++i) {
    if (at.rows[i].family != ResidualFamily::kGauge) continue;
    const auto row = static_cast<Eigen::Index>(i);
    readings_V.row(at.rows[i].gauge) =
        at.rows[i].std_V / at.weights[row] * at.by_parameter(row, columns);
  }
  return readings_V;
}

// Cuts the logs into stretches of about as many rows. Returns the stretch of
// each frame.
std::vector<int> StretchesOf(
    const CalibrationLogs& logs,
    std::vector<WideLinearization::Stretch>* stretches) {
  using Wide = WideLinearization;
  const auto count = static_cast<int>(logs.paths.size());
  const int of_log =
      std::clamp(Wide::kMostStretches / count, 1, Wide::kMostOfLog);
  std::vector<int> rows(logs.paths.size(), 0);
  for (const CalibrationFrame& frame : logs.frames) {
    rows[frame.log] = std::max(rows[frame.log], frame.row + 1);
  }
  for (int log = 0; log < count; ++log) {
    for (int k = 0; k < of_log; ++k) {
      stretches->push_back({log, (rows[log] * k + of_log - 1) / of_log});
    }
  }
  std::vector<int> stretch_of;
  stretch_of.reserve(logs.frames.size());
  for (const CalibrationFrame& frame : logs.frames) {
    stretch_of.push_back(frame.log * of_log +
                         frame.row * of_log / rows[frame.log]);
  }
  return stretch_of;
}

// Linearises the frames of a solution with more parameters free, those of
// `plan`.
WideLinearization LinearizeWith(const Plan& plan,
                                const CalibrationProblem& problem,
                                const CalibrationSolution& solution) {
  WideLinearization wide;
  wide.problem = problem.WithPlan(plan);
  const CalibrationParameters& parameters = wide.problem->parameters();
  std::unordered_set<std::string> free;
  for (const int i : problem.parameters().free()) {
    free.insert(problem.parameters().all()[i].name);
  }
  const auto columns = static_cast<Eigen::Index>(parameters.free().size());
  for (Eigen::Index k = 0; k < columns; ++k) {
    const CalibrationParameter& p =
        parameters.FreeParameter(static_cast<std::size_t>(k));
    (free.count(p.name) > 0 ? wide.free : wide.candidates).push_back(k);
  }
  const std::vector<int>& frames = solution.at.frames;
  wide.frames.resize(WideLinearization::kFolds);
  std::vector<int> fold_of(problem.logs().frames.size(), 0);
  const std::size_t block = std::clamp<std::size_t>(
      frames.size() / (2 * WideLinearization::kFolds), 1, kMostBlockRows);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto fold = (k / block) % WideLinearization::kFolds;
    fold_of[frames[k]] = static_cast<int>(fold);
    wide.frames[fold].push_back(frames[k]);
  }
  for (const std::vector<int>& of_fold : wide.frames) {
    wide.folds.emplace_back(static_cast<int>(columns), of_fold.size());
    std::vector<int>& checked = wide.checked.emplace_back();
    const std::size_t count =
        std::min(of_fold.size(),
                 WideLinearization::kMostChecked / WideLinearization::kFolds);
    for (std::size_t k = 0; k < count; ++k) {
      const int i = of_fold[k * of_fold.size() / count];
      if (problem.frame(i).IsBench()) continue;
      checked.push_back(i);
      wide.readings_V[i];
    }
  }
  wide.stretch_of = StretchesOf(problem.logs(), &wide.stretches);
  ContactStore contacts(wide.problem.get());
  contacts.Set(solution.contacts);
  LinearizeFrames(frames, wide.problem.get(), &contacts,
                  [&](int i, const LinearizedFrame& frame) {
                    wide.folds[fold_of[i]].Add(i, wide.stretch_of[i], frame);
                    const auto kept = wide.readings_V.find(i);
                    if (kept == wide.readings_V.end()) return;
                    kept->second = ReadingsBy(
                        wide.free, problem.finger().gauges.size(), frame);
                  });
  for (Linearization& fold : wide.folds) fold.Finish();
  return wide;
}

}  // namespace

WideLinearization LinearizeWide(const CalibrationProblem& problem,
                                const CalibrationSolution& solution) {
  Plan plan = problem.plan();
  for (const CandidateEffect& effect :
       CandidatesFor(problem.finger(), plan, problem.logs())) {
    plan = Freed(plan, effect);
  }
  return LinearizeWith(plan, problem, solution);
}

WideLinearization LinearizeFolds(const CalibrationProblem& problem,
                                 const CalibrationSolution& solution) {
  Plan plan = problem.plan();
  for (const CandidateEffect& effect :
       CandidatesFor(problem.finger(), plan, problem.logs())) {
    if (!plan.ForceZeroIsKnown()) break;
    const Plan freed = Freed(plan, effect);
    if (!freed.ForceZeroIsKnown()) plan = freed;
  }
  return LinearizeWith(plan, problem, solution);
}

}  // namespace finray
