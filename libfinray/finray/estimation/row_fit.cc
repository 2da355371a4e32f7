#include "finray/estimation/row_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace finray {
namespace {

// Cells leave out this share of what a row may.
constexpr double kShare = 0.1;
// The equilibria of a surface are solved to this tolerance. Newton's method
// ends far below it.
constexpr double kSurfaceTolerance = 1e-10;
// Fits end with a step that lowers chi2 / 2 by less: 4e-5 std on a surface,
// which is itself no more exact, and 1e-5 std in equilibrium. What is left is a
// small part of the step, and nothing without noise.
constexpr double kLastOnSurface = 1e-9, kLastInEquilibrium = 1e-10;
constexpr double kSmallChange = 1e-3;
// 0.3 std where the contact is hardly determined.
constexpr double kCreeping = 0.05;
// The equilibria of a fit are solved to this share of the gauges' least noise
// in rad, within these bounds. Newton's method ends far below it.
constexpr double kOfNoise = 1e-5, kToRounding = 1e-14, kMostTolerance = 1e-9;

double ToleranceFor(const Finger& finger) {
  double noise_rad = 1;
  for (const Gauge& gauge : finger.gauges) {
    noise_rad = std::min(noise_rad, 1 / gauge.AngleWeight());
  }
  return std::clamp(kOfNoise * noise_rad, kToRounding, kMostTolerance);
}

FrameFit::Shared SharedOf(RowFrames* frames, const ModelSurface* surface,
                          bool solves, double most_force_N) {
  FrameFit::Shared shared;
  shared.parameters = frames->parameters().shared();
  shared.surface = surface;
  shared.solves = solves;
  shared.most_force_N = most_force_N;
  return shared;
}

}  // namespace

ModelSurface RowFit::SurfaceFor(const Finger& finger, const Scene& scene,
                                const Discretization& discretization,
                                double heaviest_N) {
  const Finger bare = WithoutCalibration(finger);
  EquilibriumSolver solver(bare, discretization);
  solver.set_tolerance(kSurfaceTolerance);
  ModelSurface::Content content{
      RowFrames::Resolution(bare, scene, kShare * kExact_std)};
  content.by_parameter = false;
  content.shape = true;
  content.heaviest_N = heaviest_N;
  return ModelSurface(solver, SharedParameters::Of(bare),
                      scene.friction_coefficient, false, content);
}

RowFit::RowFit(const Finger& finger, const Scene& scene,
               const Discretization& discretization,
               const ModelSurface* surface, double most_force_N)
    : surface_(surface),
      frames_(WithoutCalibration(finger), scene, discretization),
      tolerance_(ToleranceFor(finger)),
      coarseness_(RowFrames::Coarseness(finger, kShare * kExact_std)),
      on_surface_(frames_.solver(),
                  SharedOf(&frames_, surface, false, most_force_N)),
      on_equilibria_(frames_.solver(),
                     SharedOf(&frames_, nullptr, true, most_force_N)),
      from_start_(
          [this](const double*, LadderState* state) { *state = *start_; }) {
  // Trials look near the last equilibrium only: a missing one is found out a
  // hundred times faster.
  on_equilibria_.solver().set_near_only(true);
}

double RowFit::FreeChi2(const Measurements& row) {
  const FrameFit::Frame frame = frames_.Of(row, nullptr, 0);
  FrameEvaluation& evaluation = *frame.evaluation;
  if (!evaluation.valid()) {
    EquilibriumSolver solver = frames_.solver();
    evaluation.set_state({});
    evaluation.Update(nullptr, *frames_.parameters().shared(), &solver);
  }
  double chi2 = 0;
  for (const FrameBlock& block : *frame.blocks) {
    std::array<double, 2> residuals{};  // no block has more
    if (!block.cost->Evaluate(block.parameters.data(), residuals.data(),
                              nullptr)) {
      return std::numeric_limits<double>::infinity();
    }
    chi2 += residuals[0] * residuals[0] + residuals[1] * residuals[1];
  }
  return chi2;
}

