#include "finray/calib/solve/contact_guess.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "finray/finger/geometry.h"

namespace finray {
namespace {

// The table has half as many rows as the table of an estimate. Its tolerance
// and that of the fit are as small as the solve that starts from them needs.
// The tolerance of the fit is relative to l_0 and EI / l_0^2.
constexpr int kRows = GaugeTable::kMostRows / 2;
constexpr double kMostGap_mm = 2;
constexpr double kTableTolerance = 1e-6, kFitTolerance = 1e-3;
// The surface is exact to this, in std: the solve goes on from the guess.
constexpr double kSurfaceExact_std = 0.1;

EquilibriumSolver SolverFor(const CalibrationProblem& problem) {
  EquilibriumSolver solver(problem.parameters().Apply(problem.finger()),
                           problem.discretization());
  solver.set_tolerance(kTableTolerance);
  return solver;
}

// The radius of the circle at the present parameters, if there is a circle.
std::optional<double> RadiusOf(const CalibrationProblem& problem) {
  return problem.plan().scene.circle_radius_mm()
             ? std::optional(problem.parameters().object_radius_mm)
             : std::nullopt;
}

}  // namespace

ContactGuess::ContactGuess(CalibrationProblem* problem, bool many)
    : problem_(*problem),
      solver_(SolverFor(*problem)),
      table_(&solver_, problem->parameters().friction(), RadiusOf(*problem),
             std::nullopt, problem->threads(), kRows),
      fit_(solver_.model().finger(), problem->discretization(),
           RadiusOf(*problem)),
      many_(many),
      circle_(RadiusOf(*problem).has_value()) {
  const auto size = static_cast<Eigen::Index>(problem->finger().gauges.size()) +
                    (circle_ ? 2 : 0);
  values_.resize(size);
  weights_.resize(size);
  fit_.set_most_force(table_.heaviest_N());
  fit_.set_tolerance(kFitTolerance);
  if (many && size > 0) {
    surface_ = std::make_shared<const GaugeSurface>(
        solver_, problem->parameters().friction(), RadiusOf(*problem),
        table_.heaviest_N(), kSurfaceExact_std);
  }
}

ContactGuess::Place ContactGuess::Of(const CalibrationFrame& frame, From from) {
  values_.setZero();
  weights_.setZero();
  const bool by_object = circle_ && frame.object_mm.allFinite();
  if (by_object) AddCircle(frame);
  if (!by_object || from == From::kAll) AddGauges(frame);
  // A fit makes the finger meet the circle exactly. The data may not tell the
  // common scale of all stiffnesses and forces, which then stays as given only
  // if the start is near a solution. kObjectFirst does not fit gauges alone:
  // unknown gains would pull the contact anywhere.
  Place place = FromTable(by_object || from == From::kAll);
  if (std::isfinite(frame.contact_mm)) {
    place.arc_mm =
        std::clamp(frame.contact_mm, 0.0, problem_.finger().front_length_mm);
  }
  const double force = frame.Force().magnitude_N;
  // A wild force may be larger than the finger can carry.
  if (from == From::kObjectFirst && force <= table_.heaviest_N()) {
    place.normal_N = std::max(force, 0.0);
  }
  return place;
}

void ContactGuess::AddCircle(const CalibrationFrame& frame) {
  values_.tail<2>() =
      problem_.parameters().Stage(frame.log).InS(frame.object_mm);
  weights_.tail<2>().setConstant(1 / problem_.plan().object_std_mm);
}

void ContactGuess::AddGauges(const CalibrationFrame& frame) {
  CalibrationParameters& parameters = problem_.parameters();
  for (int j = 0; j < static_cast<int>(frame.gauges_V.size()); ++j) {
    Gauge gauge = parameters.Present(problem_.finger(), j);
    gauge.offset_V =
        parameters.readings.Sum(frame, j) + parameters.OfHistory(frame, j);
    const double angle = gauge.Angle(frame.gauges_V[j]);
    if (!std::isfinite(angle)) continue;
    values_[j] = angle;
    weights_[j] = std::abs(gauge.Slope(angle)) /
                  frame.GaugeStd_V(static_cast<std::size_t>(j),
                                   problem_.blocks().gauge_std_V(j));
  }
}

ContactGuess::Place ContactGuess::FromTable(bool fit) {
  const ContactStart start = table_.BestStart(values_, weights_);
  if (start.state == nullptr) {
    return {problem_.finger().front_length_mm / 2,
            ForceUnit(solver_.model().finger()), false};
  }
  Place place{start.contacts[0].arc_mm, start.contacts[0].normal_N, false};
  double chi2 = 0;
  if (!fit || !Fit(start, &place, &chi2)) return place;
  // A circle out of reach leaves the contact on a bound.
  const bool alone = circle_ && weights_.head(weights_.size() - 2).isZero();
  const double gap_mm = std::sqrt(chi2) * problem_.plan().object_std_mm;
  place.met = !alone || gap_mm < kMostGap_mm;
  return place;
}

bool ContactGuess::Fit(const ContactStart& start, Place* place, double* chi2) {
  if (surface_ && surface_->Fit(values_, weights_, table_.heaviest_N(),
                                start.contacts[0], &solution_)) {
    place->arc_mm = solution_.contacts[0].arc_mm;
    place->normal_N = solution_.contacts[0].normal_N;
    *chi2 = solution_.chi2;
    return true;
  }
  std::vector<PointContact> contact = {start.contacts[0]};
  fit_.set_state(*start.state);
  if (!fit_.Fit(values_, weights_, &contact)) return false;
  place->arc_mm = contact[0].arc_mm;
  place->normal_N = contact[0].normal_N;
  *chi2 = fit_.chi2();
  return true;
}

}  // namespace finray
