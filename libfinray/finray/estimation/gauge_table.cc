#include "finray/estimation/gauge_table.h"

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
#include "finray/io/nan.h"
#include "finray/objects/circle_centre.h"

namespace finray {
namespace {

// Forces in units of EI / l_0^2, which is 0.64 N for the paper's finger. The
// table thus reaches 26 N.
constexpr double kForces[] = {0.5, 1,  2,  4,  7,  9,  11, 13.5,
                              16,  19, 22, 26, 30, 35, 40};

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

// Every such row shows how wrong its cubics are half way between forces.
constexpr std::size_t kErrorRows = 7;

// Moves a start to the minimum of the parabola through chi2 at its row and at
// the rows on either side, which are no better.
void MoveBetweenRows(const ContactStart& below, const ContactStart& above,
                     ContactStart* start) {
  const double curvature = below.chi2 - 2 * start->chi2 + above.chi2;
  if (!(curvature > 0) || std::isinf(curvature)) return;
  const double slope = 0.5 * (above.chi2 - below.chi2);
  const double rows = std::abs(slope) / curvature;  // at most half a row
  const PointContact& towards = (slope > 0 ? below : above).contacts[0];
  PointContact& contact = start->contacts[0];
  if (contact.normal_N == 0) return;  // the free finger
  contact.arc_mm += rows * (towards.arc_mm - contact.arc_mm);
  contact.normal_N += rows * (towards.normal_N - contact.normal_N);
  start->chi2 = std::max(0.0, start->chi2 - 0.5 * rows * std::abs(slope));
}

// Sets each node's slope to that of the parabola through it and its neighbours,
// or through three nodes at an end.
void SetSlopes(std::vector<GaugeTable::Node>* nodes) {
  for (std::size_t k = 0; k < nodes->size(); ++k) {
    GaugeTable::Node& node = (*nodes)[k];
    node.by_force.setZero(node.values.size());
    if (nodes->size() < 3) continue;
    const auto middle = std::clamp<std::size_t>(k, 1, nodes->size() - 2);
    const GaugeTable::Node &a = (*nodes)[middle - 1], &b = (*nodes)[middle],
                           &c = (*nodes)[middle + 1];
    const Eigen::VectorXd left =
                              (b.values - a.values) / (b.normal_N - a.normal_N),
                          right =
                              (c.values - b.values) / (c.normal_N - b.normal_N);
    const double share = (2 * node.normal_N - a.normal_N - b.normal_N) /
                         (c.normal_N - a.normal_N);
    node.by_force = left + share * (right - left);
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
  GaugeTable::Row row{arc_mm, {}};
  for (const double force : forces) {
    // Soft fingers fold over at the heavy end; the table ends there.
    if (!solver->Solve({{arc_mm, force, friction}})) break;
    row.nodes.push_back(
        {force, ValuesOf(*solver, circle_radius_mm), {}, solver->state()});
  }
  SetSlopes(&row.nodes);
  return row;
}

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
  rows_.erase(std::remove_if(rows_.begin(), rows_.end(),
                             [](const Row& row) { return row.nodes.empty(); }),
              rows_.end());
  forces_N_ = forces;
  FindErrors(solver, circle_radius_mm);
  FillCurves();
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

void GaugeTable::FillCurves() {
  const auto values = static_cast<std::size_t>(errors_.rows());
  const auto rows = static_cast<std::size_t>(
      RowCurves::Padded(static_cast<int>(rows_.size())));
  value_.assign(forces_N_.size() * values * rows, std::nan(""));
  by_force_ = value_;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const std::vector<Node>& nodes = rows_[i].nodes;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      for (std::size_t j = 0; j < values; ++j) {
        const std::size_t at = (k * values + j) * rows + i;
        value_[at] = nodes[k].values[static_cast<Eigen::Index>(j)];
        by_force_[at] = nodes[k].by_force[static_cast<Eigen::Index>(j)];
      }
    }
  }
  boxes_ = RowBoxes(Curves());
}

RowCurves GaugeTable::Curves() const {
  return {RowCurves::Padded(static_cast<int>(rows_.size())),
          static_cast<int>(forces_N_.size()),
          static_cast<int>(errors_.rows()),
          forces_N_.data(),
          value_.data(),
          by_force_.data()};
}

template <class Use>
void GaugeTable::ForEachRow(const Eigen::VectorXd& values,
                            const Eigen::VectorXd& weights, double most_chi2,
                            const Use& use) const {
  std::array<double, RowCurves::Padded(kMostRows)> chi2, to, share;
  FindRowMinima(Curves(), boxes_, values.data(), weights.data(), most_chi2,
                {chi2.data(), to.data(), share.data()});
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    use(i, chi2[i], static_cast<int>(to[i]), share[i]);
  }
}

void GaugeTable::SetStart(std::size_t row, int to, double share, double chi2,
                          ContactStart* start) const {
  start->chi2 = std::numeric_limits<double>::infinity();
  start->state = nullptr;
  start->count = to == 0 ? 0 : 1;
  if (to == 0) return;
  const double from_N = forces_N_[to - 1];
  start->chi2 = chi2;
  start->contacts[0] = {rows_[row].arc_mm,
                        from_N + share * (forces_N_[to] - from_N), friction_};
  // The unloaded state does not show how the finger bends under this contact.
  // Shares are as likely large as small, and a branch would often go wrong.
  const int node = std::max(1, to - static_cast<int>(share <= 0.5));
  start->state = &rows_[row].nodes[node].state;
}

void GaugeTable::Profile(const Eigen::VectorXd& values,
                         const Eigen::VectorXd& weights, double most_chi2,
                         std::vector<ContactStart>* profile) const {
  profile->resize(rows_.size());
  // How wrong the cubic of each chord is, in std; NaN until a row asks.
  std::array<double, std::size(kForces)> errors;
  errors.fill(kNaN);
  const auto error = [&](int chord) {
    if (std::isnan(errors[chord])) {
      errors[chord] = (errors_.col(chord) * weights.array()).matrix().norm();
    }
    return errors[chord];
  };
  ForEachRow(values, weights, most_chi2,
             [&](std::size_t row, double chi2, int to, double share) {
               ContactStart& start = (*profile)[row];
               SetStart(row, to, share, chi2, &start);
               start.error = to > 0 ? error(to - 1) : 0;
             });
}

ContactStart GaugeTable::BestStart(const Eigen::VectorXd& values,
                                   const Eigen::VectorXd& weights) const {
  ContactStart best;
  best.chi2 = std::numeric_limits<double>::infinity();
  ForEachRow(values, weights, kAnyChi2,
             [&](std::size_t row, double chi2, int to, double share) {
               if (chi2 < best.chi2) SetStart(row, to, share, chi2, &best);
             });
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
      MoveBetweenRows(profile[i - 1], profile[i + 1], &starts->back());
    }
  }
  std::sort(starts->begin(), starts->end(),
            [](const ContactStart& a, const ContactStart& b) {
              return a.chi2 < b.chi2;
            });
}

}  // namespace finray
