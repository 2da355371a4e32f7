#include "finray/ladder/ladder_newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "finray/ladder/lanes.h"
#include "finray/ladder/mesh_refinement.h"

namespace finray {
namespace {

constexpr int kMaxIterations = 30;
constexpr int kMostRefinements = 8;
// A node that turns further than this in one step has left the linear range.
constexpr double kMaxTurn_rad = 0.7;
// A step may be the last if it starts from a residual below kNearlyThere, or
// below the change that the tolerance allows, or if it follows a change below
// kSmallChange. Only such a step needs to carry gauges and derivatives.
constexpr double kNearlyThere = 1e-7;
constexpr double kSmallChange = 3e-2;
// Rounding may keep changes below this from shrinking further.
constexpr double kFloor = 1e-6;
// The same for the shape. Stiff ladders without load turn rounding of the shape
// into loads that are pure noise.
constexpr double kShapeFloor = 1e-12;
// A larger change comes from a start at another load and says nothing about the
// constant of Newton's convergence.
constexpr double kFarChange = 0.1;

}  // namespace

LadderNewton::LadderNewton(const Finger& finger,
                           const Discretization& discretization)
    : discretization_(discretization),
      model_(finger, discretization),
      undeformed_(LadderState::Undeformed(model_)),
      workspace_(model_),
      kernel_(&FindLadderKernel(discretization.scheme, Stretches(finger))) {
  Reset();
}

void LadderNewton::Reset() {
  Load(undeformed_);
  if (model_.moves_nodes()) workspace_.Load(LadderState::Undeformed(model_));
}

void LadderNewton::Load(const LadderState& state) {
  tangent_of_.clear();
  if (state.q.size() != model_.unknowns() || state.nodes[0].cols() == 0 ||
      state.nodes[1].cols() == 0) {
    throw InputError("the state is not one of finger '" + model_.finger().name +
                     "'");
  }
  if (!state.IsOnMeshOf(model_)) {
    std::array<BeamMesh, 2> mesh;
    if (!MeshOfState(model_, state, &mesh)) {
      workspace_.SetMesh(model_);
      workspace_.Load(LadderState::Undeformed(model_));
      return;
    }
    model_.set_mesh(mesh);
    workspace_.SetMesh(model_);
  }
  workspace_.Load(state);
}

bool LadderNewton::SetLoad(const std::vector<PointContact>& contacts,
                           double fraction, SweepColumns columns, bool open) {
  tangent_of_.clear();
  if (!workspace_.SetContacts(model_, contacts, fraction, columns, open)) {
    return false;
  }
  workspace_.SetFinger(model_, fraction);
  return true;
}

bool LadderNewton::Converge(const std::vector<PointContact>& contacts,
                            double fraction, SweepColumns columns) {
  if (columns == SweepColumns::kContacts && contacts.size() > kFittedContacts) {
    return false;
  }
  const LadderFrame<double>& f = frame();
  turn_ = 0;
  longest_run_ = 0;
  for (int i = 0; i < kMostRefinements; ++i) {
    const int before = iterations_;
    angles_before_.assign(f.state.theta, f.state.theta + f.elements);
    if (!ConvergeOnMesh(contacts, fraction, columns)) return false;
    double turn = 0;
    for (int e = 0; e < f.elements; ++e) {
      turn = std::max(turn, std::abs(f.state.theta[e] - angles_before_[e]));
    }
    turn_ += turn;
    longest_run_ = std::max(longest_run_, iterations_ - before);
    const MeshChange change = RefineMesh();
    if (change == MeshChange::kRefined) continue;
    if (columns == SweepColumns::kContacts) tangent_of_ = contacts;
    return change == MeshChange::kNone;
  }
  return false;
}

bool LadderNewton::ConvergeOnMesh(const std::vector<PointContact>& contacts,
                                  double fraction, SweepColumns columns) {
  if (!SetLoad(contacts, fraction, columns)) return false;
  LadderFrame<double>& f = workspace_.frame();
  double load = 1;
  for (int c = 0; c < f.contact_count; ++c) {
    load += std::abs(f.contacts[c].normal);
  }
  const double near =
      load * std::max(kNearlyThere, 0.01 * std::sqrt(tolerance_));
  double last_change = 0, best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaxIterations; ++i) {
    ++iterations_;
    kernel_->evaluate(f, columns, false);
    const double residual = f.residual;
    if (!std::isfinite(residual)) return false;
    const bool maybe_last =
        residual < near || (i > 0 && last_change < kSmallChange);
    const SweepColumns now = maybe_last ? columns : SweepColumns::kNone;
    workspace_.SetColumns(now, false);
    if (!kernel_->sweep(f, now, maybe_last)) return false;
    if (now == SweepColumns::kContacts) {
      std::fill_n(f.change, 2 * f.contact_count, 0);
      f.newton = 1;
      kernel_->combine(f);
    }
    const double size = Size(1, 0);
    if (!std::isfinite(size)) return false;
    // The residual may grow for a while, but from far above Newton does not
    // come back.
    best = std::min(best, residual);
    if (i > 8 && residual > 1e3 * best && size > kFloor) return false;
    Move(std::min(1.0, kMaxTurn_rad / size), 0);
    const double change = std::max(size, LoadChange());
    if (maybe_last && IsConverged(i, size, change, last_change)) return true;
    last_change = change;
  }
  return false;
}

