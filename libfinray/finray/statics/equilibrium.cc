#include "finray/statics/equilibrium.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/finger/geometry.h"
#include "finray/io/number_text.h"
#include "finray/ladder/contact_pose.h"
#include "finray/ladder/rib_law.h"

namespace finray {
namespace {

// A load is heavy if sum |f_c| l_0^2 / EI sqrt(wedge) is larger than this
// (docs/reference/statics.md). Newton's method may then find another
// equilibrium than the one that grows out of the unloaded finger, so only the
// path or a start within kNear_rad is trusted. Fingers with fewer than three
// ribs sway.
constexpr double kHeavyLoad = 60, kHeavyLoadOfFewRibs = 15;
constexpr int kFewRibs = 2;
constexpr double kNear_rad = 0.3;
// If Newton's method takes more iterations on one mesh, it has wandered and its
// result is not trusted either.
constexpr int kStraightIterations = 7;

// The unit of an effect in the ladder.
double EffectUnit(FingerParameterKind kind,
                  const LadderWorkspace<double>& unit) {
  switch (kind) {
    case FingerParameterKind::kHingeStiffness:
      return unit.moment_unit();
    case FingerParameterKind::kRibBending:
      return unit.stiffness_unit();
    case FingerParameterKind::kFrontHinge:
    case FingerParameterKind::kBackHinge:
    case FingerParameterKind::kSurfaceOffset:
      return unit.length_unit();
    case FingerParameterKind::kFrontClamp:
    case FingerParameterKind::kBackClamp:
      return 1 / unit.moment_unit();
    case FingerParameterKind::kBackAngle:
      return 1 / kDegree;  // the ladder counts in rad
    default:
      return 1;
  }
}

}  // namespace

EquilibriumSolver::EquilibriumSolver(const Finger& finger,
                                     const Discretization& discretization)
    : scheme_(discretization.scheme),
      newton_(finger, discretization),
      trail_(newton_.workspace().length_unit(),
             newton_.workspace().force_unit()) {}

LadderState EquilibriumSolver::state() const {
  LadderState state;
  SaveState(&state);
  return state;
}

void EquilibriumSolver::set_state(const LadderState& state) {
  newton_.Load(state);
  trail_.Clear();
  undeformed_ = false;
}

void EquilibriumSolver::Reset() {
  newton_.Reset();
  trail_.Clear();
  undeformed_ = true;
}

bool EquilibriumSolver::SolveFor(const std::vector<PointContact>& contacts,
                                 SweepColumns columns) {
  newton_.TakeIterations();
  path_fraction_ = 0;
  const bool too_many =
      columns == SweepColumns::kContacts && contacts.size() > kFittedContacts;
  status_ = too_many || IsBadLoad(contacts) ? SolveStatus::kBadLoad
                                            : Attempt(contacts, columns);
  iterations_ = newton_.TakeIterations();
  if (status_ == SolveStatus::kSolved && BendsTooFar(newton_.frame())) {
    status_ = SolveStatus::kRibTooBent;
    path_fraction_ = 1;
  }
  if (status_ != SolveStatus::kSolved) {
    Reset();
    return false;
  }
  undeformed_ = false;
  trail_.Add(contacts, newton_.frame().state.q, newton_.frame().state_size());
  CollectValues(true, &outputs_);
  if (columns == SweepColumns::kNone) return true;
  const int p = columns == SweepColumns::kContacts
                    ? 2 * newton_.frame().contact_count
                    : static_cast<int>(parameter_unit_.size());
  d_outputs_.setZero(outputs_.size(), p);
  AddTaps(newton_.frame().affine + 1, p, &d_outputs_);
  d_outputs_.array().colwise() *= output_unit_.array();
  d_outputs_.array().rowwise() /= parameter_unit_.head(p).transpose().array();
  return true;
}

SolveStatus EquilibriumSolver::Attempt(
    const std::vector<PointContact>& contacts, SweepColumns columns) {
  const bool heavy = IsHeavy(contacts);
  if (!undeformed_ && ConvergeNear(contacts, columns, heavy)) {
    return SolveStatus::kSolved;
  }
  if (near_only_) return SolveStatus::kNotConverged;
  trail_.Clear();  // the path may end on another branch
  if (!heavy) {
    newton_.Reset();
    if (Converge(contacts, columns, heavy)) return SolveStatus::kSolved;
  }
  const SolveStatus end = WalkLoadPath(contacts, &newton_, &path_fraction_);
  if (end != SolveStatus::kSolved || Converge(contacts, columns, true)) {
    return end;
  }
  return SolveStatus::kNotConverged;
}

// Moves the state to a guess, by the tangent at the newest equilibrium or else
// by the trail.
bool EquilibriumSolver::Predict(const std::vector<PointContact>& contacts) {
  const LadderFrame<double>& f = newton_.frame();
  return newton_.FollowTangent(contacts) ||
         trail_.Predict(contacts, f.state.q, f.state_size());
}

// Tries the guess, and then the newest equilibrium unless the mesh was refined
// on the way.
bool EquilibriumSolver::ConvergeNear(const std::vector<PointContact>& contacts,
                                     SweepColumns columns, bool heavy) {
  const LadderFrame<double>& f = newton_.frame();
  const Eigen::Index size = f.state_size();
  if (Predict(contacts)) {
    const Eigen::VectorXd& before = trail_.newest();
    double turned = 0;
    for (int e = 0; e < f.elements; ++e) {
      turned = std::max(
          turned,
          std::abs(f.state.theta[e] - before[f.state.theta - f.state.q + e]));
    }
    if (Converge(contacts, columns, heavy, turned)) return true;
    if (f.state_size() != size) return false;
    Eigen::Map<Eigen::VectorXd>(f.state.q, size) = before;
  }
  return Converge(contacts, columns, heavy);
}

// Newton's method from the present state, with the rules above by which its
// result is trusted. `turned` is by how much a node has turned already.
bool EquilibriumSolver::Converge(const std::vector<PointContact>& contacts,
                                 SweepColumns columns, bool heavy,
                                 double turned) {
  return newton_.Converge(contacts, 1, columns) &&
         (heavy ? turned + newton_.turn() < kNear_rad
                : newton_.longest_run() <= kStraightIterations);
}

bool EquilibriumSolver::IsBadLoad(
    const std::vector<PointContact>& contacts) const {
  for (const PointContact& contact : contacts) {
    // Written so that a NaN is bad.
    if (!(contact.arc_mm >= 0 &&
          contact.arc_mm <= BeamLength(model().finger(), contact.side) &&
          std::isfinite(contact.normal_N) && std::isfinite(contact.friction))) {
      return true;
    }
  }
  return false;
}

bool EquilibriumSolver::IsHeavy(
    const std::vector<PointContact>& contacts) const {
  double force = 0;
  for (const PointContact& contact : contacts) {
    force += std::abs(contact.normal_N) * std::hypot(1, contact.friction);
  }
  const double length = model().finger().front_length_mm;
  double softest = std::numeric_limits<double>::infinity();
  for (const Side side : {Side::kFront, Side::kBack}) {
    const auto& ratios = model().mesh(side).stiffness_ratio;
    softest =
        std::min(softest, BendingStiffness(model().finger(), side) *
                              *std::min_element(ratios.begin(), ratios.end()));
  }
  const double wedge =
      std::max(1.0, -std::tan(model().finger().back_angle_rad));
  return force * length * length * std::sqrt(wedge) >
         (model().ribs() > kFewRibs ? kHeavyLoad : kHeavyLoadOfFewRibs) *
             softest;
}

std::string EquilibriumSolver::Why() const {
  if (status_ == SolveStatus::kSolved) return "";
  if (status_ == SolveStatus::kBadLoad) {
    return "a contact lies off its beam or a number is not finite";
  }
  if (status_ == SolveStatus::kRibTooBent) {
    return FormatText(
        "at %.3g %% of this load a rib buckles or becomes 4 %% shorter by "
        "bending, and its equations hold no further",
        100 * path_fraction_);
  }
  return FormatText(
      status_ == SolveStatus::kLimitPoint
          ? "the equilibrium ends at a limit point at %.3g %% of this load: "
            "the finger would snap through"
          : "no equilibrium found under this load (reached %.3g %% of it)",
      100 * path_fraction_);
}

double EquilibriumSolver::rib_tension(int rib) const {
  return newton_.frame().state.q[6 + rib] * newton_.workspace().force_unit();
}

int EquilibriumSolver::unknowns() const {
  const LadderFrame<double>& f = newton_.frame();
  return 6 + f.ribs + 4 * (f.elements - 2);
}

// The units of outputs, of the parameters they are derived by, and of q.
void EquilibriumSolver::OutputUnits() {
  const LadderWorkspace<double>& w = newton_.workspace();
  const int contacts = newton_.frame().contact_count;
  const int m = model().gauges(), r = model().ribs();
  output_unit_.setConstant(m + 3 * contacts + 3, w.length_unit());
  output_unit_.head(m).setOnes();
  for (int c = 0; c <= contacts; ++c) output_unit_[m + 3 * c + 2] = 1;
  const auto& effects = model().effects();
  // The friction coefficient has no unit.
  parameter_unit_.setOnes(2 * contacts + 2 + r + model().effect_columns());
  for (int c = 0; c < contacts; ++c) {
    parameter_unit_[2 * c] = w.length_unit();
    parameter_unit_[2 * c + 1] = w.force_unit();
  }
  parameter_unit_.segment<2>(2 * contacts).setConstant(w.stiffness_unit());
  parameter_unit_.segment(2 * contacts + 2, r).setConstant(w.length_unit());
  for (std::size_t i = 0; i < effects.size(); ++i) {
    parameter_unit_[2 * contacts + 2 + r + static_cast<int>(i)] =
        EffectUnit(effects[i].kind, w);
  }
  q_unit_.setConstant(6 + r, w.force_unit());
  q_unit_[0] = q_unit_[3] = w.moment_unit();
}

// The outputs at the state of the last evaluation, in units of the ladder. With
// `stepped` the changes by Newton's last step, which the taps hold, are added.
void EquilibriumSolver::CollectValues(bool stepped, Eigen::VectorXd* outputs) {
  const LadderFrame<double>& f = newton_.frame();
  OutputUnits();
  const int m = model().gauges();
  outputs->setZero(output_unit_.size());
  const auto change = [&f, stepped](int tap) {
    return stepped ? f.taps[tap * f.stride + f.affine] : 0;
  };
  for (int i = 0; i < f.readout_count; ++i) {
    (*outputs)[f.readouts[i].gauge] +=
        f.readouts[i].sign *
        (f.readout_map[kReadoutValues * i] + change(f.readout_tap(i)));
  }
  for (int c = 0; c < f.contact_count; ++c) {
    const int index = f.contacts[c].index;
    const Eigen::Vector3d value = ContactPose(f, c);
    for (int i = 0; i < 3; ++i) {
      (*outputs)[m + 3 * index + i] =
          value[i] + change(f.contact_tap(index) + i);
    }
  }
  for (int i = 0; i < 3; ++i) {
    (*outputs)[outputs->size() - 3 + i] = f.tip[i] + change(f.tip_tap() + i);
  }
  outputs->array() *= output_unit_.array();
}

// Adds columns of the taps to the rows [gauges, contacts, tip] of `target`.
void EquilibriumSolver::AddTaps(int first, int count, Matrix* target) const {
  const LadderFrame<double>& f = newton_.frame();
  const auto row = [&](int tap) {
    return Eigen::Map<const Eigen::RowVectorXd>(f.taps + tap * f.stride + first,
                                                count);
  };
  for (int i = 0; i < f.readout_count; ++i) {
    target->row(f.readouts[i].gauge) +=
        f.readouts[i].sign * row(f.readout_tap(i));
  }
  for (int i = 0; i < 3 * f.contact_count + 3; ++i) {
    target->row(model().gauges() + i) = row(f.contact_tap(0) + i);
  }
}

bool EquilibriumSolver::Shoot(const Eigen::VectorXd& q,
                              const std::vector<PointContact>& contacts,
                              LadderShot* shot) {
  status_ = SolveStatus::kNotConverged;
  undeformed_ = false;
  trail_.Clear();
  if (!newton_.Shoot(q, contacts) || BendsTooFar(newton_.frame())) {
    Reset();
    return false;
  }
  CollectValues(false, &shot->outputs);
  const LadderFrame<double>& f = newton_.frame();
  const int r = model().ribs(), n = 6 + r;
  const int p = static_cast<int>(parameter_unit_.size());
  Eigen::VectorXd closure_unit(n);
  closure_unit.head(r + 2).setConstant(newton_.workspace().length_unit());
  closure_unit[r + 2] = 1;
  closure_unit[r + 3] = newton_.workspace().moment_unit();
  closure_unit.tail<2>().setConstant(newton_.workspace().force_unit());
  shot->closure = Eigen::Map<const Eigen::VectorXd>(f.closure, n)
                      .cwiseProduct(closure_unit);
  // Column n belongs to the gaps, which are zero here.
  Matrix outputs = Matrix::Zero(shot->outputs.size(), n + 1 + p);
  AddTaps(0, n + 1 + p, &outputs);
  shot->d_outputs.resize(outputs.rows(), n + p);
  shot->d_outputs << outputs.leftCols(n), outputs.rightCols(p);
  shot->d_closure.resize(n, n + p);
  for (int i = 0; i < n; ++i) {
    const Eigen::Map<const Eigen::RowVectorXd> row(
        f.taps + (f.closure_tap() + i) * f.stride, n + 1 + p);
    shot->d_closure.row(i) << row.head(n), row.tail(p);
  }
  Eigen::RowVectorXd column_unit(n + p);
  column_unit << q_unit_.transpose(), parameter_unit_.transpose();
  shot->d_outputs.array().colwise() *= output_unit_.array();
  shot->d_closure.array().colwise() *= closure_unit.array();
  shot->d_outputs.array().rowwise() /= column_unit.array();
  shot->d_closure.array().rowwise() /= column_unit.array();
  return shot->closure.allFinite() && shot->d_closure.allFinite();
}

std::array<std::vector<BeamSpan>, 2> EquilibriumSolver::Spans(
    const std::vector<PointContact>& contacts) const {
  std::array<std::vector<BeamSpan>, 2> spans;
  if (!newton_.Evaluate(contacts)) return spans;
  const LadderFrame<double>& f = newton_.frame();
  const LadderWorkspace<double>& unit = newton_.workspace();
  for (const Side side : {Side::kFront, Side::kBack}) {
    const int i = LadderModel::Index(side);
    const int first = i == 0 ? 0 : f.front_elements;
    const BeamMesh& mesh = model().mesh(side);
    for (int k = 0; k < mesh.elements(); ++k) {
      double arc = mesh.nodes_mm[k];
      const auto add = [&](int slot) {
        spans[i].push_back(
            {arc,
             f.slot_length[slot] * unit.length_unit(),
             f.slot_x[slot] * unit.length_unit(),
             f.slot_y[slot] * unit.length_unit(),
             {f.slot_theta[slot], f.slot_moment[slot] * unit.moment_unit(),
              f.slot_fx[slot] * unit.force_unit(),
              f.slot_fy[slot] * unit.force_unit()},
             f.slot_stiffness[slot] * unit.stiffness_unit(),
             f.slot_axial[slot] / unit.force_unit()});
        arc += spans[i].back().length_mm;
      };
      add(first + k);
      for (int c = 0; c < f.contact_count; ++c) {
        if (f.contacts[c].element == first + k) add(f.elements + c);
      }
    }
  }
  return spans;
}

}  // namespace finray
