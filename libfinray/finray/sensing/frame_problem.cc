#include "finray/sensing/frame_problem.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/QR>
#include <algorithm>
#include <limits>
#include <unordered_map>

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
    : finger_(ForFriction(finger, scene.friction())),
      model_(MeasurementModel::OfScene(finger, scene)),
      friction_(scene.friction_coefficient),
      most_force_N_(most_force_N),
      camera_(scene.UsesCamera()),
      form_(form),
      parameters_(finger_, scene.circle_radius_mm()),
      frames_(finger, discretization, form, parameters_.shared(), 1),
      solver_(finger, discretization) {
  if (finger_.calibration) calibration_factor_ = finger_.calibration->Factor();
}

FrameEvaluation& FrameProblem::Prepare(const Measurements& row, int contacts,
                                       const LadderState& state,
                                       double weight) {
  blocks_.clear();
  frames_.Clear();
  FrameEvaluation& frame =
      frames_.Add(contacts, friction_, unknowns_.data(), camera_,
                  finger_.calibration && finger_.calibration->HasGaugePlaces());
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
  if (calibration_factor_.size() > 0) {
    solution->systematic = Systematic(rows.jacobian, *solution);
  }
  return true;
}

// dx/dp = -(E'E)^-1 E'C, with E the derivatives of all blocks by the unknowns
// and C those by the parameters. Then C_sys = (dx/dp) C_pp (dx/dp)' as in
// CalibrationUncertainty.
// The discrepancy acts as offsets do, as gauges with a slope see an angle.
ContactMatrix FrameProblem::Systematic(const Eigen::MatrixXd& by_unknown,
                                       const ContactSolution& at) {
  const int contacts = at.count;
  SharedParameters& shared = *parameters_.shared();
  const auto& parameters = finger_.calibration->parameters;
  const auto count = static_cast<Eigen::Index>(parameters.size());
  const auto ribs = static_cast<Eigen::Index>(shared.rib_lengths_mm.size());
  const auto gauges = static_cast<Eigen::Index>(finger_.gauges.size());
  const auto effects = static_cast<Eigen::Index>(shared.effect_values.size());
  // Columns of C: stiffness, rib lengths, kOwn for each gauge, then effects.
  constexpr int kOwn = 7;
  const auto of_gauge = [ribs](int gauge, int which) {
    return static_cast<int>(2 + ribs) + kOwn * gauge + which;
  };
  std::unordered_map<const double*, int> column_of = {
      {&shared.ln_front_stiffness, 0}, {&shared.ln_back_stiffness, 1}};
  if (ribs > 0) column_of.emplace(shared.rib_lengths_mm.data(), 2);
  for (int j = 0; j < gauges; ++j) {
    double* const own[] = {
        parameters_.gain(j),         parameters_.offset(j),
        parameters_.curvature(j),    &shared.gauge_starts_mm[j],
        &shared.gauge_lengths_mm[j], parameters_.flat_share(j),
        parameters_.ln_flat_width(j)};
    for (int k = 0; k < kOwn; ++k) column_of.emplace(own[k], of_gauge(j, k));
  }
  int effect = of_gauge(static_cast<int>(gauges), 0);
  if (effects > 0) column_of.emplace(shared.effect_values.data(), effect);
  BlockRows rows;
  rows.Evaluate(blocks_, column_of,
                static_cast<int>(2 + ribs + kOwn * gauges + effects));
  Eigen::MatrixXd by_parameter(rows.jacobian.rows(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const FingerParameter& p = parameters[static_cast<std::size_t>(k)];
    const auto column = [&](Eigen::Index i) { return rows.jacobian.col(i); };
    switch (p.kind) {
      case FingerParameterKind::kFrontStiffness:
        by_parameter.col(k) = column(0) / finger_.front_stiffness_N_mm2;
        break;
      case FingerParameterKind::kBackStiffness:
        by_parameter.col(k) = column(1) / finger_.back_stiffness_N_mm2;
        break;
      case FingerParameterKind::kRibLength:
        by_parameter.col(k) = column(2 + p.index);
        break;
      case FingerParameterKind::kGaugeGain:
        by_parameter.col(k) = column(of_gauge(p.index, 0));
        break;
      case FingerParameterKind::kGaugeOffset:
        by_parameter.col(k) = column(of_gauge(p.index, 1));
        break;
      case FingerParameterKind::kGaugeCurvature:
        by_parameter.col(k) = column(of_gauge(p.index, 2));
        break;
      case FingerParameterKind::kGaugeStart:
        by_parameter.col(k) = column(of_gauge(p.index, 3));
        break;
      case FingerParameterKind::kGaugeLength:
        by_parameter.col(k) = column(of_gauge(p.index, 4));
        break;
      case FingerParameterKind::kGaugeCreepShare: {
        // As in CalibrationUncertainty, for a gauge that has come to rest.
        const Gauge& gauge = finger_.gauges[static_cast<std::size_t>(p.index)];
        by_parameter.col(k) = gauge.gain_V_per_rad / (1 + gauge.creep_share) *
                              column(of_gauge(p.index, 0));
        break;
      }
      case FingerParameterKind::kGaugeFlatShare:
        by_parameter.col(k) = column(of_gauge(p.index, 5));
        break;
      case FingerParameterKind::kGaugeFlatWidth:
        by_parameter.col(k) =
            column(of_gauge(p.index, 6)) /
            finger_.gauges[static_cast<std::size_t>(p.index)].flat_width_rad;
        break;
      case FingerParameterKind::kGaugeCreepTime:
      case FingerParameterKind::kGaugeHysteresis:
        by_parameter.col(k).setZero();
        break;
      case FingerParameterKind::kHingeStiffness:
      case FingerParameterKind::kRibBending:
      case FingerParameterKind::kFrontPiece:
      case FingerParameterKind::kBackPiece:
      case FingerParameterKind::kFrontHinge:
      case FingerParameterKind::kBackHinge:
      case FingerParameterKind::kFrontClamp:
      case FingerParameterKind::kBackClamp:
      case FingerParameterKind::kBackAngle:
      case FingerParameterKind::kSurfaceOffset:
      case FingerParameterKind::kFriction:
        by_parameter.col(k) = column(effect++);
        break;
    }
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(by_unknown);
  const Eigen::MatrixXd by_factor =
      qr.solve(by_parameter * calibration_factor_).bottomRows(2 * contacts);
  ContactMatrix systematic = by_factor * by_factor.transpose();
  if (finger_.calibration->discrepancy) {
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(gauges, gauges);
    Eigen::MatrixXd by_angle(rows.jacobian.rows(), gauges);
    for (int c = 0; c < contacts; ++c) {
      finger_.calibration->discrepancy->AddTo(
          at.contacts[c].arc_mm, at.contacts[c].normal_N, &covariance);
    }
    for (int j = 0; j < gauges; ++j) {
      const Gauge& gauge = finger_.gauges[static_cast<std::size_t>(j)];
      by_angle.col(j) = gauge.Slope(frames_[0].outputs()[j]) *
                        rows.jacobian.col(of_gauge(j, 1));
    }
    const Eigen::MatrixXd by_error =
        qr.solve(by_angle).bottomRows(2 * contacts);
    systematic += by_error * covariance * by_error.transpose();
  }
  return systematic;
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
