#include "finray/ladder/ladder_newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "finray/ladder/mesh_refinement.h"

namespace finray {
namespace {

constexpr int kMaxIterations = 30;
constexpr int kMostRefinements = 8;
// A node that turns further than this in one step has left the linear range.
constexpr double kMaxTurn_rad = 0.7;
// Only a step from a residual below this, or from where a small one led, may be
// the last and needs to carry gauges and derivatives.
constexpr double kNearlyThere = 1e-7;
constexpr double kSmallChange = 3e-2;
// Rounding may keep changes below this from shrinking further.
constexpr double kFloor = 1e-6;
// The same of the shape. Stiff ladders without load turn rounding of the shape
// into loads that are nothing but noise.
constexpr double kShapeFloor = 1e-12;
// A start from another load, whose change says nothing of Newton's constant.
constexpr double kFarChange = 0.1;

}  // namespace

LadderNewton::LadderNewton(const Finger& finger,
                           const Discretization& discretization)
    : discretization_(discretization),
      model_(finger, discretization),
      first_mesh_{model_.mesh(Side::kFront), model_.mesh(Side::kBack)},
      workspace_(model_),
      kernel_(&FindLadderKernel(discretization.scheme, Stretches(finger))) {
  Reset();
}

void LadderNewton::Reset() {
  if (refined_) {
    model_.set_mesh(first_mesh_);
    workspace_.SetMesh(model_);
    refined_ = false;
  }
  const LadderFrame<double>& f = frame();
  std::fill_n(f.state.q, 6 + f.ribs, 0.0);
  std::fill_n(f.state.moment, f.elements, 0.0);
  for (const Side side : {Side::kFront, Side::kBack}) {
    const int i = LadderModel::Index(side);
    const BeamMesh& mesh = model_.mesh(side);
    const double unit = workspace_.length_unit();
    const double c = std::cos(f.base_angle[i]), s = std::sin(f.base_angle[i]);
    for (int k = 0; k < mesh.elements(); ++k) {
      const int e = (i == 0 ? 0 : f.front_elements) + k;
      f.state.x[e] = f.base_x[i] + mesh.nodes_mm[k] / unit * c;
      f.state.y[e] = mesh.nodes_mm[k] / unit * s;
      f.state.theta[e] = f.base_angle[i];
    }
  }
}

void LadderNewton::Load(const LadderState& state) {
  if (state.q.size() != model_.unknowns() || state.nodes[0].cols() == 0 ||
      state.nodes[1].cols() == 0) {
    throw InputError("the state is not one of finger '" + model_.finger().name +
                     "'");
  }
  bool same = true;
  for (const Side side : {Side::kFront, Side::kBack}) {
    const auto& nodes = state.nodes[LadderModel::Index(side)];
    const std::vector<double>& mesh = model_.mesh(side).nodes_mm;
    same &= nodes.cols() + 1 == static_cast<Eigen::Index>(mesh.size());
    for (Eigen::Index k = 0; same && k < nodes.cols(); ++k) {
      same = nodes(0, k) == mesh[k];
    }
  }
  if (!same) {
    model_.set_mesh(MeshOfState(model_, state));
    workspace_.SetMesh(model_);
    refined_ = true;
  }
  workspace_.Load(state);
}

bool LadderNewton::SetLoad(const std::vector<PointContact>& contacts,
                           double fraction, SweepColumns columns, bool open) {
  do {
    if (!workspace_.SetContacts(model_, contacts, fraction)) return false;
    // More memory may have to be taken once.
  } while (workspace_.SetColumns(model_, columns, open));
  workspace_.SetFinger(model_, fraction);
  return true;
}

bool LadderNewton::Converge(const std::vector<PointContact>& contacts,
                            double fraction, SweepColumns columns) {
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
    if (change != MeshChange::kRefined) return change == MeshChange::kNone;
  }
  return false;
}

