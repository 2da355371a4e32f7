#include "finray/calib/solve/joint_problem.h"

#include <algorithm>
#include <limits>
#include <string>

#include "finray/io/number_text.h"
#include "finray/residuals/frame_blocks.h"
#include "finray/residuals/parameter_prior_residual.h"

namespace finray {
namespace {

// A trust region of this radius or more hardly dampens a step of Gauss and
// Newton: its radius is in units of the diagonal of J'J.
constexpr double kUndamped = 1e4;
// Of FrameSet, for each frame. A solve that converges takes some 1e4, one of a
// start that is far off some 1e5.
constexpr double kMostWork = 5e5;

// Tells each iteration to who waits, and ends the solve after the last one.
class TellIteration : public ceres::IterationCallback {
 public:
  TellIteration(const CalibrationProblem* problem, std::size_t frames,
                double least_decrease)
      : problem_(*problem), frames_(frames), least_decrease_(least_decrease) {}
  ceres::CallbackReturnType operator()(
      const ceres::IterationSummary& iteration) override {
    problem_.Tell(std::to_string(frames_) + " frames, iteration " +
                  std::to_string(iteration.iteration));
    return iteration.iteration > 0 && iteration.step_is_successful &&
                   iteration.trust_region_radius > kUndamped &&
                   iteration.cost_change < least_decrease_
               ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
               : ceres::SOLVER_CONTINUE;
  }

