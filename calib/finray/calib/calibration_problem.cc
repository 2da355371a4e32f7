#include "finray/calib/calibration_problem.h"

#include <ceres/problem.h>
#include <ceres/solver.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "finray/io/error.h"

namespace finray {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// Of a kind and log that the joint solve has at least.
constexpr std::size_t kLeastOfLog = 50;
// States of more frames would take more memory than they save time.
constexpr std::size_t kMostStates = 50000;
constexpr std::size_t kBatch = 256;  // of frames, visited in one go
// Gradients, per std, at which a solve ends: 1e-6 of a std from the minimum,
// or, of many frames, a hundredth.
constexpr double kNear = 1e-6, kNearEnough = 1e-2;
// Along what the data and priors say less of than this, in units of the priors
// or scales, nothing is moved: that would be rounding.
constexpr double kLeastInformation = 1e-8;

double WithoutLastDigits(double value) {
  // Seven digits are left, much less than a std.
  int exponent;
  const double mantissa = std::frexp(value, &exponent);
  return std::ldexp(std::nearbyint(std::ldexp(mantissa, 24)), exponent - 24);
}

}  // namespace

CalibrationProblem::CalibrationProblem(const Finger& finger, const Plan& plan,
                                       CalibrationLogs logs,
                                       const Discretization& discretization,
                                       int threads)
    : finger_(finger),
      plan_(plan),
      logs_(std::move(logs)),
      parameters_(finger, plan, logs_),
      discretization_(discretization),
      threads_(threads),
      blocks_(finger_, plan_, &parameters_),
      solver_(finger, discretization) {
  if (parameters_.free().empty()) {
    throw InputError("plan: no parameter is free, so there is nothing to do");
  }
  // Without any reference, contacts can be anywhere that suits the gauges, and
  // the solver finds nothing but that.
  const bool reference = std::any_of(
      logs_.frames.begin(), logs_.frames.end(), [&](const auto& frame) {
        return frame.contact && !frame.held_out && blocks_.HasReference(frame);
      });
  bool any = false;
  for (std::size_t i = 0; i < logs_.frames.size(); ++i) {
    const CalibrationFrame& frame = logs_.frames[i];
    if (frame.held_out || !blocks_.HasEnough(frame)) continue;
    any = true;
    if (frame.contact && !reference) {
      gauges_only_ = true;
      continue;
    }
    candidates_.push_back(static_cast<int>(i));
  }
  if (!any) throw InputError("logs: no frame has anything to fit");
  fitted_ = candidates_;
  contacts_.assign(logs_.frames.size(), {kNaN, kNaN});
  if (candidates_.size() <= kMostStates) states_.resize(logs_.frames.size());
  StartFrom(finger);
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
  GuessOffsets();
}

Eigen::VectorXd CalibrationProblem::Values() const {
  const auto& free = parameters_.free();
  Eigen::VectorXd values(static_cast<Eigen::Index>(free.size()));
  for (std::size_t k = 0; k < free.size(); ++k) {
    values[static_cast<Eigen::Index>(k)] = *parameters_.all()[free[k]].variable;
  }
  return values;
}

void CalibrationProblem::SetValues(const Eigen::VectorXd& values) {
  const auto& free = parameters_.free();
  for (std::size_t k = 0; k < free.size(); ++k) {
    *parameters_.all()[free[k]].variable = values[static_cast<Eigen::Index>(k)];
  }
  at_solution_.reset();
}