bool RowFit::Fit(const ContactStart& start, Model model, int most_evaluations,
                 ContactSolution* solution) {
  const FrameFit::Frame frame =
      frames_.Of(*row_, start.contacts.data(), start.count);
  start_ = start.state;
  const bool by_surface = model == Model::kSurface;
  if (by_surface && (surface_ == nullptr || !frame.evaluation->FitsSurface())) {
    return false;
  }
  FrameFit& fit = by_surface ? on_surface_ : on_equilibria_;
  fit.solver().set_tolerance(model == Model::kRounding ? kToRounding
                                                       : tolerance_);
  FrameFit::Ending ending;
  ending.small_change = kSmallChange;
  ending.small_decrease = by_surface ? kLastOnSurface : kLastInEquilibrium;
  ending.most_evaluations = most_evaluations;
  if (most_evaluations >= kMostEvaluations) ending.creeping = kCreeping;
  ending.takes_last_step = true;
  const bool fitted = fit.Fit(frame, from_start_, &at_, ending);
  evaluations_ = fit.evaluations();
  return fitted && fit.converged() && Read(start, frame, fit, solution);
}

bool RowFit::FitWithin(const ContactBounds& bounds, double small_decrease,
                       int most_evaluations, ContactStart* start) {
  FrameFit::Frame frame =
      frames_.Of(*row_, start->contacts.data(), start->count);
  frame.bounds = &bounds;
  start_ = start->state;
  evaluation_ = frame.evaluation;
  on_equilibria_.solver().set_tolerance(tolerance_);
  FrameFit::Ending ending;
  ending.small_decrease = 0.5 * small_decrease;  // of chi2 / 2
  ending.most_evaluations = most_evaluations;
  ending.takes_last_step = true;
  const bool fitted = on_equilibria_.Fit(frame, from_start_, &at_, ending);
  evaluations_ = on_equilibria_.evaluations();
  if (!fitted) return false;
  for (int c = 0; c < start->count; ++c) {
    start->contacts[c].arc_mm = frame.contacts[2 * c];
    start->contacts[c].normal_N = frame.contacts[2 * c + 1];
  }
  start->chi2 = 2 * at_.cost;
  return true;
}

bool RowFit::FitFrom(const std::vector<PointContact>& contacts,
                     EquilibriumSolver* solver, ContactSolution* solution) {
  if (!solver->Solve(contacts)) return false;
  const LadderState state = solver->state();
  ContactStart start;
  start.count = static_cast<int>(contacts.size());
  std::copy(contacts.begin(), contacts.end(), start.contacts.begin());
  start.state = &state;
  return Fit(start, Model::kEquilibria, kMostEvaluations, solution);
}

bool RowFit::Read(const ContactStart& start, const FrameFit::Frame& frame,
                  const FrameFit& fit, ContactSolution* solution) {
  const FrameEvaluation& evaluation = *frame.evaluation;
  const double* const contacts = frame.contacts;
  solution->count = start.count;
  solution->chi2 = 2 * at_.cost;
  solution->information = at_.Information();
  for (int c = 0; c < start.count; ++c) {
    solution->contacts[c] = {contacts[2 * c], contacts[2 * c + 1],
                             evaluation.contact(c).friction};
  }
  if (fit.by_surface()) {
    // What the rows' std are more exact than the finger's.
    const double readings =
        std::sqrt(row_->gauge_readings * static_cast<double>(at_.rows.size()));
    return fit.error() * coarseness_ * kShare * readings < 1 &&
           surface_->ShapeAt(contacts[0], contacts[1], &solution->poses[0],
                             &solution->tip_pose, &solution->rib_tension_N);
  }
  // The last step was not evaluated.
  const auto pose = [&](int row) {
    Eigen::Vector3d pose = evaluation.outputs().segment<3>(row);
    for (int c = 0; c < start.count; ++c) {
      const PointContact& from = evaluation.contact(c);
      const auto by = evaluation.d_outputs().block<3, 2>(row, 2 * c);
      pose += by * Eigen::Vector2d(contacts[2 * c] - from.arc_mm,
                                   contacts[2 * c + 1] - from.normal_N);
    }
    return pose;
  };
  for (int c = 0; c < start.count; ++c) {
    solution->poses[c] = pose(evaluation.contact_row(c));
  }
  solution->tip_pose = pose(evaluation.tip_row());
  solution->state = evaluation.state();
  const Eigen::VectorXd& q = solution->state.q;
  solution->rib_tension_N.assign(q.data() + 6,
                                 q.data() + 6 + evaluation.ribs());
  return true;
}

}  // namespace finray
