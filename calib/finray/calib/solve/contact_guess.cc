#include "finray/calib/solve/contact_guess.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "finray/calib/solve/frame_surface.h"
#include "finray/finger/geometry.h"

namespace finray {
namespace {

// The table has half as many rows as the table of an estimate. Its tolerance
// and that of the fit are as small as the solve that starts from them needs.
constexpr int kRows = GaugeTable::kMostRows / 2;
constexpr double kMostGap_mm = 2;
constexpr double kTolerance = 1e-6;
// The surface is exact to this, in std: the solve goes on from the guess.
constexpr double kGuess_std = 0.1, kGuess_rad = 1e-4;

EquilibriumSolver SolverAt(const CalibrationProblem& problem) {
  EquilibriumSolver solver(problem.parameters().Apply(problem.finger()),
                           problem.discretization());
  solver.set_tolerance(kTolerance);
  return solver;
}

// A fit starts from an equilibrium of the table, and needs no path of loads.
EquilibriumSolver NearSolver(const CalibrationProblem& problem) {
  EquilibriumSolver solver(problem.finger(), problem.discretization());
  solver.set_tolerance(kTolerance);
  solver.set_near_only(true);
  return solver;
}

// The radius of the circle at the present parameters, if there is a circle.
std::optional<double> RadiusOf(const CalibrationProblem& problem) {
  return problem.plan().scene.circle_radius_mm()
             ? std::optional(problem.parameters().object_radius_mm)
             : std::nullopt;
}

std::shared_ptr<const GaugeTable> TableOf(const CalibrationProblem& problem) {
  EquilibriumSolver solver = SolverAt(problem);
  return std::make_shared<const GaugeTable>(
      &solver, problem.parameters().friction(), RadiusOf(problem), std::nullopt,
      problem.threads(), kRows);
}

}  // namespace

ContactGuess::ContactGuess(CalibrationProblem* problem, bool many)
    : problem_(*problem),
      solver_(NearSolver(*problem)),
      table_(TableOf(*problem)),
      surface_(many ? std::make_shared<const ModelSurface>(
                          SurfaceOf(*problem, kGuess_std, kGuess_rad, false))
                    : nullptr),
      linearizer_(Linearizer()) {
  const auto gauges =
      static_cast<Eigen::Index>(problem->finger().gauges.size());
  const Eigen::Index size = gauges + (RadiusOf(*problem) ? 2 : 0);
  values_.resize(size);
  weights_.resize(size);
}

ContactGuess::ContactGuess(const ContactGuess& other)
    : problem_(other.problem_),
      solver_(other.solver_),
      table_(other.table_),
      surface_(other.surface_),
      linearizer_(Linearizer()),
      values_(other.values_),
      weights_(other.weights_) {}

FrameLinearizer ContactGuess::Linearizer() const {
  FrameLinearizer::Options options;
  options.surface = surface_.get();
  options.most_force_N = table_->heaviest_N();
  options.calibrates = false;
  return FrameLinearizer(solver_, problem_.plan(), &problem_.blocks(),
                         &problem_.parameters(), options);
}

ContactGuess::Place ContactGuess::Of(const CalibrationFrame& frame, From from) {
  const bool by_object =
      problem_.plan().scene.circle_radius_mm() && frame.object_mm.allFinite();
  Take(frame, by_object, !by_object || from == From::kAll);
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
  if (from == From::kObjectFirst && force <= table_->heaviest_N()) {
    place.normal_N = std::max(force, 0.0);
  }
  return place;
}

void ContactGuess::Take(const CalibrationFrame& frame, bool object,
                        bool gauges) {
  constexpr double kNone = CalibrationFrame::kNotMeasured;
  taken_ = frame;
  taken_.contact = true;
  taken_.force_N = taken_.contact_mm = kNone;
  taken_.force_xy_N.setConstant(kNone);
  taken_.tip_mm.setConstant(kNone);
  taken_.pins.clear();
  if (!object) taken_.object_mm.setConstant(kNone);
  if (!gauges) std::fill(taken_.gauges_V.begin(), taken_.gauges_V.end(), kNone);
  values_.setZero();
  weights_.setZero();
  if (object) PackCircle();
  if (gauges) PackGauges();
}

void ContactGuess::PackCircle() {
  values_.tail<2>() =
      problem_.parameters().Stage(taken_.log).InS(taken_.object_mm);
  weights_.tail<2>().setConstant(1 / problem_.plan().object_std_mm);
}

void ContactGuess::PackGauges() {
  CalibrationParameters& parameters = problem_.parameters();
  for (int j = 0; j < static_cast<int>(taken_.gauges_V.size()); ++j) {
    Gauge gauge = parameters.Present(problem_.finger(), j);
    gauge.offset_V =
        parameters.readings.Sum(taken_, j) + parameters.OfHistory(taken_, j);
    const double angle = gauge.Angle(taken_.gauges_V[j]);
    if (!std::isfinite(angle)) continue;
    values_[j] = angle;
    weights_[j] = std::abs(gauge.Slope(angle)) /
                  taken_.GaugeStd_V(static_cast<std::size_t>(j),
                                    problem_.blocks().gauge_std_V(j));
  }
}

ContactGuess::Place ContactGuess::FromTable(bool fit) {
  const ContactStart start = table_->BestStart(values_, weights_);
  if (start.state == nullptr) {
    return {problem_.finger().front_length_mm / 2,
            ForceUnit(problem_.parameters().Apply(problem_.finger())), false};
  }
  Place place{start.contacts[0].arc_mm, start.contacts[0].normal_N, false};
  if (!fit) return place;
  FrameFit::Ending ending;
  ending.takes_last_step = true;
  std::array<double, 2> contact = {place.arc_mm, place.normal_N};
  const auto state = [&](const double*, LadderState* near) {
    *near = *start.state;
  };
  if (!linearizer_.FitContact(taken_, &contact, state, &at_, ending) ||
      !linearizer_.converged()) {
    return place;
  }
  place.arc_mm = contact[0];
  place.normal_N = contact[1];
  // A circle out of reach leaves the contact on a bound.
  const double object_std_mm =
      taken_.place_std_times * problem_.plan().object_std_mm;
  place.met = !weights_.head(taken_.gauges_V.size()).isZero(0) ||
              std::sqrt(2 * at_.cost) * object_std_mm < kMostGap_mm;
  return place;
}

}  // namespace finray