void CalibrationProblem::SetRejected(std::map<int, std::string> reasons) {
  rejected_ = std::move(reasons);
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
// that none of them is missed by a stride that agrees with the log's own.
std::vector<int> CalibrationProblem::SpreadFrames(std::size_t most) const {
  std::map<std::pair<int, int>, std::vector<int>> kinds;
  for (const int i : fitted_) {
    const CalibrationFrame& frame = logs_.frames[i];
    const int kind = frame.IsBench() ? 2 : frame.contact ? 1 : 0;
    kinds[{frame.log, kind}].push_back(i);
  }
  std::vector<int> chosen;
  for (const auto& [kind, frames] : kinds) {
    const std::size_t n = frames.size();
    const std::size_t quota =
        std::min(n, std::max(kLeastOfLog, most * n / fitted_.size()));
    for (std::size_t k = 0; k < quota; ++k) {
      chosen.push_back(frames[k * n / quota]);
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

SolveReport CalibrationProblem::Solve() {
  at_solution_.reset();
  const bool few = fitted_.size() <= kMostJoint;
  SolveReport report = SolveJointly(few ? fitted_ : SpreadFrames(kJoint));
  // Then one step or two are left for all of them.
  if (fitted_.size() > 4 * kSummed) {
    ForgetLastDigits();
    report = SolveSummed(SpreadFrames(kSummed), report, kNearEnough);
  }
  ForgetLastDigits();
  return SolveSummed(fitted_, report, few ? kNear : kNearEnough);
}

// What Ceres leaves differs in the last digits from run to run, as Schur
// complements are summed in another order. The sum over frames is the same
// whatever the number of threads: from the same start it gives the same result,
// bit by bit.
void CalibrationProblem::ForgetLastDigits() {
  Eigen::VectorXd values = Values();
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    values[k] = WithoutLastDigits(values[k]);
  }
  SetValues(values);
  for (auto& contact : contacts_) {
    for (double& value : contact) value = WithoutLastDigits(value);
  }
  for (LadderState& state : states_) state.q.resize(0);
}

std::vector<int> CalibrationProblem::SomeFrames() const {
  return SpreadFrames(kSome);
}

SolveReport CalibrationProblem::SolveSome(int most_iterations) {
  at_solution_.reset();
  return SolveJointly(SomeFrames(), most_iterations);
}

Eigen::MatrixXd CalibrationProblem::InformationOfSome() {
  FrameSums sums;
  summed_at_.resize(0);
  if (!Sum(SomeFrames(), Values(), &sums)) {
    throw std::runtime_error("the model cannot be evaluated at the solution");
  }
  return sums.information;
}

SolveReport CalibrationProblem::SolveJointly(const std::vector<int>& frames,
                                             int most_iterations) {
  GuessContacts(frames, ContactGuess::From::kObjectFirst);
  std::vector<LadderState> states;  // of these frames, if not kept
  if (states_.empty()) states.resize(frames.size());
  std::vector<JointSolve::Frame> joint;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const int i = frames[k];
    const CalibrationFrame& frame = logs_.frames[i];
    joint.push_back({&frame, frame.contact ? contacts_[i].data() : nullptr,
                     states_.empty() ? &states[k] : &states_[i]});
  }
  return JointSolve(finger_, discretization_, plan_, blocks_, &parameters_,
                    joint, threads_)
      .Solve(most_iterations);
}

SolveReport CalibrationProblem::SolveSomeWeighted(
    Eigen::MatrixXd* information) {
  at_solution_.reset();
  const std::vector<int> frames = SomeFrames();
  const Finger finger = parameters_.Apply(finger_);
  EquilibriumSolver solver(finger, discretization_);
  std::vector<std::vector<double>> unknowns;
  std::size_t size = 0;
  for (const int i : frames) {
    const CalibrationFrame& frame = logs_.frames[i];
    unknowns.emplace_back();
    if (frame.IsBench()) continue;
    std::vector<PointContact> contacts;
    if (frame.contact) {
      contacts.push_back(
          {contacts_[i][0], contacts_[i][1], plan_.scene.friction_coefficient});
    }
    if (!solver.Solve(contacts)) {
      throw std::runtime_error("the model cannot be evaluated at the solution");
    }
    const Eigen::VectorXd q = solver.state().q;
    unknowns.back().assign(q.data(), q.data() + q.size());
    if (frame.contact) {
      unknowns.back().insert(unknowns.back().end(), contacts_[i].begin(),
                             contacts_[i].end());
    }
    size += unknowns.back().size();
  }
  // In one piece: Ceres eliminates them in the order of their addresses.
  std::vector<double> all;
  all.reserve(size);
  std::vector<LadderState> states(frames.size());
  std::vector<JointSolve::Frame> joint;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    double* first = unknowns[k].empty() ? nullptr : all.data() + all.size();
    all.insert(all.end(), unknowns[k].begin(), unknowns[k].end());
    joint.push_back({&logs_.frames[frames[k]], first, &states[k]});
  }
  JointSolve solve(finger_, discretization_, plan_, blocks_, &parameters_,
                   joint, threads_, EquilibriumForm::kWeighted);
  const SolveReport report = solve.Solve(kMostIterations);
  *information = solve.Information();
  return report;
}

// Columns are changes of one std along the directions that are determined.
Eigen::MatrixXd CalibrationProblem::DeterminedUnits(
    const Eigen::MatrixXd& information) const {
  Eigen::VectorXd unit(information.rows());
  for (Eigen::Index k = 0; k < unit.size(); ++k) {
    const CalibrationParameter& p =
        parameters_.all()[parameters_.free()[static_cast<std::size_t>(k)]];
    unit[k] = p.prior_std.value_or(p.scale);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      unit.asDiagonal() * information * unit.asDiagonal());
  const auto weak =
      std::count_if(eigen.eigenvalues().begin(), eigen.eigenvalues().end(),
                    [](double value) { return value < kLeastInformation; });
  const Eigen::Index kept = unit.size() - weak;
  return unit.asDiagonal() * eigen.eigenvectors().rightCols(kept) *
         eigen.eigenvalues().tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
}

SolveReport CalibrationProblem::SolveSummed(const std::vector<int>& frames,
                                            const SolveReport& before,
                                            double gradient_tolerance) {
  GuessContacts(frames, ContactGuess::From::kAll);
  const Eigen::VectorXd start = Values();
  summed_at_.resize(0);
  FrameSums sums;
  if (!Sum(frames, start, &sums)) {
    throw std::runtime_error("the model cannot be evaluated at the start");
  }
  const Eigen::MatrixXd units = DeterminedUnits(sums.information);
  if (units.cols() == 0) return before;

  ceres::Problem problem;
  Eigen::VectorXd z = Eigen::VectorXd::Zero(units.cols());
  problem.AddResidualBlock(
      new FrameSumResidual(start, units, sums,
                           [&](const Eigen::VectorXd& x, FrameSums* at) {
                             return Sum(frames, x, at);
                           }),
      nullptr, z.data());
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.linear_solver_type = ceres::DENSE_QR;
  options.initial_trust_region_radius = 1e10;
  options.max_trust_region_radius = 1e16;
  // z counts in standard deviations.
  options.gradient_tolerance = gradient_tolerance;
  options.function_tolerance = 0;
  options.parameter_tolerance = 0;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  // The contacts are those of the last point that was tried.
  const Eigen::VectorXd end = start + units * z;
  if (end != summed_at_ && !Sum(frames, end, &sums)) {
    throw std::runtime_error("the model cannot be evaluated at the solution");
  }
  at_solution_ = std::move(summed_);
  contact_slopes_.resize(0, 0);
  SolveReport report = before;
  report.converged = summary.termination_type == ceres::CONVERGENCE;
  report.iterations += static_cast<int>(summary.iterations.size()) - 1;
  report.initial_cost = summary.initial_cost;
  report.final_cost = summary.final_cost;
  report.message = summary.message;
  return report;
}

bool CalibrationProblem::Sum(const std::vector<int>& frames,
                             const Eigen::VectorXd& at, FrameSums* sums) {
  SetValues(at);
  const auto n = static_cast<int>(at.size());
  if (summed_at_.size() > 0) MoveContacts(frames, at - summed_at_);
  summed_at_ = at;
  contact_slopes_.resize(2 * n, static_cast<Eigen::Index>(frames.size()));
  summed_.reset();
  if (frames.size() == fitted_.size()) {
    summed_ = std::make_unique<Linearization>(n, frames.size());
  }
  sums->SetZero(n);
  for (int k = 0; k < n; ++k) {
    const CalibrationParameter& p = parameters_.all()[parameters_.free()[k]];
    if (p.prior_std) sums->AddPrior(k, at[k], p.initial, *p.prior_std);
  }
  Eigen::Index column = 0;
  const bool good = InParallel(
      frames,
      [&](int i, FrameLinearizer* linearizer, LinearizedFrame* out) {
        LadderState scratch;
        return linearizer->FitContact(logs_.frames[i], &contacts_[i],
                                      StateOf(i, &scratch), out);
      },
      [&](int i, const LinearizedFrame& frame) {
        const LinearizedFrame::ContactMove move = frame.Move();
        sums->Add(frame, move);
        if (summed_) summed_->Add(i, logs_.frames[i].log, frame);
        Eigen::Map<Eigen::Matrix2Xf>(contact_slopes_.col(column++).data(), 2,
                                     n) = move.by_parameter.cast<float>();
        MoveContact(i, move.now);
      });
  if (summed_) summed_->Finish();
  return good;
}

// The contacts follow the parameters, to first order.
void CalibrationProblem::MoveContacts(const std::vector<int>& frames,
                                      const Eigen::VectorXd& change) {
  const Eigen::VectorXf move = change.cast<float>();
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Eigen::Map<const Eigen::Matrix2Xf> slopes(
        contact_slopes_.col(static_cast<Eigen::Index>(k)).data(), 2,
        move.size());
    MoveContact(frames[k], (slopes * move).cast<double>());
  }
}