bool LadderNewton::ConvergeOnMesh(const std::vector<PointContact>& contacts,
                                  double fraction, SweepColumns columns) {
  if (!SetLoad(contacts, fraction, columns, false)) return false;
  LadderFrame<double>& f = workspace_.frame();
  double load = 1;
  for (int c = 0; c < f.contact_count; ++c) {
    load += std::abs(f.contacts[c].normal);
  }
  double last_change = 0, best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaxIterations; ++i) {
    ++iterations_;
    kernel_->evaluate(f, columns, false);
    const double residual = f.residual;
    if (!std::isfinite(residual)) return false;
    const bool maybe_last =
        residual < kNearlyThere * load || (i > 0 && last_change < kSmallChange);
    const SweepColumns now = maybe_last ? columns : SweepColumns::kNone;
    workspace_.SetColumns(model_, now, false);
    if (!kernel_->sweep(f, now, maybe_last)) return false;
    const double size = Size(1, 0);
    if (!std::isfinite(size)) return false;
    // Newton may climb for a while; it does not come back from far above.
    best = std::min(best, residual);
    if (i > 8 && residual > 1e3 * best && size > kFloor) return false;
    Move(std::min(1.0, kMaxTurn_rad / size), 0);
    const double change = std::max(size, LoadChange());
    if (maybe_last && IsConverged(i, size, change, last_change)) return true;
    last_change = change;
  }
  return false;
}

// Newton squares errors: what the change promises for the next one, or what the
// last two do, is to be below the tolerance.
bool LadderNewton::IsConverged(int iteration, double size, double change,
                               double last_change) const {
  if (1e4 * change * change < tolerance_) return true;
  if (iteration == 0) return false;
  const double ratio = change / last_change;
  const double next = change * ratio * (last_change > kFarChange ? 1 : ratio);
  const bool rounding = change < kFloor || size < kShapeFloor;
  return next < tolerance_ || (rounding && ratio > 0.5);
}

// The step in base loads and tensions over the largest of them. The finger
// without load has none but rounding.
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
  if (!SetLoad(contacts, 1, SweepColumns::kNone, false)) return false;
  kernel_->evaluate(workspace_.frame(), SweepColumns::kNone, false);
  return std::isfinite(frame().residual);
}

bool LadderNewton::Linearize(const std::vector<PointContact>& contacts,
                             double fraction) {
  if (!SetLoad(contacts, fraction, SweepColumns::kLoad, false)) return false;
  LadderFrame<double>& f = workspace_.frame();
  ++iterations_;
  kernel_->evaluate(f, SweepColumns::kLoad, false);
  if (!std::isfinite(f.residual)) return false;
  return kernel_->sweep(f, SweepColumns::kLoad, false);
}

bool LadderNewton::LinearizeByContacts(
    const std::vector<PointContact>& contacts) {
  static_assert(7 + 2 * kFittedContacts <= kMostNodeColumns);
  if (contacts.size() > kFittedContacts) return false;
  if (!SetLoad(contacts, 1, SweepColumns::kContacts, false)) return false;
  LadderFrame<double>& f = workspace_.frame();
  ++iterations_;
  kernel_->evaluate(f, SweepColumns::kContacts, false);
  if (!std::isfinite(f.residual)) return false;
  return kernel_->sweep(f, SweepColumns::kContacts, true);
}

void LadderNewton::StepWithContacts(double newton, const double* change) {
  LadderFrame<double>& f = workspace_.frame();
  std::copy_n(change, 2 * f.contact_count, f.change);
  f.newton = newton;
  kernel_->combine(f);
}

void LadderNewton::Move(double a, double b) {
  const LadderFrame<double>& f = frame();
  // The five fields of a state lie one behind the other.
  const int count = 6 + f.ribs + 4 * f.elements;
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
  if (!discretization_.adaptive()) return MeshChange::kNone;
  const LadderFrame<double>& f = frame();
  double worst = 0;
  for (int slot = 0; slot < f.slots(); ++slot) {
    worst = std::max(worst, f.truncation[slot]);
  }
  if (worst < kRefinedTruncation_rad) return MeshChange::kNone;
  std::array<BeamMesh, 2> finer;
  LadderState state;
  if (!RefineToSeries(model_, workspace_, discretization_.scheme, &finer,
                      &state)) {
    return MeshChange::kTooFine;
  }
  model_.set_mesh(finer);
  workspace_.SetMesh(model_);
  workspace_.Load(state);
  refined_ = true;
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
  f.state.moment[0] = f.state.q[0];
  f.state.moment[f.front_elements] = f.state.q[3];
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
