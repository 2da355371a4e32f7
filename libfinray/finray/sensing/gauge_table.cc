#include "finray/sensing/gauge_table.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "finray/objects/circle_centre.h"

namespace finray {
namespace {

// Forces in units of EI / l_0^2, which is 0.64 N for the paper's finger. The
// table thus reaches 26 N.
constexpr double kForces[] = {0.5, 1, 2, 4, 7, 11, 16, 22, 30, 40};

// The forces of a row, rising from 0. They end at most_force_N if that is less.
// A slope needs at least three of them.
std::vector<double> Forces(const Finger& finger,
                           const std::optional<double>& most_force_N) {
  constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  const double most = most_force_N.value_or(kUnlimited);
  const double unit = std::min(ForceUnit(finger), most / kForces[2]);
  std::vector<double> forces = {0};
  for (const double force : kForces) {
    forces.push_back(std::min(force * unit, most));
    if (forces.back() == most) break;
  }
  return forces;
}

// Gauss-Newton steps on a cubic, from the nearest point of its chord.
constexpr int kRefinements = 4;

// Every such row shows how wrong its cubics are half way between forces.
constexpr std::size_t kErrorRows = 7;

// Number of valleys that BestStart refines.
constexpr int kValleys = 3;

// The minimum of the parabola through three equally spaced values of which the
// middle one is the least.
double LeastOfParabola(double left, double middle, double right) {
  const double curvature = left - 2 * middle + right;
  if (!(curvature > 0) || std::isinf(curvature)) return middle;
  const double slope = 0.5 * (right - left);
  return std::max(0.0, middle - 0.5 * slope * slope / curvature);
}

Eigen::ArrayXXd Values(const std::vector<GaugeTable::Node>& nodes) {
  Eigen::ArrayXXd values(nodes.size(), nodes[0].values.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    values.row(static_cast<Eigen::Index>(k)) = nodes[k].values.transpose();
  }
  return values;
}

// Sets each node's slope to that of the parabola through it and its neighbours.
void SetSlopes(std::vector<GaugeTable::Node>* nodes) {
  const std::size_t count = nodes->size();
  for (std::size_t k = 0; k < count; ++k) {
    GaugeTable::Node& node = (*nodes)[k];
    node.by_force.setZero(node.values.size());
    if (count < 3) continue;
    const std::size_t middle = std::clamp<std::size_t>(k, 1, count - 2);
    const GaugeTable::Node &a = (*nodes)[middle - 1], &b = (*nodes)[middle],
                           &c = (*nodes)[middle + 1];
    const double ab = b.normal_N - a.normal_N, bc = c.normal_N - b.normal_N;
    const Eigen::VectorXd left = (b.values - a.values) / ab,
                          right = (c.values - b.values) / bc;
    const Eigen::VectorXd curvature = (right - left) / (ab + bc);
    node.by_force =
        left + curvature * (2 * node.normal_N - a.normal_N - b.normal_N);
  }
}

// The values of a contact that the solver holds in equilibrium.
Eigen::VectorXd ValuesOf(const EquilibriumSolver& solver,
                         const std::optional<double>& circle_radius_mm) {
  const int gauges = solver.model().gauges();
  Eigen::VectorXd values(gauges + (circle_radius_mm ? 2 : 0));
  values.head(gauges) = solver.outputs().head(gauges);
  if (circle_radius_mm) {
    values.tail<2>() = CircleCentre(solver.contact_pose(0), *circle_radius_mm);
  }
  return values;
}

// Solves the nodes of one row. The solver must hold the state of the free
// finger.
GaugeTable::Row MakeRow(double arc_mm, const std::vector<double>& forces,
                        double friction,
                        const std::optional<double>& circle_radius_mm,
                        EquilibriumSolver* solver) {
  GaugeTable::Row row{arc_mm, {}, {}};
  for (const double force : forces) {
    // Soft fingers fold over at the heavy end; the table ends there.
    if (!solver->Solve({{arc_mm, force, friction}})) break;
    row.nodes.push_back(
        {force, ValuesOf(*solver, circle_radius_mm), {}, solver->state()});
  }
  if (row.nodes.empty()) return row;
  SetSlopes(&row.nodes);
  row.values = Values(row.nodes);
  return row;
}

// The cubic between two nodes, and its misfit to the measured values.
struct Hermite {
  const GaugeTable::Node &from, &to;
  const Eigen::VectorXd &values, &weights;