void CalibrationProblem::MoveContact(int frame, const Eigen::Vector2d& move) {
  if (!logs_.frames[frame].contact) return;
  auto& [arc_mm, normal_N] = contacts_[frame];
  arc_mm = std::clamp(arc_mm + move[0], 0.0, finger_.front_length_mm);
  normal_N = std::max(0.0, normal_N + move[1]);
}

template <class Prepare, class Visit>
bool CalibrationProblem::InParallel(const std::vector<int>& frames,
                                    const Prepare& prepare,
                                    const Visit& visit) {
  tbb::task_arena arena(threads_);
  tbb::enumerable_thread_specific<FrameLinearizer> linearizers([this] {
    return FrameLinearizer(solver_, plan_, &blocks_, &parameters_);
  });
  std::vector<LinearizedFrame> batch(std::min(kBatch, frames.size()));
  std::vector<char> good(batch.size());
  for (std::size_t first = 0; first < frames.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, frames.size() - first);
    arena.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, count, 16),
          [&](const tbb::blocked_range<std::size_t>& range) {
            FrameLinearizer& linearizer = linearizers.local();
            for (std::size_t k = range.begin(); k < range.end(); ++k) {
              good[k] = prepare(frames[first + k], &linearizer, &batch[k]);
            }
          });
    });
    for (std::size_t k = 0; k < count; ++k) {
      if (!good[k]) return false;
      visit(frames[first + k], batch[k]);
    }
  }
  return true;
}

