#include "finray/calib/problem/calibration_problem.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <stdexcept>

#include "finray/calib/analysis/force_check.h"
#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "finray/io/nan.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

// Of a kind and log that the joint solve has at least.
constexpr std::size_t kLeastOfLog = 50;
// States of more frames would take more memory than they save time.
constexpr std::size_t kMostStates = 50000;
// Contacts are fitted until a step would lower chi2 / 2 by less. Gauss-Newton
// knows the rest to a tenth: more of it makes costs too rough to converge to
// 1e-6 of a std, but not to what is near enough with many frames.
constexpr double kSmallDecrease = 1e-5, kSmallOfMany = 1e-3;
// Of their equilibria, relative: far below any std, and it spares iterations.
// Derivatives are those before the last one, which moves by 1e-4 at most.
constexpr double kToleranceOfMany = 1e-10;
// Frames that a thread works on in one go.
constexpr std::size_t kChunk = 32;

// Where a frame cannot be evaluated others still can: it has no rows then.
bool FitOrClear(const CalibrationFrame& frame, std::array<double, 2>* contact,
                LadderState* state, FrameLinearizer* linearizer,
                LinearizedFrame* out) {
  if (!linearizer->FitContact(frame, contact, state, out)) out->rows.clear();
  return true;
}

}  // namespace

CalibrationProblem::CalibrationProblem(
    const Finger& finger, const Plan& plan,
    std::shared_ptr<const CalibrationLogs> logs,
    const Discretization& discretization, int threads)
    : finger_(finger),
      plan_(plan),
      logs_(std::move(logs)),
      parameters_(finger, plan, *logs_),
      discretization_(discretization),
      threads_(std::max(1, threads)),
      blocks_(finger_, plan_, &parameters_),
      solver_(finger, discretization) {}

CalibrationProblem::CalibrationProblem(const Finger& finger, const Plan& plan,
                                       CalibrationLogs all_logs,
                                       const Discretization& discretization,
                                       int threads)
    : CalibrationProblem(
          finger, plan,
          std::make_shared<const CalibrationLogs>(std::move(all_logs)),
          discretization, threads) {
  if (parameters_.free().empty()) {
    throw InputError("plan: no parameter is free, so there is nothing to do");
  }
  // Without any reference, contacts can be anywhere that suits the gauges, and
  // the solver finds nothing but that.
  const bool reference = std::any_of(
      logs().frames.begin(), logs().frames.end(), [&](const auto& frame) {
        return frame.contact && !frame.held_out && blocks_.HasReference(frame);
      });
  bool any = false;
  for (std::size_t i = 0; i < logs().frames.size(); ++i) {
    const CalibrationFrame& frame = logs().frames[i];
    if (frame.held_out || !blocks_.HasEnough(frame)) continue;
    if (frame.contact && !reference) {
      any = gauges_only_ = true;
      continue;
    }
    const double force = ReferenceForce(frame);
    if (force > kImpossibleForce * ForceUnit(finger)) {
      impossible_.emplace(
          static_cast<int>(i),
          FormatText("a force of %.3g N is more than any finger like it takes",
                     force));
      continue;
    }
    any = true;
    candidates_.push_back(static_cast<int>(i));
  }
  if (!any) throw InputError("logs: no frame has anything to fit");
  FitAllCandidates();
  rejected_ = impossible_;
  StartFrom(finger);
}

void CalibrationProblem::FitAllCandidates() {
  fitted_ = candidates_;
  contacts_.assign(logs().frames.size(), {kNaN, kNaN});
  if (logs().frames.size() <= kMostStates) {
    states_.resize(logs().frames.size());
  }
}

std::unique_ptr<CalibrationProblem> CalibrationProblem::Part(
    const std::vector<int>& frames) const {
  std::unique_ptr<CalibrationProblem> part(
      new CalibrationProblem(finger_, plan_, logs_, discretization_, 1));
  part->candidates_ = frames;
  part->FitAllCandidates();
  part->Restore(Save());
  return part;
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
  for (auto& contact : contacts_) contact = {kNaN, kNaN};
  at_solution_.reset();
  start_.reset();
  GuessOffsets();
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
  at_solution_.reset();
  start_.reset();
}