 private:
  const CalibrationProblem& problem_;
  std::size_t frames_;
  double least_decrease_;
};

}  // namespace

JointProblem::JointProblem(const std::vector<int>& frames, EquilibriumForm form,
                           CalibrationProblem* problem, ContactStore* contacts)
    : problem_(*problem),
      contacts_(*contacts),
      form_(form),
      evaluations_(problem->finger(), problem->discretization(), form,
                   &problem->parameters().shared, problem->threads()),
      solver_(problem->finger(), problem->discretization()),
      equilibrium_loss_(nullptr, ceres::TAKE_OWNERSHIP),
      loss_(MakeLoss(problem->plan())),
      frames_(frames.size()) {
  ceres::Problem::Options options;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.evaluation_callback = &evaluations_;
  residuals_ = std::make_unique<ceres::Problem>(options);
  // The blocks stay where they are, in the order of the frames.
  unknowns_.reserve(frames.size() * (6 + problem->finger().ribs.size() + 2));
  evaluations_.set_most_work(kMostWork * static_cast<double>(frames.size()));
  for (const int i : frames) AddFrame(i);
  AddPriors();
}

SolveReport JointProblem::Solve(const JointLimits& limits) {
  TellIteration tell(&problem_, frames_, limits.least_decrease);
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = limits.iterations;
  // The residuals are whitened, so that Gauss-Newton steps have the right
  // size. A small radius would creep along the weak directions.
  options.initial_trust_region_radius = 1e10;
  options.max_trust_region_radius = 1e16;
  options.function_tolerance = limits.function_tolerance;
  options.parameter_tolerance = 1e-11;
  options.gradient_tolerance = 1e-12;
  // With bounds, Ceres searches along each step, and nearly always takes all of
  // it. A cubic would ask for derivatives there.
  options.line_search_interpolation_type = ceres::QUADRATIC;
  options.callbacks.push_back(&tell);
  // The weights of equilibrium leave normal equations, and so Schur's too,
  // without a correct digit.
  options.linear_solver_type = ceres::DENSE_QR;
  const auto ordering = FixAndOrder();
  if (!frame_blocks_.empty() && form_ == EquilibriumForm::kReduced) {
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.linear_solver_ordering = ordering;
  }
  ceres::Solver::Summary summary;
  const ClassicNumbers in_messages;
  ceres::Solve(options, residuals_.get(), &summary);
  for (const WeightedFrame& frame : weighted_) {
    std::copy_n(frame.contact, 2, frame.in_store);
  }
  SolveReport report = ReportOf(summary);
  report.exhausted = evaluations_.exhausted();
  if (report.exhausted) {
    report.converged = false;
    report.message = FormatText(
        "equilibria far beyond any finger take too long: ended in iteration "
        "%d, chi2 %.3g after %.3g at the start",
        report.iterations + 1, 2 * report.final_cost, 2 * report.initial_cost);
  }
  return report;
}

void JointProblem::set_weight(double weight) {
  equilibrium_loss_.Reset(
      new ceres::ScaledLoss(nullptr, weight * weight, ceres::TAKE_OWNERSHIP),
      ceres::TAKE_OWNERSHIP);
}

void JointProblem::AddFrame(int i) {
  const CalibrationFrame& frame = problem_.frame(i);
  const bool weighted = form_ == EquilibriumForm::kWeighted && !frame.IsBench();
  double* contact = frame.contact ? contacts_[i].data() : nullptr;
  double* unknowns = weighted ? StartWeighted(i, contact) : contact;
  if (!ready_) return;
  FrameEvaluation* evaluation = nullptr;
  if (!frame.IsBench()) {
    evaluation = &evaluations_.Add(
        frame.contact ? 1 : 0, problem_.parameters().friction(), unknowns,
        !frame.pins.empty(), problem_.plan().MovesGauges(),
        problem_.parameters().FrictionOf(frame));
    const LadderState state =
        contacts_.StateNear(contacts_[i][0], contacts_[i][1]);
    if (state.q.size() > 0) evaluation->set_state(state);
  }
  for (FrameBlock& block : problem_.blocks().Of(frame, evaluation, unknowns)) {
    residuals_->AddResidualBlock(block.cost.release(), loss_.get(),
                                 block.parameters);
  }
  if (weighted) {
    for (FrameBlock& block : EquilibriumBlocks(problem_.finger(), 1,
                                               problem_.parameters().Of(frame),
                                               *evaluation, unknowns)) {
      residuals_->AddResidualBlock(block.cost.release(), &equilibrium_loss_,
                                   block.parameters);
    }
  }
  if (unknowns == nullptr) return;
  frame_blocks_.push_back(unknowns);
  if (contact == nullptr) return;
  const int at = evaluation->contact_offset(0);
  residuals_->SetParameterLowerBound(unknowns, at, 0);
  residuals_->SetParameterUpperBound(unknowns, at,
                                     problem_.finger().front_length_mm);
  residuals_->SetParameterLowerBound(unknowns, at + 1, 0);
}

double* JointProblem::StartWeighted(int i, const double* contact) {
  solver_.Reset();
  std::vector<PointContact> loads;
  if (contact != nullptr) {
    const CalibrationParameters& parameters = problem_.parameters();
    loads.push_back(
        {contact[0], contact[1],
         parameters.FrictionOf(problem_.frame(i)).At(parameters.friction())});
  }
  ready_ &= solver_.Solve(loads);
  if (!ready_) return nullptr;
  const Eigen::VectorXd q = solver_.state().q;
  double* unknowns = unknowns_.data() + unknowns_.size();
  unknowns_.insert(unknowns_.end(), q.data(), q.data() + q.size());
  if (contact == nullptr) return unknowns;
  unknowns_.insert(unknowns_.end(), contact, contact + 2);
  weighted_.push_back({unknowns + q.size(), contacts_[i].data()});
  return unknowns;
}

// Adds a prior for each parameter block. Several parameters may share a block
// (rib lengths).
void JointProblem::AddPriors() {
  const auto& all = problem_.parameters().all();
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i + 1;
    while (end < all.size() && all[end].block == all[i].block) ++end;
    const auto size = static_cast<Eigen::Index>(end - i);
    const bool any =
        std::any_of(all.begin() + static_cast<std::ptrdiff_t>(i),
                    all.begin() + static_cast<std::ptrdiff_t>(end),
                    [](const auto& p) { return p.prior_std.has_value(); });
    if (all[i].free && any) {
      Eigen::VectorXd mean(size), std(size);
      for (Eigen::Index k = 0; k < size; ++k) {
        mean[k] = all[i + k].initial;
        std[k] = all[i + k].prior_std.value_or(
            std::numeric_limits<double>::infinity());
      }
      residuals_->AddResidualBlock(ParameterPriorResidual::Create(mean, std),
                                   nullptr, all[i].block);
    }
    i = end;
  }
}

// Fixes the blocks that are not free, and returns the order of all. The frames
// are eliminated first. Each shared block has a group of its own: within a
// group Ceres orders blocks by address, and results would depend on where the
// heap has put them.
std::shared_ptr<ceres::ParameterBlockOrdering> JointProblem::FixAndOrder() {
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (double* block : frame_blocks_) {
    ordering->AddElementToGroup(block, 0);
  }
  int group = 1;
  for (const int i : problem_.parameters().free()) {
    double* block = problem_.parameters().all()[i].block;
    if (residuals_->HasParameterBlock(block) && !ordering->IsMember(block)) {
      ordering->AddElementToGroup(block, group++);
    }
  }
  std::vector<double*> all;
  residuals_->GetParameterBlocks(&all);
  for (double* block : all) {  // constant blocks come last
    if (ordering->IsMember(block)) continue;
    residuals_->SetParameterBlockConstant(block);
    ordering->AddElementToGroup(block, group);
  }
  return ordering;
}

}  // namespace finray