// Newton squares errors. It has converged if the next change, as predicted from
// this one or from the last two, is below the tolerance.
bool LadderNewton::IsConverged(int iteration, double size, double change,
                               double last_change) const {
  if (1e4 * change * change < tolerance_) return true;
  if (iteration == 0) return false;
  const double ratio = change / last_change;
  const double next = change * ratio * (last_change > kFarChange ? 1 : ratio);
  const bool rounding = change < kFloor || size < kShapeFloor;
  return next < tolerance_ || (rounding && ratio > 0.5);
}

// The largest change of a base load or tension over the largest of them. In a
// finger without load they are pure rounding, so kNoLoad is added.
double LadderNewton::LoadChange() const {
  const LadderFrame<double>& f = frame();
  double step = 0, load = 0;
  for (int i = 0; i < 6 + f.ribs; ++i) {
    step = std::max(step, std::abs(f.step.q[i]));
    load = std::max(load, std::abs(f.state.q[i]));
  }
  constexpr double kNoLoad = 1e-5;
  return step / (load + kNoLoad);
}

bool LadderNewton::Evaluate(const std::vector<PointContact>& contacts) {
  if (!SetLoad(contacts, 1, SweepColumns::kNone)) return false;
  kernel_->evaluate(workspace_.frame(), SweepColumns::kNone, false);
  return std::isfinite(frame().residual);
}

bool LadderNewton::FollowTangent(const std::vector<PointContact>& contacts) {
  static_assert(7 + 2 * kFittedContacts <= kMostNodeColumns);
  if (tangent_of_.empty() || tangent_of_.size() != contacts.size()) {
    return false;
  }
  LadderFrame<double>& f = workspace_.frame();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const PointContact &to = contacts[c], &from = tangent_of_[c];
    if (to.side != from.side) return false;
    f.change[2 * c] = (to.arc_mm - from.arc_mm) / workspace_.length_unit();
    f.change[2 * c + 1] =
        (to.normal_N - from.normal_N) / workspace_.force_unit();
  }
  f.newton = 0;
  kernel_->combine(f);
  if (!(Size(1, 0) < kMaxTurn_rad)) return false;
  Move(1, 0);
  tangent_of_.clear();
  return true;
}

bool LadderNewton::Linearize(const std::vector<PointContact>& contacts,
                             double fraction) {
  if (!SetLoad(contacts, fraction, SweepColumns::kLoad)) return false;
  LadderFrame<double>& f = workspace_.frame();
  ++iterations_;
  kernel_->evaluate(f, SweepColumns::kLoad, false);
  return std::isfinite(f.residual) &&
         kernel_->sweep(f, SweepColumns::kLoad, false);
}

void LadderNewton::Move(double a, double b) {
  const LadderFrame<double>& f = frame();
  const int count = f.state_size();
  double* z = f.state.q;
  const double* step = f.step.q;
  for (int i = 0; i < count; ++i) z[i] += a * step[i];
  if (b == 0) return;
  const double* by_load = f.by_load.q;
  for (int i = 0; i < count; ++i) z[i] += b * by_load[i];
}

double LadderNewton::Size(double a, double b) const {
  const LadderFrame<double>& f = frame();
  // x, y and theta of all nodes
  const double* step = f.step.x;
  const double* by_load = f.by_load.x;
  double largest = 0;
  for (int i = 0; i < 3 * f.elements; ++i) {
    const double size =
        std::abs(b == 0 ? a * step[i] : a * step[i] + b * by_load[i]);
    largest = Larger(largest, size);
  }
  return largest;
}

MeshChange LadderNewton::RefineMesh() {
  if (!discretization_.adaptive() || IsResolved(frame())) {
    return MeshChange::kNone;
  }
  std::array<BeamMesh, 2> finer;
  LadderState state;
  if (!RefineToSeries(model_, workspace_, discretization_.scheme, &finer,
                      &state)) {
    return MeshChange::kTooFine;
  }
  model_.set_mesh(finer);
  workspace_.SetMesh(model_);
  workspace_.Load(state);
  return MeshChange::kRefined;
}

bool LadderNewton::Shoot(const Eigen::VectorXd& q,
                         const std::vector<PointContact>& contacts) {
  if (!SetLoad(contacts, 1, SweepColumns::kParameters, true)) return false;
  LadderFrame<double>& f = workspace_.frame();
  for (int i = 0; i < 6 + f.ribs; ++i) {
    const bool moment = i == 0 || i == 3;
    f.state.q[i] =
        q[i] / (moment ? workspace_.moment_unit() : workspace_.force_unit());
  }
  workspace_.SetBases();
  kernel_->evaluate(f, SweepColumns::kParameters, true);
  if (!std::isfinite(f.residual)) return false;
  kernel_->open_sweep(f, SweepColumns::kParameters);
  return true;
}

int LadderNewton::TakeIterations() {
  const int taken = iterations_;
  iterations_ = 0;
  return taken;
}

}  // namespace finray