void CalibrationProblem::SetRejected(std::map<int, std::string> reasons) {
  rejected_ = std::move(reasons);
  rejected_.insert(impossible_.begin(), impossible_.end());
  fitted_.clear();
  for (const int i : candidates_) {
    if (rejected_.count(i) == 0) fitted_.push_back(i);
  }
  for (const auto& [frame, reason] : rejected_) contacts_[frame] = {kNaN, kNaN};
  at_solution_.reset();
}

CalibrationProblem::Point CalibrationProblem::Save() const {
  return {Values(), contacts_};
}

void CalibrationProblem::Restore(const Point& point) {
  SetValues(point.values);
  contacts_ = point.contacts;
  // States are of whatever came last.
  for (LadderState& state : states_) state.q.resize(0);
}

// Evenly from every log, of contact frames, free ones and the bench apart, so
// that none of them is missed by a stride that agrees with the log's own. Those
// that are rejected are left out, not replaced by others that nobody judged.
std::vector<int> CalibrationProblem::SpreadFrames(std::size_t most) const {
  std::map<std::pair<int, int>, std::vector<int>> kinds;
  for (const int i : candidates_) {
    const CalibrationFrame& frame = logs().frames[i];
    const int kind = frame.IsBench() ? 2 : frame.contact ? 1 : 0;
    kinds[{frame.log, kind}].push_back(i);
  }
  std::vector<int> chosen;
  for (const auto& [kind, frames] : kinds) {
    const std::size_t n = frames.size();
    const std::size_t quota =
        std::min(n, std::max(kLeastOfLog, most * n / candidates_.size()));
    for (std::size_t k = 0; k < quota; ++k) {
      const int frame = frames[k * n / quota];
      if (rejected_.count(frame) == 0) chosen.push_back(frame);
    }
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

LadderState* CalibrationProblem::StateOf(int frame, LadderState* scratch) {
  if (!states_.empty()) return &states_[frame];
  const auto [arc_mm, normal_N] = contacts_[frame];
  if (std::isnan(arc_mm)) {
    scratch->q.resize(0);
  } else {
    *scratch = guess_->table().StateNear(arc_mm, normal_N);
  }
  return scratch;
}

bool CalibrationProblem::InParallel(const std::vector<int>& frames,
                                    const Plan& plan, const Prepare& prepare,
                                    const Visitor& visit) {
  struct Chunk {
    std::size_t first, count;
    std::array<LinearizedFrame, kChunk> frames;
    std::array<bool, kChunk> good;
  };
  EquilibriumSolver solver = solver_;
  if (!few()) solver.set_tolerance(kToleranceOfMany);
  const double small_decrease = few() ? kSmallDecrease : kSmallOfMany;
  tbb::enumerable_thread_specific<FrameLinearizer> linearizers([&] {
    return FrameLinearizer(solver, plan, &blocks_, &parameters_,
                           small_decrease);
  });
  // As many are under way at most, and they end in order.
  std::vector<Chunk> ring(4 * static_cast<std::size_t>(threads_));
  std::size_t begun = 0;
  std::atomic<bool> failed = false;
  const auto begin = [&](tbb::flow_control& control) -> Chunk* {
    const std::size_t first = begun * kChunk;
    if (first >= frames.size() || failed) {
      control.stop();
      return nullptr;
    }
    Chunk& chunk = ring[begun++ % ring.size()];
    chunk.first = first;
    chunk.count = std::min(kChunk, frames.size() - first);
    return &chunk;
  };
  const auto prepare_all = [&](Chunk* chunk) {
    FrameLinearizer& linearizer = linearizers.local();
    for (std::size_t k = 0; k < chunk->count && !failed; ++k) {
      chunk->good[k] =
          prepare(frames[chunk->first + k], &linearizer, &chunk->frames[k]);
    }
    return chunk;
  };
  const auto visit_all = [&](Chunk* chunk) {
    for (std::size_t k = 0; k < chunk->count && !failed; ++k) {
      if (chunk->good[k]) {
        visit(frames[chunk->first + k], chunk->frames[k]);
      } else {
        failed = true;
      }
    }
  };
  using Mode = tbb::filter_mode;
  tbb::task_arena(threads_).execute([&] {
    tbb::parallel_pipeline(
        ring.size(),
        tbb::make_filter<void, Chunk*>(Mode::serial_in_order, begin) &
            tbb::make_filter<Chunk*, Chunk*>(Mode::parallel, prepare_all) &
            tbb::make_filter<Chunk*, void>(Mode::serial_in_order, visit_all));
  });
  return !failed;
}

void CalibrationProblem::VisitFrames(const Visitor& visit) {
  GuessContacts(fitted_, ContactGuess::From::kObjectFirst);
  const bool good = InParallel(
      fitted_, plan_,
      [&](int i, FrameLinearizer* linearizer, LinearizedFrame* out) {
        LadderState scratch;
        return linearizer->Linearize(logs().frames[i], contacts_[i],
                                     StateOf(i, &scratch), out);
      },
      visit);
  if (!good) {
    throw std::runtime_error("the model cannot be evaluated at the solution");
  }
}

std::array<double, 2> CalibrationProblem::contact(int frame) const {
  if (rejected_.count(frame) > 0) return {kNaN, kNaN};
  return contacts_[frame];
}

void CalibrationProblem::FitContacts(const std::vector<int>& frames,
                                     const Judge& judge) {
  GuessContacts(frames, ContactGuess::From::kAll);
  FrameSums sums;
  BeginSum(frames.size(), &sums);
  InParallel(
      frames, plan_,
      [&](int i, FrameLinearizer* linearizer, LinearizedFrame* out) {
        LadderState scratch;
        return FitOrClear(logs().frames[i], &contacts_[i], StateOf(i, &scratch),
                          linearizer, out);
      },
      [&](int i, const LinearizedFrame& frame) {
        if (judge(i, frame)) AddToSum(i, frame, &sums);
      });
  start_ = std::move(sums);
}

void CalibrationProblem::FitContactsRobustly(const std::vector<int>& frames,
                                             const Visitor& visit) {
  // Anew: a wrong measurement may have drawn the contact to where it is.
  for (const int i : frames) contacts_[i] = {kNaN, kNaN};
  GuessContacts(frames, ContactGuess::From::kAll);
  Plan robust = plan_;
  robust.loss = RobustLoss::kCauchy;
  robust.loss_scale = 1;
  InParallel(
      frames, robust,
      [&](int i, FrameLinearizer* linearizer, LinearizedFrame* out) {
        LadderState scratch;
        std::array<double, 2> contact = contacts_[i];
        LadderState state = *StateOf(i, &scratch);
        return FitOrClear(logs().frames[i], &contact, &state, linearizer, out);
      },
      visit);
}

const Linearization& CalibrationProblem::AtSolution() {
  if (!at_solution_) {
    auto at = std::make_unique<Linearization>(
        static_cast<int>(parameters_.free().size()), fitted_.size());
    VisitFrames([&](int frame, const LinearizedFrame& linearized) {
      at->Add(frame, logs().frames[frame].log, linearized);
    });
    at->Finish();
    at_solution_ = std::move(at);
  }
  return *at_solution_;
}

ContactGuess CalibrationProblem::MakeGuess() {
  return ContactGuess(parameters_.Apply(finger_), plan_, discretization_,
                      &blocks_, &parameters_, threads_);
}

// Where the measurements put contacts that have no place yet, by the finger as
// it is now.
void CalibrationProblem::GuessContacts(const std::vector<int>& frames,
                                       ContactGuess::From from) {
  std::vector<int> wanted;
  for (const int i : frames) {
    if (logs().frames[i].contact && std::isnan(contacts_[i][0])) {
      wanted.push_back(i);
    }
  }
  if (wanted.empty()) return;
  auto guess = std::make_unique<const ContactGuess>(MakeGuess());
  tbb::enumerable_thread_specific<ContactGuess> guesses(*guess);
  tbb::task_arena(threads_).execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, wanted.size(), 16),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        ContactGuess& local = guesses.local();
                        for (std::size_t k = range.begin(); k < range.end();
                             ++k) {
                          ContactGuess::Place place =
                              local.Of(logs().frames[wanted[k]], from);
                          contacts_[wanted[k]] = {place.arc_mm, place.normal_N};
                          if (!states_.empty())
                            states_[wanted[k]] = std::move(place.state);
                        }
                      });
  });
  if (states_.empty()) guess_ = std::move(guess);
}

}  // namespace finray
