#include "finray/calib/problem/calibration_problem.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

// The finger with the noise that the plan gives its gauges. What is fitted with
// a noise must be sensed with it.
Finger WithPlansNoise(Finger finger, const Plan& plan) {
  for (Gauge& gauge : finger.gauges) {
    gauge.noise_V = plan.gauge_std_V.value_or(gauge.noise_V);
  }
  return finger;
}

// Returns the mean of `value(frame, gauge)` for each offset, over the readings
// of the finger without contact in the frames that `chosen(frame)` takes.
template <class Chosen, class Value>
std::unordered_map<double*, double> MeansByOffset(const CalibrationLogs& logs,
                                                  const Chosen& chosen,
                                                  const Value& value,
                                                  ReadingTerms* readings) {
  std::unordered_map<double*, double> means;
  std::unordered_map<double*, int> counts;
  for (const CalibrationFrame& frame : logs.frames) {
    if (frame.contact || frame.IsBench() || !chosen(frame)) continue;
    for (int j = 0; j < static_cast<int>(frame.gauges_V.size()); ++j) {
      if (!std::isfinite(frame.gauges_V[j])) continue;
      double* offset = readings->offset_V(j, frame.log);
      means[offset] += value(frame, j);
      ++counts[offset];
    }
  }
  for (auto& [offset, mean] : means) mean /= counts[offset];
  return means;
}

}  // namespace

CalibrationProblem::CalibrationProblem(const Finger& finger, const Plan& plan,
                                       std::shared_ptr<CalibrationLogs> logs,
                                       const Discretization& discretization,
                                       int threads)
    : finger_(WithPlansNoise(plan.CutIntoPieces(finger), plan)),
      plan_(WithTimesOf(plan, *logs)),
      without_times_(WithoutTimes(plan, *logs)),
      logs_(std::move(logs)),
      parameters_(finger_, plan_, *logs_),
      discretization_(discretization),
      threads_(std::max(1, threads)),
      blocks_(finger_, plan_, &parameters_) {
  for (const Gauge& gauge : finger.gauges) {
    given_noise_V_.push_back(gauge.noise_V);
  }
}

CalibrationProblem::CalibrationProblem(const Finger& finger, const Plan& plan,
                                       CalibrationLogs all_logs,
                                       const Discretization& discretization,
                                       int threads)
    : CalibrationProblem(finger, plan,
                         std::make_shared<CalibrationLogs>(std::move(all_logs)),
                         discretization, threads) {
  if (parameters_.free().empty()) {
    throw InputError("plan: no parameter is free, so there is nothing to do");
  }
  FindCandidates();
  StartFrom(finger_);
  KeepFriction();
}

void CalibrationProblem::FindCandidates() {
  // Without any reference, contacts go wherever they suit the gauges, and the
  // solver finds nothing else.
  const bool reference = std::any_of(
      logs().frames.begin(), logs().frames.end(), [&](const auto& frame) {
        return frame.contact && !frame.held_out && blocks_.HasReference(frame);
      });
  for (std::size_t i = 0; i < logs().frames.size(); ++i) {
    const CalibrationFrame& frame = logs().frames[i];
    if (frame.held_out || !blocks_.HasEnough(frame)) continue;
    const double force = frame.Force().magnitude_N;
    if (frame.contact && !reference) {
      gauges_only_ = true;
    } else if (force > kImpossibleForce * ForceUnit(finger_)) {
      impossible_.emplace(
          static_cast<int>(i),
          FormatText("a force of %.3g N is more than any finger like it takes",
                     force));
    } else {
      candidates_.push_back(static_cast<int>(i));
    }
  }
  if (candidates_.empty() && !gauges_only_) {
    throw InputError("logs: no frame has measurements that can be fitted");
  }
  rejected_ = impossible_;
}

std::unique_ptr<CalibrationProblem> CalibrationProblem::Part(
    const std::vector<int>& frames, int threads) const {
  std::unique_ptr<CalibrationProblem> part(
      new CalibrationProblem(finger_, plan_, logs_, discretization_, threads));
  part->candidates_ = frames;
  part->SetValues(Values());
  part->parameters_.KeepHistoryOf(parameters_, finger_, *logs_);
  part->parameters_.KeepFrictionOf(parameters_);
  part->progress_ = progress_;
  part->tolerance_std_ = tolerance_std_;
  return part;
}

