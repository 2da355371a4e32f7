#include "finray/estimation/frame_problem.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/QR>
#include <algorithm>
#include <limits>

#include "finray/residuals/block_rows.h"

namespace finray {
namespace {

constexpr int kMostIterations = 200;
// These tolerances find the minimum to within 1e-5 of a std. The residuals are
// whitened, so a small trust region would only creep along weak directions.
constexpr double kParameterTolerance = 1e-11, kFunctionTolerance = 1e-15,
                 kTrustRegion = 1e12;
// The minimum under a small weight is near the one under a larger weight, so
// the weighted form is solved with rising weights. From further away the solver
// would creep along the curved valley in which equilibrium holds.
constexpr double kWeights[] = {1e3, 1e4, 1e5, 1e6, kEquilibriumWeight};

// A decrease of a hopeless chi2 by less than this share of it ends the solve,
// and so does one by less than kNothing behind the first kPatience iterations:
// in a flat valley the solver would creep on.
constexpr double kLeastShare = 1e-3, kNothing = 1e-6;
constexpr int kPatience = 60;

// Ends such solves. It also starts each trial from the equilibrium of the last
// point that Ceres accepted: a rejected trial may have led far away.
class AfterStep final : public ceres::IterationCallback {
 public:
  explicit AfterStep(FrameEvaluation& frame) : frame_(frame) {}
  const LadderState& accepted() const { return accepted_; }

  ceres::CallbackReturnType operator()(
      const ceres::IterationSummary& step) override {
    if (!step.step_is_successful) {
      frame_.set_state(accepted_);
      return ceres::SOLVER_CONTINUE;
    }
    accepted_ = frame_.state();
    if (step.iteration == 0) return ceres::SOLVER_CONTINUE;
    const bool hopeless = 2 * step.cost > FrameProblem::kHopelessChi2 &&
                          step.cost_change < kLeastShare * step.cost;
    const bool creeps =
        step.iteration >= kPatience && 2 * step.cost_change < kNothing;
    return hopeless || creeps ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                              : ceres::SOLVER_CONTINUE;
  }

