#include "finray/estimation/log_problem.h"

#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/finger/geometry.h"
#include "finray/io/number_text.h"
#include "finray/residuals/contact_change_residual.h"
#include "finray/residuals/gauge_offset_change_residual.h"
#include "finray/residuals/gaussian_prior_residual.h"
#include "finray/residuals/parameter_prior_residual.h"

namespace finray {
namespace {

// In std: one reading in 400 is beyond it by noise alone.
constexpr double kHuberScale = 3;
// Under a long touch offsets that wander and forces share a curved valley.
constexpr int kMostSolverIterations = 50, kMostWithWalk = 150;
// The solve ends when the cost, about one a frame, falls by less than this.
constexpr double kLeastChange = 1e-4;
// Each frame fits its noise with a contact of its own, and by how much it can
// depends a little on what the frames of a touch have in common. So the cost
// along that valley has a noise that grows with sqrt(frames), and in a touch of
// more than kLongTouch frames it says more than the readings do: iterations
// that follow it leave the solution. A solve with such a touch begins
// undamped, so that its first step is that of the linear problem, and ends when
// the cost falls by less than this times sqrt(frames of the touch).
constexpr double kLeastOfTouch = 0.1, kLongTouch = 150;
// What is known of a contact beforehand: std of l_c about its start in l_0, and
// of f_c about what is expected of it in EI / l_0^2. They keep contacts that
// the readings leave open from the far end of the beam and of the scale.
constexpr double kArcPrior = 0.25, kForcePrior = 16;
// Offsets that wander leave one error open that all frames of a touch have in
// common, and the weak prior of each frame draws it the same way. So the priors
// of a longer touch weigh as much as those of this many frames, and the
// covariance counts them as one.
constexpr double kPriorFrames = 75;
// A walk of l_c from frame to frame takes noise of the readings for motion. The
// share that it leaves, about (noise / step)^2 of each frame, falls with the
// force, so many frames draw their common force up. A step of this times
// sqrt(frames of the touch) noises keeps the sum small. Only where the readings
// leave l_c open by more than kOpen_mm the walk is what says where it is.
constexpr double kStepOverNoise = 0.25, kOpen_mm = 3;

}  // namespace

void LogFrame::CopyTo(const Eigen::MatrixXd& covariance,
                      FrameEstimate* estimate) const {
  const Eigen::Index at = covariance.rows() - 2;
  estimate->contacts = 1;
  estimate->contact[0] = {arc_mm, std::sqrt(covariance(at, at)), normal_N,
                          std::sqrt(covariance(at + 1, at + 1)), pose};
  estimate->tip_pose = tip_pose;
  estimate->rib_tension_N = rib_tension_N;
}

Eigen::Vector2d LogMarginal::StdGivenOffsets() const {
  const Eigen::Index offsets = covariance.rows() - 2;
  const auto both = covariance.topRightCorner(offsets, 2);
  const Eigen::Matrix2d given =
      covariance.bottomRightCorner<2, 2>() -
      both.transpose() *
          covariance.topLeftCorner(offsets, offsets).ldlt().solve(both);
  return given.diagonal().cwiseMax(0).cwiseSqrt();
}

Eigen::VectorXd GaugeOffsets(const Finger& finger) {
  Eigen::VectorXd offsets_V(finger.gauges.size());
  for (Eigen::Index j = 0; j < offsets_V.size(); ++j) {
    offsets_V[j] = finger.gauges[j].offset_V;
  }
  return offsets_V;
}

LogProblem::LogProblem(const Finger& finger, const Scene& scene,
                       const Discretization& discretization, int threads,
                       std::vector<LogFrame>* frames, const LogPrior& prior)
    : finger_(finger),
      scene_(scene),
      frames_(frames),
      gauges_(finger.gauges.size()),
      stride_(gauges_ + 2),
      values_(frames->size() * stride_),
      model_(MeasurementModel::OfScene(finger, scene)),
      parameters_(ForFriction(finger, scene.friction()),
                  scene.circle_radius_mm()),
      evaluations_(finger, discretization, EquilibriumForm::kReduced,
                   parameters_.shared(), threads),
      free_(&evaluations_.Add(0, scene.friction_coefficient, nullptr,
                              scene.pin_std_mm.has_value())),
      evaluation_of_(frames->size(), free_),
      loss_(std::make_unique<ceres::HuberLoss>(kHuberScale)),
      readings_(frames->size()),
      links_(frames->size()),
      contact_priors_(frames->size()) {
  ceres::Problem::Options options;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.evaluation_callback = &evaluations_;
  problem_ = std::make_unique<ceres::Problem>(options);
  for (std::size_t t = 0; t < frames->size(); ++t) {
    const LogFrame& frame = (*frames)[t];
    std::copy_n(frame.offset_V.data(), gauges_, offsets(t));
    for (std::size_t j = 0; j < gauges_; ++j) {
      problem_->AddParameterBlock(offsets(t) + j, 1);
    }
    if (!Touches(t)) continue;
    contact(t)[0] = frame.arc_mm;
    contact(t)[1] = frame.normal_N;
    problem_->AddParameterBlock(contact(t), 2);
    evaluation_of_[t] =
        &evaluations_.Add(1, scene.friction_coefficient, contact(t),
                          scene.pin_std_mm.has_value());
    if (frame.state.q.size() > 0) evaluation_of_[t]->set_state(frame.state);
  }
  CountTouches();
  for (std::size_t t = 0; t < frames->size(); ++t) {
    AddReadings(t);
    AddContactPrior(t);
  }
  AddLinks();
  AddPrior(prior);
  FixWhatIsNotFree();
}

bool LogProblem::Linked(std::size_t t) const {
  return (scene_.smoothing || scene_.gauge_offset_walk) && t > 0 &&
         Touches(t) && Touches(t - 1);
}

void LogProblem::AddReadings(std::size_t t) {
  const LogFrame& frame = (*frames_)[t];
  if (frame.role == LogFrame::Role::kUnused) return;
  FrameParameters parameters = parameters_.frame();
  for (std::size_t j = 0; j < gauges_; ++j) {
    parameters.readings[j] = {{offsets(t) + j, 1}};
  }
  MeasurementModel model = model_;
  for (double& std : model.gauge_std_V) std *= frame.noise_scale;
  for (auto* std :
       {&model.object_std_mm, &model.pin_std_mm, &model.tip_std_mm}) {
    if (*std) **std *= frame.noise_scale;
  }
  for (FrameBlock& block :
       MeasurementBlocks(frame.row, model, parameters, finger_.gauges,
                         evaluation_of_[t], contact(t))) {
    readings_[t].push_back(problem_->AddResidualBlock(
        block.cost.release(), loss_.get(), block.parameters));
  }
}

void LogProblem::AddContactPrior(std::size_t t) {
  if (!Touches(t)) return;
  const LogFrame& frame = (*frames_)[t];
  const Eigen::Vector2d mean(frame.arc_mm, frame.expected_N);
  const Eigen::Vector2d std(kArcPrior * finger_.front_length_mm,
                            kForcePrior * ForceUnit(finger_));
  const double wider =
      std::sqrt(std::max(1.0, touch_frames_[t] / kPriorFrames));
  contact_priors_[t].push_back(problem_->AddResidualBlock(
      ParameterPriorResidual::Create(mean, wider * std), nullptr, contact(t)));
}

void LogProblem::CountTouches() {
  touch_frames_.assign(frames_->size(), 1);
  if (!scene_.gauge_offset_walk) return;
  std::vector<std::size_t> touch;
  for (std::size_t t = 0; t < frames_->size(); ++t) {
    if (Touches(t)) touch.push_back(t);
    const bool lasts = t + 1 < frames_->size() &&
                       (*frames_)[t + 1].role != LogFrame::Role::kFree;
    if (lasts) continue;
    for (const std::size_t of : touch) {
      touch_frames_[of] = static_cast<double>(touch.size());
    }
    touch.clear();
  }
}

void LogProblem::AddLinks() {
  const bool finds_steps = scene_.gauge_offset_walk && !scene_.smoothing;
  const std::vector<double> least_mm =
      finds_steps ? LeastSteps_mm() : std::vector<double>(frames_->size(), 0);
  for (std::size_t t = 1; t < frames_->size(); ++t) {
    AddLink(t, std::max(least_mm[t - 1], least_mm[t]));
  }
}

// By the readings alone, at the start.
std::vector<double> LogProblem::LeastSteps_mm() {
  Linearize();
  BlockTridiagonal own = Information();
  std::vector<double> least_mm(frames_->size(), 0);
  if (jacobian_.num_rows == 0) return least_mm;
  for (std::size_t t = 0; t < least_mm.size(); ++t) {
    if (!Touches(t)) continue;
    own.Add(jacobian_, residuals_, links_end_[t], readings_end_[t]);
    const Eigen::Matrix2d contact = own.diagonal(t).bottomRightCorner<2, 2>();
    const double noise_mm = std::sqrt(InverseInformation(contact)(0, 0));
    if (noise_mm < kOpen_mm) {
      least_mm[t] = kStepOverNoise * std::sqrt(touch_frames_[t]) * noise_mm;
    }
  }
  return least_mm;
}

void LogProblem::AddLink(std::size_t t, double least_step_mm) {
  const double dt = (*frames_)[t].row.time_s - (*frames_)[t - 1].row.time_s;
  if (scene_.gauge_offset_walk) {
    for (std::size_t j = 0; j < gauges_; ++j) {
      links_[t].push_back(problem_->AddResidualBlock(
          new GaugeOffsetChangeResidual(
              scene_.gauge_offset_walk->std_V_per_sqrt_s, dt),
          nullptr, offsets(t - 1) + j, offsets(t) + j));
    }
  }
  if (!Linked(t)) return;
  const Smoothing change = scene_.smoothing.value_or(
      Smoothing{std::max(kContactWalk_mm * std::sqrt(dt), least_step_mm),
                std::numeric_limits<double>::infinity()});
  links_[t].push_back(problem_->AddResidualBlock(
      new ContactChangeResidual(change.contact_mm, change.normal_N), nullptr,
      contact(t - 1), contact(t)));
}

void LogProblem::AddPrior(const LogPrior& prior) {
  LogPrior known = prior;
  std::vector<double*> blocks;
  std::vector<int> sizes;
  for (int j = 0; j < FreeOffsets(); ++j) {
    blocks.push_back(offsets(0) + j);
    sizes.push_back(1);
  }
  if (prior.mean.size() > FreeOffsets()) {
    if (Touches(0)) {
      blocks.push_back(contact(0));
      sizes.push_back(2);
    } else {  // the contact that it tells about is gone
      known.mean = prior.mean.head(FreeOffsets());
      known.information =
          InverseInformation(InverseInformation(prior.information)
                                 .topLeftCorner(FreeOffsets(), FreeOffsets()));
    }
  }
  if (blocks.empty()) return;
  prior_.push_back(problem_->AddResidualBlock(
      new GaussianPriorResidual(known.mean, known.information, sizes), nullptr,
      blocks));
}

// The finger stays as it is; only offsets and contacts vary.
void LogProblem::FixWhatIsNotFree() {
  std::vector<double*> blocks;
  problem_->GetParameterBlocks(&blocks);
  for (double* block : blocks) {
    const bool of_finger =
        block < values_.data() || block >= values_.data() + values_.size();
    if (of_finger) problem_->SetParameterBlockConstant(block);
  }
  if (scene_.gauge_offset_walk) return;
  for (std::size_t t = 0; t < frames_->size(); ++t) {
    for (std::size_t j = 0; j < gauges_; ++j) {
      problem_->SetParameterBlockConstant(offsets(t) + j);
    }
  }
}

int LogProblem::Solve() {
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // The frames are evaluated on all threads (FrameSet). Sums of Ceres over
  // several threads would differ in their last digits from run to run.
  options.num_threads = 1;
  options.max_num_iterations =
      scene_.gauge_offset_walk ? kMostWithWalk : kMostSolverIterations;
  // The residuals are whitened. The information about an offset under a long
  // touch is 1e-3 of its diagonal: with this radius it is hardly damped.
  const double longest =
      *std::max_element(touch_frames_.begin(), touch_frames_.end());
  const bool is_long = longest > kLongTouch;
  options.initial_trust_region_radius = is_long ? 1e12 : 1e6;
  options.max_trust_region_radius = 1e16;
  // One frame in a flat direction must not hold up thousands: a change of 1e-4
  // in the cost of a frame is 0.01 std.
  options.function_tolerance =
      (is_long ? kLeastOfTouch * std::sqrt(longest) : kLeastChange) /
      static_cast<double>(frames_->size());
  options.parameter_tolerance = 1e-10;
  ceres::Solver::Summary summary;
  const ClassicNumbers in_messages;
  ceres::Solve(options, problem_.get(), &summary);
  // The last trial step may have been rejected; the evaluations then still hold
  // the results of that trial.
  evaluations_.PrepareForEvaluation(true, true);
  converged_ = summary.termination_type == ceres::CONVERGENCE;
  for (std::size_t t = 0; t < frames_->size(); ++t) {
    LogFrame& frame = (*frames_)[t];
    std::copy_n(offsets(t), gauges_, frame.offset_V.data());
    if (!Touches(t)) continue;
    const FrameEvaluation& at = *evaluation_of_[t];
    frame.arc_mm = std::clamp(contact(t)[0], 0.0, finger_.front_length_mm);
    frame.normal_N = contact(t)[1];
    frame.state = at.state();
    if (!at.valid()) {
      converged_ = false;
      frame.pose = frame.tip_pose = Eigen::Vector3d::Constant(std::nan(""));
      frame.rib_tension_N.assign(finger_.ribs.size(), std::nan(""));
      continue;
    }
    frame.pose = at.outputs().segment<3>(at.contact_row(0));
    frame.tip_pose = at.outputs().segment<3>(at.tip_row());
    const double* tensions = at.state().q.data() + 6;
    frame.rib_tension_N.assign(tensions, tensions + at.ribs());
  }
  Linearize();
  return std::max(0, static_cast<int>(summary.iterations.size()) - 1);
}

void LogProblem::Linearize() {
  ceres::Problem::EvaluateOptions options;
  std::vector<ceres::ResidualBlockId>& rows = options.residual_blocks;
  links_end_.clear();
  readings_end_.clear();
  int count = 0;
  const auto add = [&](const std::vector<ceres::ResidualBlockId>& blocks) {
    for (const ceres::ResidualBlockId block : blocks) {
      rows.push_back(block);
      count +=
          problem_->GetCostFunctionForResidualBlock(block)->num_residuals();
    }
    return count;
  };
  add(prior_);
  for (std::size_t t = 0; t < frames_->size(); ++t) {
    links_end_.push_back(add(links_[t]));
    readings_end_.push_back(add(readings_[t]));
    add(contact_priors_[t]);
    for (int j = 0; j < FreeOffsets(); ++j) {
      options.parameter_blocks.push_back(offsets(t) + j);
    }
    if (Touches(t)) options.parameter_blocks.push_back(contact(t));
  }
  jacobian_ = {};
  residuals_.clear();
  if (rows.empty() || options.parameter_blocks.empty()) return;
  if (!problem_->Evaluate(options, nullptr, &residuals_, nullptr, &jacobian_)) {
    jacobian_ = {};  // a frame has no equilibrium
    residuals_.clear();
    return;
  }
  ShareContactPriors();
}

// The covariance counts the priors of a touch as one.
void LogProblem::ShareContactPriors() {
  for (std::size_t t = 0; t < touch_frames_.size(); ++t) {
    if (contact_priors_[t].empty()) continue;
    const double share =
        1 / std::sqrt(std::min(touch_frames_[t], kPriorFrames));
    for (int row = readings_end_[t]; row < readings_end_[t] + 2; ++row) {
      residuals_[row] *= share;
      for (int k = jacobian_.rows[row]; k < jacobian_.rows[row + 1]; ++k) {
        jacobian_.values[k] *= share;
      }
    }
  }
}

BlockTridiagonal LogProblem::Information() const {
  std::vector<int> sizes;
  for (std::size_t t = 0; t < frames_->size(); ++t) {
    sizes.push_back(Unknowns(t));
  }
  return BlockTridiagonal(sizes);
}

std::vector<LogMarginal> LogProblem::Marginals() const {
  const std::size_t count = frames_->size();
  BlockTridiagonal all = Information(), own = Information();
  all.Add(jacobian_, residuals_, 0, jacobian_.num_rows);
  const std::vector<Eigen::MatrixXd> known = all.Marginals();
  std::vector<LogMarginal> marginals(count);
  const int offsets = FreeOffsets();
  const auto gauges = static_cast<Eigen::Index>(gauges_);
  for (std::size_t t = 0; t < count; ++t) {
    LogMarginal& marginal = marginals[t];
    // Offsets that do not wander are known.
    marginal.mean_without = (*frames_)[t].offset_V;
    marginal.offsets_without = Eigen::MatrixXd::Zero(gauges, gauges);
    if (jacobian_.num_rows == 0) continue;
    const int begin = links_end_[t], end = readings_end_[t];
    own.Add(jacobian_, residuals_, begin, end);
    for (int row = begin; row < end; ++row) {
      marginal.chi2 += residuals_[row] * residuals_[row];
    }
    marginal.covariance = InverseInformation(known[t]);
    if (offsets == 0) continue;
    Eigen::MatrixXd others = known[t] - own.diagonal(t);
    const bool linked = Linked(t) || (t + 1 < count && Linked(t + 1));
    if (!linked) others = others.topLeftCorner(offsets, offsets).eval();
    marginal.offsets_without =
        InverseInformation(others).topLeftCorner(offsets, offsets);
    const Eigen::VectorXd pull = own.gradient(t).head(offsets);
    marginal.mean_without += marginal.offsets_without * pull;
    marginal.chi2 += pull.dot(marginal.offsets_without * pull);
  }
  if (scene_.smoothing) FindChanges(all, &marginals);
  return marginals;
}

void LogProblem::FindChanges(const BlockTridiagonal& all,
                             std::vector<LogMarginal>* marginals) const {
  const std::vector<Eigen::MatrixXd> gains = all.Gains();
  const Eigen::Array2d told(scene_.smoothing->contact_mm,
                            scene_.smoothing->normal_N);
  for (std::size_t t = 1; t < marginals->size(); ++t) {
    if (!Linked(t)) continue;
    LogMarginal& to = (*marginals)[t];
    const Eigen::MatrixXd& before = (*marginals)[t - 1].covariance;
    const Eigen::MatrixXd both = gains[t - 1] * to.covariance;
    const Eigen::Array2d variance =
        before.diagonal().tail<2>() + to.covariance.diagonal().tail<2>() -
        2 * both.bottomRightCorner<2, 2>().diagonal();
    const LogFrame &from_frame = (*frames_)[t - 1], &frame = (*frames_)[t];
    const Eigen::Array2d change(frame.arc_mm - from_frame.arc_mm,
                                frame.normal_N - from_frame.normal_N);
    to.change_chi2 = (change / told).square().sum();
    to.change_dof = (1 - variance / told.square()).max(0).sum();
  }
}

void LogProblem::AddTo(WalkIncrements* walk,
                       const std::vector<LogMarginal>& marginals,
                       std::size_t count) const {
  if (!scene_.gauge_offset_walk || count < 2) return;
  walk->told_V_per_sqrt_s = scene_.gauge_offset_walk->std_V_per_sqrt_s;
  BlockTridiagonal all = Information();
  all.Add(jacobian_, residuals_, 0, jacobian_.num_rows);
  const std::vector<Eigen::MatrixXd> gains = all.Gains();
  constexpr std::size_t kMostSteps = std::size_t{1}
                                     << (WalkIncrements::kLags - 1);
  std::size_t steps = kMostSteps, lag = 0;
  for (; steps > count - 1; steps /= 2) ++lag;
  const auto frame = [&](std::size_t step) {
    return step * (count - 1) / steps;
  };
  // Of the steps between the chosen frames, then of the lag under way.
  std::vector<Eigen::MatrixXd> passed;
  for (std::size_t step = 0; step < steps; ++step) {
    passed.push_back(gains[frame(step)]);
    for (std::size_t t = frame(step) + 1; t < frame(step + 1); ++t) {
      passed.back() *= gains[t];
    }
  }
  const auto gauges = static_cast<Eigen::Index>(gauges_);
  for (std::size_t of = 1; of <= steps; of *= 2, ++lag) {
    for (std::size_t step = 0; step < steps; step += of) {
      if (of > 1) passed[step] *= passed[step + of / 2];
      const std::size_t from = frame(step), to = frame(step + of);
      const Eigen::MatrixXd& at_end = marginals[to].covariance;
      const Eigen::MatrixXd both =
          (passed[step] * at_end).topLeftCorner(gauges, gauges);
      walk->Add(lag, (*frames_)[to].offset_V - (*frames_)[from].offset_V,
                (*frames_)[to].row.time_s - (*frames_)[from].row.time_s,
                marginals[from].covariance.topLeftCorner(gauges, gauges) +
                    at_end.topLeftCorner(gauges, gauges) - both -
                    both.transpose());
    }
  }
}

LogPrior LogProblem::PriorOf(std::size_t frame) const {
  std::vector<int> sizes;
  for (std::size_t t = 0; t <= frame; ++t) sizes.push_back(Unknowns(t));
  BlockTridiagonal past(sizes);
  past.Add(jacobian_, residuals_, 0,
           jacobian_.num_rows > 0 ? links_end_[frame] : 0);
  const BlockTridiagonal::Marginal last = past.Last();
  const int size = FreeOffsets() + (Linked(frame) ? 2 : 0);
  LogPrior prior;
  prior.information = last.information.topLeftCorner(size, size);
  const double* solution = &values_[frame * stride_ + gauges_ - FreeOffsets()];
  prior.mean = Eigen::Map<const Eigen::VectorXd>(solution, size) -
               InverseInformation(prior.information) * last.gradient.head(size);
  return prior;
}

}  // namespace finray
