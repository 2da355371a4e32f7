#include "finray/sensing/sensitivity_table.h"

#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"
#include "finray/objects/circle_centre.h"
#include "finray/statics/shape.h"

namespace finray {
namespace {

constexpr int kStencil = 6;  // nodes of a polynomial
using StencilVector = Eigen::Matrix<double, kStencil, 1>;
constexpr double kSpacing = 0.025;  // of l_0, at most
// Forces in units of EI / l_0^2, up to the end of GaugeTable.
constexpr double kGridForces[] = {0, 0.5, 1,  2,  3.5, 5,  7,
                                  9, 12,  16, 20, 25,  32, 40};
// Crowds the nodes of a segment towards its ends, where a polynomial has nodes
// on one side only. 0 spaces them evenly, 1 as the extrema of a Chebyshev
// polynomial.
constexpr double kCrowding = 0.7;
// Nodes at the end of a segment belong to it, not to the next one.
constexpr double kInside = 1e-9;  // of l_0

// Returns both ends of the front beam and the places where derivatives of the
// gauges by l_c have kinks.
std::vector<double> Lines(const Finger& finger) {
  std::vector<double> lines = {0, finger.front_length_mm};
  for (const Rib& rib : finger.ribs) lines.push_back(rib.front_mm);
  for (const StiffnessPiece& piece : finger.front_pieces) {
    lines.push_back(piece.end_mm);
  }
  for (const Gauge& gauge : finger.gauges) {
    if (gauge.beam != Side::kFront) continue;
    lines.push_back(gauge.start_mm);
    lines.push_back(gauge.start_mm + gauge.length_mm);
  }
  std::sort(lines.begin(), lines.end());
  const double least = 1e-6 * finger.front_length_mm;
  lines.erase(
      std::unique(lines.begin(), lines.end(),
                  [least](double a, double b) { return b - a < least; }),
      lines.end());
  return lines;
}

// Place of the k-th of `steps` + 1 nodes between the ends, 0 and 1.
double Crowded(int k, int steps) {
  const double even = static_cast<double>(k) / steps;
  return even + kCrowding * ((1 - std::cos(M_PI * even)) / 2 - even);
}

// Finds kStencil neighbouring nodes around `x` and their weights in the
// interpolating polynomial. node(i) is the i-th of `count` rising nodes.
// Returns the index of the first one used.
template <class Node>
int StencilWeights(double x, int count, const Node& node,
                   StencilVector* weights) {
  int above = 1;
  while (above < count - 1 && node(above) < x) ++above;
  const int first = std::clamp(above - kStencil / 2, 0, count - kStencil);
  for (int i = 0; i < kStencil; ++i) {
    double numerator = 1, denominator = 1;
    for (int j = 0; j < kStencil; ++j) {
      if (j == i) continue;
      numerator *= x - node(first + j);
      denominator *= node(first + i) - node(first + j);
    }
    (*weights)[i] = numerator / denominator;
  }
  return first;
}

// The derivatives of each gauge's angle by its start and its length.
Eigen::MatrixX2d GaugePlaceSlopes(const EquilibriumSolver& solver,
                                  const std::vector<PointContact>& contacts) {
  const Finger& finger = solver.model().finger();
  const Shape shape(solver, contacts);
  Eigen::MatrixX2d slopes(finger.gauges.size(), 2);
  for (Eigen::Index j = 0; j < slopes.rows(); ++j) {
    const Gauge& gauge = finger.gauges[j];
    const auto curvature = [&](double arc_mm) {
      return shape.At(gauge.beam, arc_mm).moment_N_mm /
             BendingStiffness(finger, gauge.beam, arc_mm);
    };
    const double end = curvature(gauge.start_mm + gauge.length_mm);
    slopes.row(j) << end - curvature(gauge.start_mm), end;
  }
  return slopes;
}

}  // namespace

void ReadSensitivities(const EquilibriumSolver& solver,
                       const std::vector<PointContact>& contacts,
                       std::optional<double> circle_radius_mm,
                       bool gauge_places, Eigen::MatrixXd* derivatives) {
  const EquilibriumSolver::Matrix& outputs = solver.d_outputs();
  const int gauges = solver.model().gauges();
  derivatives->setZero(gauges + (circle_radius_mm ? 2 : 0),
                       outputs.cols() + (gauge_places ? 2 : 0));
  derivatives->topLeftCorner(gauges, outputs.cols()) = outputs.topRows(gauges);
  if (gauge_places) {
    derivatives->topRightCorner(gauges, 2) = GaugePlaceSlopes(solver, contacts);
  }
  if (circle_radius_mm) {
    derivatives->bottomLeftCorner(2, outputs.cols()) =
        outputs.middleRows<2>(gauges) +
        CircleCentreByAngle(solver.contact_pose(0)[2], *circle_radius_mm) *
            outputs.row(gauges + 2);
  }
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    derivatives->col(2 * static_cast<int>(c) + 1) *= contacts[c].normal_N;
  }
}