 private:
  FrameEvaluation& frame_;
  LadderState accepted_ = frame_.state();
};

}  // namespace

FrameProblem::FrameProblem(const Finger& finger, const Scene& scene,
                           const Discretization& discretization,
                           EquilibriumForm form, double most_force_N)
    : finger_(WithoutCalibration(finger)),
      model_(MeasurementModel::OfScene(finger, scene)),
      friction_(scene.friction_coefficient),
      most_force_N_(most_force_N),
      camera_(scene.UsesCamera()),
      form_(form),
      parameters_(finger_, scene.circle_radius_mm()),
      frames_(finger, discretization, form, parameters_.shared(), 1),
      solver_(finger, discretization) {}

FrameEvaluation& FrameProblem::Prepare(const Measurements& row, int contacts,
                                       const LadderState& state,
                                       double weight) {
  blocks_.clear();
  frames_.Clear();
  FrameEvaluation& frame =
      frames_.Add(contacts, friction_, unknowns_.data(), camera_);
  frame.set_state(state);
  blocks_ = MeasurementBlocks(row, model_, parameters_.frame(), finger_.gauges,
                              &frame, unknowns_.data());
  if (form_ == EquilibriumForm::kWeighted) {
    for (FrameBlock& block : EquilibriumBlocks(
             finger_, weight, parameters_.frame(), frame, unknowns_.data())) {
      blocks_.push_back(std::move(block));
    }
  }
  return frame;
}

// In the weighted form, base loads and tensions start in equilibrium with the
// contacts of the start. Returns false if there is no such equilibrium.
bool FrameProblem::SetUnknowns(const ContactStart& start) {
  unknowns_.clear();
  if (form_ == EquilibriumForm::kWeighted) {
    const std::vector<PointContact> contacts(
        start.contacts.begin(), start.contacts.begin() + start.count);
    solver_.set_state(*start.state);
    if (!solver_.Solve(contacts)) return false;
    const Eigen::VectorXd q = solver_.state().q;
    unknowns_.assign(q.data(), q.data() + q.size());
  }
  for (int c = 0; c < start.count; ++c) {
    unknowns_.push_back(start.contacts[c].arc_mm);
    unknowns_.push_back(start.contacts[c].normal_N);
  }
  return true;
}

bool FrameProblem::Fit(const ContactStart& start, const Measurements& row,
                       ContactSolution* solution) {
  iterations_ = 0;
  if (!SetUnknowns(start)) return false;
  if (form_ == EquilibriumForm::kReduced) {
    const FrameEvaluation& frame =
        Prepare(row, start.count, *start.state, kEquilibriumWeight);
    return Solve() && Read(start, frame, solution);
  }
  for (const double weight : kWeights) {
    const FrameEvaluation& frame =
        Prepare(row, start.count, *start.state, weight);
    const bool converged = Solve();
    if (weight < kEquilibriumWeight) continue;
    return converged && Read(start, frame, solution);
  }
  return false;
}

bool FrameProblem::Solve() {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.evaluation_callback = &frames_;
  ceres::Problem problem(options);
  for (FrameBlock& block : blocks_) {
    problem.AddResidualBlock(block.cost.get(), nullptr, block.parameters);
  }
  double* unknowns = unknowns_.data();
  if (!problem.HasParameterBlock(unknowns)) return false;
  std::vector<double*> all;
  problem.GetParameterBlocks(&all);
  for (double* block : all) {
    if (block != unknowns) problem.SetParameterBlockConstant(block);
  }
  // The start may be far from the state that came with it. The trials behind it
  // look near the last equilibrium only.
  frames_.set_near_only(most_iterations_.has_value());
  frames_.PrepareForEvaluation(true, true);
  const FrameEvaluation& frame = frames_[0];
  if (!frame.valid()) {
    frames_.set_near_only(false);
    return false;
  }
  frames_.set_near_only(true);
  for (int c = 0; c < frame.contacts(); ++c) {
    const int at = frame.contact_offset(c);
    problem.SetParameterLowerBound(unknowns, at, 0);
    problem.SetParameterUpperBound(unknowns, at, finger_.front_length_mm);
    problem.SetParameterLowerBound(unknowns, at + 1, 0);
    problem.SetParameterUpperBound(unknowns, at + 1, most_force_N_);
  }
  ceres::Solver::Options solve;
  solve.logging_type = ceres::SILENT;
  solve.linear_solver_type = ceres::DENSE_QR;
  // Each trial without an equilibrium counts as an invalid step.
  solve.max_num_consecutive_invalid_steps = kMostIterations;
  solve.max_num_iterations = kMostIterations;
  if (most_iterations_) {
    solve.max_num_iterations =
        std::clamp(*most_iterations_ - iterations_, 0, kMostIterations);
  }
  solve.initial_trust_region_radius = kTrustRegion;
  solve.max_trust_region_radius = 1e16;
  solve.function_tolerance = kFunctionTolerance;
  solve.parameter_tolerance = kParameterTolerance;
  solve.gradient_tolerance = 0;
  AfterStep after_step(frames_[0]);
  solve.callbacks.push_back(&after_step);
  ceres::Solver::Summary summary;
  ceres::Solve(solve, &problem, &summary);
  frames_.set_near_only(false);
  frames_[0].set_state(after_step.accepted());
  iterations_ += static_cast<int>(summary.iterations.size());
  return summary.termination_type == ceres::CONVERGENCE ||
         summary.termination_type == ceres::USER_SUCCESS;
}

bool FrameProblem::Read(const ContactStart& start, const FrameEvaluation& frame,
                        ContactSolution* solution) {
  // The last step that Ceres tried may have been rejected, so the frame is
  // evaluated at the solution again.
  frames_.PrepareForEvaluation(true, true);
  const int size = frame.frame_size();
  BlockRows rows;
  if (!frame.valid() ||
      !rows.Evaluate(blocks_, {{unknowns_.data(), 0}}, size)) {
    return false;
  }
  const int count = start.count;
  solution->count = count;
  solution->chi2 = rows.residuals.squaredNorm();
  solution->state = frame.state();
  for (int c = 0; c < count; ++c) {
    solution->contacts[c] = frame.contact(c);
    solution->poses[c] = frame.outputs().segment<3>(frame.contact_row(c));
  }
  solution->tip_pose = frame.outputs().segment<3>(frame.tip_row());
  const Eigen::VectorXd& q = frame.state().q;
  solution->rib_tension_N.assign(q.data() + 6, q.data() + 6 + frame.ribs());
  // Let [base loads and tensions | contacts] = Q R. The lower right block of R
  // is then a square root of the contacts' information with all other unknowns
  // eliminated.
  const Eigen::MatrixXd r =
      Eigen::HouseholderQR<Eigen::MatrixXd>(rows.jacobian)
          .matrixQR()
          .topRows(std::min<Eigen::Index>(rows.jacobian.rows(), size))
          .triangularView<Eigen::Upper>();
  const Eigen::MatrixXd root = r.bottomRightCorner(
      std::max<Eigen::Index>(0, r.rows() - size + 2 * count), 2 * count);
  solution->information = root.transpose() * root;
  return true;
}

double FrameProblem::FreeChi2(const Measurements& row) {
  const LadderState undeformed = LadderState::Undeformed(frames_.model());
  ContactStart none;
  none.state = &undeformed;
  BlockRows rows;
  if (SetUnknowns(none)) {
    Prepare(row, 0, undeformed, kEquilibriumWeight);
    frames_.PrepareForEvaluation(false, true);
    if (rows.Evaluate(blocks_, {}, 0)) return rows.residuals.squaredNorm();
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace finray