  // chi2 at a share of the way, half its first derivative by the share, and
  // half its second derivative in Gauss-Newton's approximation.
  struct Misfit {
    double chi2 = 0, slope = 0, curvature = 0;
  };
  Misfit At(double t) const {
    const double width = to.normal_N - from.normal_N;
    const double u = 1 - t;
    const double h0 = u * u * (1 + 2 * t), h1 = t * t * (3 - 2 * t);
    const double g0 = width * t * u * u, g1 = -width * t * t * u;
    const double d1 = 6 * t * u;
    const double e0 = width * u * (1 - 3 * t), e1 = width * t * (3 * t - 2);
    Misfit misfit;
    for (Eigen::Index j = 0; j < values.size(); ++j) {
      const double w = weights[j];
      if (w == 0) continue;
      const double off =
          w * (h0 * from.values[j] + h1 * to.values[j] + g0 * from.by_force[j] +
               g1 * to.by_force[j] - values[j]);
      const double slope = w * (d1 * (to.values[j] - from.values[j]) +
                                e0 * from.by_force[j] + e1 * to.by_force[j]);
      misfit.chi2 += off * off;
      misfit.slope += off * slope;
      misfit.curvature += slope * slope;
    }
    return misfit;
  }
};

}  // namespace

double GaugeTable::HeaviestForce_N(const Finger& finger) {
  return Forces(finger, {}).back();
}

GaugeTable::GaugeTable(EquilibriumSolver* solver, double friction,
                       std::optional<double> circle_radius_mm,
                       std::optional<double> most_force_N, int threads,
                       int rows)
    : friction_(friction) {
  const Finger& finger = solver->model().finger();
  const double length = finger.front_length_mm;
  const std::vector<double> forces = Forces(finger, most_force_N);
  const int gauges = solver->model().gauges();
  row_spacing_mm_ = length / rows;
  heaviest_N_ = forces.back();
  solver->Reset();
  if (!solver->Solve({})) {
    throw InputError("finger '" + finger.name +
                     "': no equilibrium without load; are the rib lengths "
                     "possible?");
  }
  free_angles_ = solver->outputs().head(gauges);
  const LadderState free_state = solver->state();
  rows_.resize(rows);
  tbb::enumerable_thread_specific<EquilibriumSolver> solvers(*solver);
  tbb::task_arena(std::max(1, threads)).execute([&] {
    tbb::parallel_for(0, rows, [&](int i) {
      EquilibriumSolver& own = solvers.local();
      own.set_state(free_state);
      rows_[i] = MakeRow(length * (i + 0.5) / rows, forces, friction,
                         circle_radius_mm, &own);
    });
  });
  solver->set_state(free_state);
  tip_ = MakeRow(length, forces, friction, circle_radius_mm, solver);
  rows_.erase(std::remove_if(rows_.begin(), rows_.end(),
                             [](const Row& row) { return row.nodes.empty(); }),
              rows_.end());
  FindErrors(solver, circle_radius_mm);
  solver->Reset();
}

void GaugeTable::FindErrors(EquilibriumSolver* solver,
                            const std::optional<double>& circle_radius_mm) {
  errors_.setZero(free_angles_.size() + (circle_radius_mm ? 2 : 0),
                  std::size(kForces));
  for (std::size_t i = kErrorRows / 2; i < rows_.size(); i += kErrorRows) {
    const std::vector<Node>& nodes = rows_[i].nodes;
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
      const Node &from = nodes[k], &to = nodes[k + 1];
      solver->set_state(from.state);
      const double width = to.normal_N - from.normal_N;
      if (!solver->Solve(
              {{rows_[i].arc_mm, from.normal_N + 0.5 * width, friction_}})) {
        continue;
      }
      const Eigen::VectorXd middle =
          0.5 * (from.values + to.values) +
          0.125 * width * (from.by_force - to.by_force);
      const auto chord = static_cast<Eigen::Index>(k);
      errors_.col(chord) = errors_.col(chord).max(
          (middle - ValuesOf(*solver, circle_radius_mm)).array().abs());
    }
  }
}

// Finds the point of a row's chords that is nearest to the measured values.
GaugeTable::OnChord GaugeTable::NearestChord(
    const Row& row, const Eigen::VectorXd& values,
    const Eigen::VectorXd& weights) const {
  // The arrays hold all chords of the row.
  using Chords = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor,
                              std::size(kForces), 1>;
  const auto chords = static_cast<Eigen::Index>(row.nodes.size()) - 1;
  Chords along = Chords::Zero(chords), square = along, misfit = along;
  for (Eigen::Index j = 0; j < values.size(); ++j) {
    const double w = weights[j];
    if (w == 0) continue;
    const auto from = row.values.col(j).head(chords);
    const Chords edge = w * (row.values.col(j).tail(chords) - from);
    const Chords off = w * (values[j] - from);
    along += edge * off;
    square += edge * edge;
    misfit += off * off;
  }
  OnChord nearest;
  for (Eigen::Index k = 0; k < chords; ++k) {
    const double share =
        square[k] > 0 ? std::clamp(along[k] / square[k], 0.0, 1.0) : 0.0;
    const double chi2 =
        std::max(0.0, misfit[k] + share * (share * square[k] - 2 * along[k]));
    if (chi2 < nearest.chi2) {
      nearest = {chi2, static_cast<std::size_t>(k) + 1, share};
    }
  }
  return nearest;
}