std::unique_ptr<CalibrationProblem> CalibrationProblem::WithPlan(
    const Plan& plan) const {
  std::unique_ptr<CalibrationProblem> other(
      new CalibrationProblem(finger_, plan, logs_, discretization_, threads_));
  other->candidates_ = candidates_;
  other->rejected_ = rejected_;
  other->impossible_ = impossible_;
  other->progress_ = progress_;
  other->tolerance_std_ = tolerance_std_;
  std::unordered_map<std::string, double> values;
  for (const CalibrationParameter& p : parameters_.all()) {
    values.emplace(p.name, *p.variable);
  }
  for (const CalibrationParameter& p : other->parameters_.all()) {
    auto value = values.find(p.name);
    // What is one for all logs there may be one for each here.
    if (value == values.end()) {
      value = values.find(p.name.substr(0, p.name.find('[')));
    }
    if (value != values.end()) *p.variable = value->second;
  }
  other->parameters_.KeepHistoryOf(parameters_, other->finger_, *logs_);
  other->KeepFriction();
  return other;
}

std::vector<int> CalibrationProblem::FittedFrames() const {
  std::vector<int> fitted;
  for (const int i : candidates_) {
    if (rejected_.count(i) == 0) fitted.push_back(i);
  }
  return fitted;
}

// Each kind of frame has a stride of its own. One stride over all could agree
// with a period of the log and miss a kind. A rejected frame is left out. No
// other frame replaces it, because nobody has judged that one.
std::vector<int> CalibrationProblem::SpreadFrames(std::size_t most) const {
  constexpr std::size_t kLeastOfKind = 50;
  std::map<std::pair<int, int>, std::vector<int>> kinds;
  for (const int i : candidates_) {
    const int kind = frame(i).IsBench() ? 2 : frame(i).contact ? 1 : 0;
    kinds[{frame(i).log, kind}].push_back(i);
  }
  std::vector<int> chosen;
  for (const auto& [kind, frames] : kinds) {
    const std::size_t n = frames.size();
    const std::size_t quota =
        std::min(n, std::max(kLeastOfKind, most * n / candidates_.size()));
    for (std::size_t k = 0; k < quota; ++k) {
      const int frame = frames[k * n / quota];
      if (rejected_.count(frame) == 0) chosen.push_back(frame);
    }
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

void CalibrationProblem::SetRejected(std::map<int, std::string> reasons) {
  rejected_ = std::move(reasons);
  rejected_.insert(impossible_.begin(), impossible_.end());
}

Eigen::VectorXd CalibrationProblem::Values() const {
  Eigen::VectorXd values(static_cast<Eigen::Index>(parameters_.free().size()));
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    values[k] = *parameters_.FreeParameter(k).variable;
  }
  return values;
}

void CalibrationProblem::SetValues(const Eigen::VectorXd& values) {
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    *parameters_.FreeParameter(k).variable = values[k];
  }
}

void CalibrationProblem::StartFrom(const Finger& start) {
  for (const int i : parameters_.free()) {
    const CalibrationParameter& p = parameters_.all()[i];
    if (!p.of_finger) {
      *p.variable = p.initial;
    } else {
      const double value = ParameterValue(start, *p.of_finger);
      *p.variable = p.is_log ? std::log(value) : value;
    }
  }
  if (!plan_.family(ParameterFamily::kGaugeOffset).free) return;
  const auto means = MeansByOffset(
      logs(), [](const auto& frame) { return !frame.held_out; },
      [](const auto& frame, int j) { return frame.gauges_V[j]; },
      &parameters_.readings);
  for (const auto& [offset, mean] : means) *offset = mean;
}

void ZeroHeldOutLogs(CalibrationProblem* problem) {
  CalibrationParameters& parameters = problem->parameters();
  const std::vector<bool> held_out = problem->logs().HeldOut();
  const int last = parameters.last_fitted_log();
  for (int log = 0; last >= 0 && log < static_cast<int>(held_out.size());
       ++log) {
    if (!held_out[log]) continue;
    // A log without a free frame keeps these values.
    for (int j = 0; j < static_cast<int>(problem->finger().gauges.size());
         ++j) {
      *parameters.readings.offset_V(j, log) =
          *parameters.readings.offset_V(j, last);
    }
    std::copy_n(parameters.object_origin_mm(last), 2,
                parameters.object_origin_mm(log));
    *parameters.object_rotation_deg(log) =
        *parameters.object_rotation_deg(last);
  }
  if (!problem->plan().family(ParameterFamily::kGaugeOffset).per_log) return;
  // Ribs of other than nominal length bend the finger without load.
  EquilibriumSolver free(parameters.Apply(problem->finger()),
                         problem->discretization());
  if (!free.Solve({})) return;
  const auto errors = MeansByOffset(
      problem->logs(), [&](const auto& frame) { return held_out[frame.log]; },
      [&](const auto& frame, int j) {
        return frame.gauges_V[j] -
               parameters.Present(problem->finger(), j)
                   .BendingVolts(free.gauge_angle(j)) -
               parameters.readings.Sum(frame, j) -
               parameters.OfHistory(frame, j);
      },
      &parameters.readings);
  for (const auto& [offset, error] : errors) *offset += error;
}

}  // namespace finray