SensitivityTable::SensitivityTable(double friction,
                                   std::optional<double> circle_radius_mm,
                                   EquilibriumSolver* solver, bool gauge_places)
    : gauge_places_(gauge_places),
      node_(solver->model().gauges() + (circle_radius_mm ? 2 : 0),
            4 + solver->model().ribs() + solver->model().effect_columns() +
                (gauge_places ? 2 : 0)) {
  const Finger& finger = solver->model().finger();
  const double length = finger.front_length_mm;
  for (const double force : kGridForces) {
    forces_N_.push_back(force * ForceUnit(finger));
  }
  const std::vector<double> lines = Lines(finger);
  int rows = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const double steps = (lines[i] - lines[i - 1]) / (kSpacing * length);
    segments_.push_back(
        {lines[i], rows, std::max(kStencil, static_cast<int>(steps) + 2)});
    rows += segments_.back().count;
  }
  values_.resize(node_.size(), rows * static_cast<int>(forces_N_.size()));
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const double inside = kInside * length;
    const double start = lines[i] + inside, end = lines[i + 1] - inside;
    const int steps = segments_[i].count - 1;
    for (int k = 0; k <= steps; ++k) {
      AddRow(start + (end - start) * Crowded(k, steps), friction,
             circle_radius_mm, solver);
    }
  }
  solver->Reset();
}

void SensitivityTable::AddRow(double arc_mm, double friction,
                              std::optional<double> circle_radius_mm,
                              EquilibriumSolver* solver) {
  Row row{arc_mm, 0, 0};
  if (!rows_.empty()) row.first = rows_.back().first + rows_.back().count;
  solver->Reset();
  std::vector<PointContact> contacts = {{arc_mm, 0, friction}};
  for (const double force_N : forces_N_) {
    contacts[0].normal_N = force_N;
    // Soft fingers fold over at the heavy end; the row ends there.
    if (!solver->SolveWithSensitivities(contacts)) break;
    ReadSensitivities(*solver, contacts, circle_radius_mm, gauge_places_,
                      &node_);
    values_.col(row.first + row.count) = node_.reshaped();
    ++row.count;
  }
  rows_.push_back(row);
}

bool SensitivityTable::Interpolate(double arc_mm, double normal_N,
                                   Eigen::MatrixXd* derivatives) const {
  const Segment* segment = &segments_[0];
  while (segment != &segments_.back() && arc_mm > segment->end_mm) ++segment;
  StencilVector by_arc, by_force;
  const Row* near = &rows_[segment->first];
  near += StencilWeights(
      arc_mm, segment->count, [near](int i) { return near[i].arc_mm; },
      &by_arc);
  int count = near[0].count;
  for (int i = 1; i < kStencil; ++i) count = std::min(count, near[i].count);
  if (count < kStencil || !(normal_N <= forces_N_[count - 1])) return false;
  const int force = StencilWeights(
      normal_N, count, [this](int i) { return forces_N_[i]; }, &by_force);
  derivatives->resize(rows(), columns());
  Eigen::Map<Eigen::VectorXd> sum(derivatives->data(), values_.rows());
  sum.setZero();
  for (int i = 0; i < kStencil; ++i) {
    sum.noalias() += values_.middleCols<kStencil>(near[i].first + force) *
                     (by_arc[i] * by_force);
  }
  return true;
}

}  // namespace finray