// Finds the nearest point of the row's curve of values over force, on the cubic
// above the nearest chord.
ContactStart GaugeTable::Refined(const Row& row, const OnChord& chord,
                                 const Eigen::VectorXd& values,
                                 const Eigen::VectorXd& weights) const {
  ContactStart best;
  best.count = 1;
  best.chi2 = std::numeric_limits<double>::infinity();
  if (chord.to == 0) return best;
  const Node &from = row.nodes[chord.to - 1], &to = row.nodes[chord.to];
  const Hermite cubic{from, to, values, weights};
  double share_of_way = chord.share;
  double t = share_of_way;
  for (int i = 0; i < kRefinements; ++i) {
    const Hermite::Misfit misfit = cubic.At(t);
    if (!(misfit.chi2 < best.chi2)) break;
    best.chi2 = misfit.chi2;
    share_of_way = t;
    if (!(misfit.curvature > 0)) break;
    t = std::clamp(t - misfit.slope / misfit.curvature, 0.0, 1.0);
  }
  best.contacts[0] = {
      row.arc_mm, from.normal_N + share_of_way * (to.normal_N - from.normal_N),
      friction_};
  best.error =
      (errors_.col(static_cast<Eigen::Index>(chord.to) - 1) * weights.array())
          .matrix()
          .norm();
  // The unloaded state does not show how the finger bends under this contact.
  best.state = share_of_way > 0.5 || chord.to == 1 ? &to.state : &from.state;
  return best;
}

ContactStart GaugeTable::BestStart(const Eigen::VectorXd& values,
                                   const Eigen::VectorXd& weights) const {
  std::array<OnChord, kMostRows> chords;
  const int rows = static_cast<int>(rows_.size());
  for (int i = 0; i < rows; ++i) {
    chords[i] = NearestChord(rows_[i], values, weights);
  }
  // Valleys of the misfit to the chords. Chords show every deep valley of the
  // cubics.
  std::array<int, kMostRows> valleys;
  int count = 0;
  for (int i = 0; i < rows; ++i) {
    if ((i == 0 || chords[i].chi2 <= chords[i - 1].chi2) &&
        (i + 1 == rows || chords[i].chi2 < chords[i + 1].chi2)) {
      valleys[count++] = i;
    }
  }
  std::sort(valleys.begin(), valleys.begin() + count,
            [&](int a, int b) { return chords[a].chi2 < chords[b].chi2; });
  ContactStart best;
  best.chi2 = std::numeric_limits<double>::infinity();
  for (int k = 0; k < std::min(count, kValleys); ++k) {
    for (int i = std::max(0, valleys[k] - 1);
         i < std::min(rows, valleys[k] + 2); ++i) {
      const ContactStart start = Refined(rows_[i], chords[i], values, weights);
      if (start.chi2 < best.chi2) best = start;
    }
  }
  return best;
}

const LadderState& GaugeTable::StateNear(double arc_mm, double normal_N) const {
  const auto row = std::min_element(
      rows_.begin(), rows_.end(), [&](const Row& a, const Row& b) {
        return std::abs(a.arc_mm - arc_mm) < std::abs(b.arc_mm - arc_mm);
      });
  return std::min_element(row->nodes.begin(), row->nodes.end(),
                          [&](const Node& a, const Node& b) {
                            return std::abs(a.normal_N - normal_N) <
                                   std::abs(b.normal_N - normal_N);
                          })
      ->state;
}

void GaugeTable::Profile(const Eigen::VectorXd& values,
                         const Eigen::VectorXd& weights,
                         std::vector<ContactStart>* profile) const {
  profile->resize(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    (*profile)[i] = Refined(rows_[i], NearestChord(rows_[i], values, weights),
                            values, weights);
  }
}

void GaugeTable::FindStarts(const std::vector<ContactStart>& profile,
                            std::vector<ContactStart>* starts) {
  const std::size_t rows = profile.size();
  starts->clear();
  for (std::size_t i = 0; i < rows; ++i) {
    if (profile[i].state == nullptr) continue;
    const bool below_left = i == 0 || profile[i].chi2 <= profile[i - 1].chi2;
    const bool below_right =
        i + 1 == rows || profile[i].chi2 < profile[i + 1].chi2;
    if (!below_left || !below_right) continue;
    starts->push_back(profile[i]);
    if (i > 0 && i + 1 < rows) {
      starts->back().chi2 = LeastOfParabola(
          profile[i - 1].chi2, profile[i].chi2, profile[i + 1].chi2);
    }
  }
  std::sort(starts->begin(), starts->end(),
            [](const ContactStart& a, const ContactStart& b) {
              return a.chi2 < b.chi2;
            });
}

}  // namespace finray
