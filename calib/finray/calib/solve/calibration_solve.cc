// How the parameters of a CalibrationProblem are found.

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <stdexcept>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/information_spectrum.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

// Gradients, per std, at which a solve ends: 1e-6 of a std from the minimum,
// or, of many frames, a hundredth.
constexpr double kNear = 1e-6, kNearEnough = 1e-2;

// Sums over the frames go on from there.
constexpr JointSolve::Limits kNearby = {200, 1e-8};

}  // namespace

SolveReport CalibrationProblem::Solve() {
  const SolveReport joint = few() ? SolveJointly(fitted_, JointSolve::Limits())
                                  : SolveJointly(SpreadFrames(kJoint), kNearby);
  SolveReport report = SolveOn();
  report.iterations += joint.iterations;
  return report;
}

SolveReport CalibrationProblem::SolveOn() {
  return SolveSummed(fitted_, few() ? kNear : kNearEnough);
}

SolveReport CalibrationProblem::SolveMany() {
  return SolveSummed(ManyFrames(), kNearEnough);
}

std::vector<int> CalibrationProblem::ManyFrames() const {
  return candidates_.size() > 4 * kMany ? SpreadFrames(kMany)
                                        : std::vector<int>();
}

std::vector<int> CalibrationProblem::SomeFrames() const {
  return SpreadFrames(kSome);
}

SolveReport CalibrationProblem::SolveSome(const JointSolve::Limits& limits) {
  return SolveJointly(SomeFrames(), limits);
}

SolveReport CalibrationProblem::SolveJointly(const JointSolve::Limits& limits) {
  return SolveJointly(fitted_, limits);
}

Eigen::MatrixXd CalibrationProblem::InformationOfSome() {
  FrameSums sums;
  summed_frames_.clear();
  if (!Sum(SomeFrames(), Values(), &sums)) {
    throw std::runtime_error("the model cannot be evaluated at the solution");
  }
  return sums.information;
}

SolveReport CalibrationProblem::SolveJointly(const std::vector<int>& frames,
                                             const JointSolve::Limits& limits) {
  at_solution_.reset();
  start_.reset();
  GuessContacts(frames, ContactGuess::From::kObjectFirst);
  std::vector<LadderState> states;  // of these frames, if not kept
  if (states_.empty()) states.resize(frames.size());
  std::vector<JointSolve::Frame> joint;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const int i = frames[k];
    const CalibrationFrame& frame = logs().frames[i];
    joint.push_back({&frame, frame.contact ? contacts_[i].data() : nullptr,
                     states_.empty() ? &states[k] : &states_[i]});
  }
  return JointSolve(finger_, discretization_, plan_, blocks_, &parameters_,
                    joint, threads_)
      .Solve(limits);
}

SolveReport CalibrationProblem::SolveSummed(const std::vector<int>& frames,
                                            double gradient_tolerance) {
  GuessContacts(frames, ContactGuess::From::kAll);
  const Eigen::VectorXd start = Values();
  FrameSums sums;
  if (start_ && summed_frames_ == frames) {
    sums = std::move(*start_);
  } else {
    summed_frames_.clear();
    if (!Sum(frames, start, &sums)) {
      throw std::runtime_error("the model cannot be evaluated at the start");
    }
  }
  start_.reset();
  const Eigen::MatrixXd units =
      DeterminedUnits(sums.information, parameters_.Units());
  if (units.cols() == 0) {
    return {true, 0, sums.cost, sums.cost, "nothing is determined"};
  }

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
  const ClassicNumbers in_messages;
  ceres::Solve(options, &problem, &summary);
  // The contacts are those of the last point that was tried.
  const Eigen::VectorXd end = start + units * z;
  if (end != summed_at_ && !Sum(frames, end, &sums)) {
    throw std::runtime_error("the model cannot be evaluated at the solution");
  }
  at_solution_ = std::move(summed_);
  summed_frames_ = {};
  contact_slopes_.resize(0, 0);
  SolveReport report;
  report.converged = summary.termination_type == ceres::CONVERGENCE;
  report.iterations = static_cast<int>(summary.iterations.size()) - 1;
  report.initial_cost = summary.initial_cost;
  report.final_cost = summary.final_cost;
  report.message = summary.message;
  return report;
}

void CalibrationProblem::BeginSum(std::size_t most_frames, FrameSums* sums) {
  const Eigen::VectorXd at = Values();
  const auto n = static_cast<int>(at.size());
  summed_at_ = at;
  summed_.reset();
  summed_frames_.clear();
  summed_frames_.reserve(most_frames);
  contact_slopes_.resize(2 * n, static_cast<Eigen::Index>(most_frames));
  sums->SetZero(n);
  for (int k = 0; k < n; ++k) {
    const CalibrationParameter& p = parameters_.FreeParameter(k);
    if (p.prior_std) sums->AddPrior(k, at[k], p.initial, *p.prior_std);
  }
}

void CalibrationProblem::AddToSum(int frame, const LinearizedFrame& at,
                                  FrameSums* sums) {
  sums->Add(at);
  const auto column = static_cast<Eigen::Index>(summed_frames_.size());
  Eigen::Map<Eigen::Matrix2Xf>(contact_slopes_.col(column).data(), 2,
                               summed_at_.size()) =
      at.move.by_parameter.cast<float>();
  summed_frames_.push_back(frame);
  MoveContact(frame, at.move.now);
}

bool CalibrationProblem::Sum(const std::vector<int>& frames,
                             const Eigen::VectorXd& at, FrameSums* sums) {
  SetValues(at);
  const std::vector<std::array<double, 2>> contacts = contacts_;
  if (!summed_frames_.empty()) MoveContacts(at - summed_at_);
  BeginSum(frames.size(), sums);
  if (frames.size() == fitted_.size()) {
    summed_ = std::make_unique<Linearization>(static_cast<int>(at.size()),
                                              frames.size());
  }
  const bool good = InParallel(
      frames, plan_,
      [&](int i, FrameLinearizer* linearizer, LinearizedFrame* out) {
        LadderState scratch;
        return linearizer->FitContact(logs().frames[i], &contacts_[i],
                                      StateOf(i, &scratch), out);
      },
      [&](int i, const LinearizedFrame& frame) {
        if (summed_) summed_->Add(i, logs().frames[i].log, frame);
        AddToSum(i, frame, sums);
      });
  if (!good) {
    // Some frames have been moved, by chance, others not.
    contacts_ = contacts;
    summed_frames_.clear();
    summed_.reset();
    for (LadderState& state : states_) state.q.resize(0);
    return false;
  }
  if (summed_) summed_->Finish();
  return true;
}

// The contacts follow the parameters, to first order.
void CalibrationProblem::MoveContacts(const Eigen::VectorXd& change) {
  const Eigen::VectorXf move = change.cast<float>();
  for (std::size_t k = 0; k < summed_frames_.size(); ++k) {
    const Eigen::Map<const Eigen::Matrix2Xf> slopes(
        contact_slopes_.col(static_cast<Eigen::Index>(k)).data(), 2,
        move.size());
    MoveContact(summed_frames_[k], (slopes * move).cast<double>());
  }
}

void CalibrationProblem::MoveContact(int frame, const Eigen::Vector2d& move) {
  if (!logs().frames[frame].contact) return;
  auto& [arc_mm, normal_N] = contacts_[frame];
  arc_mm = std::clamp(arc_mm + move[0], 0.0, finger_.front_length_mm);
  normal_N = std::max(0.0, normal_N + move[1]);
}

}  // namespace finray