void CalibrationProblem::VisitFrames(
    const std::function<void(int frame, const LinearizedFrame&)>& visit) {
  GuessContacts(fitted_, ContactGuess::From::kObjectFirst);
  const bool good = InParallel(
      fitted_,
      [&](int i, FrameLinearizer* linearizer, LinearizedFrame* out) {
        LadderState scratch;
        return linearizer->Linearize(logs_.frames[i], contacts_[i],
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

bool CalibrationProblem::LinearizeFrame(int frame, bool robust,
                                        LinearizedFrame* out) {
  GuessContacts({frame}, ContactGuess::From::kAll);
  Plan plan = plan_;
  if (robust) {
    plan.loss = RobustLoss::kCauchy;
    plan.loss_scale = 1;
  }
  FrameLinearizer linearizer(solver_, plan, &blocks_, &parameters_);
  LadderState scratch;
  std::array<double, 2> contact = contacts_[frame];
  LadderState state = *StateOf(frame, &scratch);
  return linearizer.FitContact(logs_.frames[frame], &contact, &state, out);
}

const Linearization& CalibrationProblem::AtSolution() {
  if (!at_solution_) {
    auto at = std::make_unique<Linearization>(
        static_cast<int>(parameters_.free().size()), fitted_.size());
    VisitFrames([&](int frame, const LinearizedFrame& linearized) {
      at->Add(frame, logs_.frames[frame].log, linearized);
    });
    at->Finish();
    at_solution_ = std::move(at);
  }
  return *at_solution_;
}

ContactGuess CalibrationProblem::MakeGuess() {
  return ContactGuess(parameters_.Apply(finger_), plan_, discretization_,
                      &blocks_, &parameters_);
}

// Where the measurements put contacts that have no place yet, by the finger as
// it is now.
void CalibrationProblem::GuessContacts(const std::vector<int>& frames,
                                       ContactGuess::From from) {
  std::vector<int> wanted;
  for (const int i : frames) {
    if (logs_.frames[i].contact && std::isnan(contacts_[i][0])) {
      wanted.push_back(i);
    }
  }
  if (wanted.empty()) return;
  auto guess = std::make_unique<const ContactGuess>(MakeGuess());
  tbb::enumerable_thread_specific<ContactGuess> guesses(*guess);
  tbb::task_arena(threads_).execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, wanted.size(), 16),
        [&](const tbb::blocked_range<std::size_t>& range) {
          ContactGuess& local = guesses.local();
          for (std::size_t k = range.begin(); k < range.end(); ++k) {
            ContactGuess::Place place = local.Of(logs_.frames[wanted[k]], from);
            contacts_[wanted[k]] = {place.arc_mm, place.normal_N};
            if (!states_.empty()) states_[wanted[k]] = std::move(place.state);
          }
        });
  });
  if (states_.empty()) guess_ = std::move(guess);
}

}  // namespace finray
