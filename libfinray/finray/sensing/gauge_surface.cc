#include "finray/sensing/gauge_surface.h"

#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"
#include "finray/sensing/parabola_slope.h"

namespace finray {
namespace {

constexpr int kMostSteps = 30;
// The end of a descent, in l_0 and in the force. A fit goes on from there.
constexpr double kDescended = 1e-5;
// A step is halved at most so often until chi2 falls.
constexpr int kMostHalvings = 6;

// The interval of rising `nodes` that is nearest to `at`.
std::size_t Interval(const std::vector<double>& nodes, double at) {
  const auto next = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, at);
  return static_cast<std::size_t>(next - nodes.begin()) - 1;
}

}  // namespace

// The cubic Hermite polynomials of an interval, for its two ends, with their
// first and second derivatives. `h` belongs to values, `g` to slopes.
struct GaugeSurface::Cubics {
  double h[2][3], g[2][3];

  Cubics(double from, double to, double at) {
    const double width = to - from, per = 1 / width;
    const double t = (at - from) * per, u = 1 - t;
    h[1][0] = t * t * (3 - 2 * t);
    h[1][1] = 6 * t * u * per;
    h[1][2] = (6 - 12 * t) * per * per;
    h[0][0] = 1 - h[1][0];
    h[0][1] = -h[1][1];
    h[0][2] = -h[1][2];
    g[0][0] = width * t * u * u;
    g[0][1] = u * (1 - 3 * t);
    g[0][2] = (6 * t - 4) * per;
    g[1][0] = -width * t * t * u;
    g[1][1] = t * (3 * t - 2);
    g[1][2] = (6 * t - 2) * per;
  }
};

// The polynomials of a cell and its corners; [0] is at the smaller arc, and the
// next force lies values_ behind.
struct GaugeSurface::Cell {
  Cubics along, up;
  const Corner* corners[2];
  std::size_t next;

  Value At(std::size_t j) const {
    // [derivative by arc][corner by force]
    double value[3][2] = {}, slope[3][2] = {};
    for (int a = 0; a < 2; ++a) {
      for (int b = 0; b < 2; ++b) {
        const Corner& c = corners[a][b * next + j];
        for (int d = 0; d < 3; ++d) {
          value[d][b] += along.h[a][d] * c.value + along.g[a][d] * c.by_arc;
          slope[d][b] += along.h[a][d] * c.by_force + along.g[a][d] * c.by_both;
        }
      }
    }
    const auto sum = [&](int by_arc, int by_force) {
      return up.h[0][by_force] * value[by_arc][0] +
             up.h[1][by_force] * value[by_arc][1] +
             up.g[0][by_force] * slope[by_arc][0] +
             up.g[1][by_force] * slope[by_arc][1];
    };
    return {sum(0, 0), sum(1, 0), sum(0, 1), sum(2, 0), sum(1, 1), sum(0, 2)};
  }
};

GaugeSurface::GaugeSurface(const GaugeTable& table, const Finger& finger)
    : length_mm_(finger.front_length_mm), force_unit_N_(ForceUnit(finger)) {
  std::vector<const GaugeTable::Row*> rows;
  for (const GaugeTable::Row& row : table.rows()) rows.push_back(&row);
  rows.push_back(&table.tip());
  std::size_t forces = rows[0]->nodes.size();
  for (const GaugeTable::Row* row : rows) {
    forces = std::min(forces, row->nodes.size());
  }
  if (forces < 3) return;
  const Eigen::VectorXd& free = rows[0]->nodes[0].values;
  values_ = static_cast<std::size_t>(free.size());
  for (std::size_t k = 0; k < forces; ++k) {
    forces_.push_back(rows[0]->nodes[k].normal_N / force_unit_N_);
  }
  // At the clamp no contact bends the finger; where a circle is measured, its
  // centre still moves along the beam.
  if (free.size() == table.free_angles().size()) {
    arcs_.push_back(0);
    for (std::size_t k = 0; k < forces; ++k) {
      for (const double value : free) corners_.push_back({value, 0, 0, 0});
    }
  }
  for (const GaugeTable::Row* row : rows) {
    arcs_.push_back(row->arc_mm / length_mm_);
    for (std::size_t k = 0; k < forces; ++k) {
      const GaugeTable::Node& node = row->nodes[k];
      for (Eigen::Index j = 0; j < node.values.size(); ++j) {
        corners_.push_back(
            {node.values[j], 0, node.by_force[j] * force_unit_N_, 0});
      }
    }
  }
  if (arcs_.size() < 3) {
    forces_.clear();
  } else {
    SetSlopes();
  }
}

void GaugeSurface::SetSlopes() {
  const std::size_t in_row = forces_.size() * values_;
  const auto arc = [&](std::size_t i) { return arcs_[i]; };
  for (std::size_t at = 0; at < corners_.size(); ++at) {
    const auto slope = [&](double Corner::*value) {
      return ParabolaSlope(arcs_.size(), at / in_row, arc, [&](std::size_t i) {
        return corners_[i * in_row + at % in_row].*value;
      });
    };
    corners_[at].by_arc = slope(&Corner::value);
    corners_[at].by_both = slope(&Corner::by_force);
  }
}

GaugeSurface::Cell GaugeSurface::CellAt(double arc, double force) const {
  const std::size_t i = Interval(arcs_, arc), k = Interval(forces_, force);
  const auto at = [&](std::size_t row) {
    return &corners_[(row * forces_.size() + k) * values_];
  };
  return {{arcs_[i], arcs_[i + 1], arc},
          {forces_[k], forces_[k + 1], force},
          {at(i), at(i + 1)},
          values_};
}

GaugeSurface::Value GaugeSurface::At(Eigen::Index j, double arc,
                                     double force) const {
  return CellAt(arc, force).At(static_cast<std::size_t>(j));
}

void GaugeSurface::CurvaturesAt(double arc, double force,
                                GaugeCurvatures* second) const {
  const Cell cell = CellAt(arc, force);
  second->resize(static_cast<Eigen::Index>(values_), 3);
  for (std::size_t j = 0; j < values_; ++j) {
    const Value s = cell.At(j);
    second->row(static_cast<Eigen::Index>(j)) << s.by_arc_arc, s.by_arc_force,
        s.by_force_force;
  }
}

ContactEquations GaugeSurface::EquationsAt(
    const ContactVector& x, const Eigen::VectorXd& values,
    const Eigen::VectorXd& weights) const {
  const Cell cell = CellAt(x[0], x[1]);
  CurvedSums sums;
  for (std::size_t j = 0; j < values_; ++j) {
    const auto row = static_cast<Eigen::Index>(j);
    if (weights[row] == 0) continue;
    const Value s = cell.At(j);
    sums.Add(weights[row], s.value - values[row], s.by_arc, s.by_force,
             s.by_arc_arc, s.by_arc_force, s.by_force_force);
  }
  return sums.Equations();
}

bool GaugeSurface::Descend(const Eigen::VectorXd& values,
                           const Eigen::VectorXd& weights, double most_force_N,
                           ContactStart* start) const {
  const double most = most_force_N / force_unit_N_;
  ContactVector x(2);
  x << start->contacts[0].arc_mm / length_mm_,
      start->contacts[0].normal_N / force_unit_N_;
  if (!Covers(x[1])) return false;
  ContactEquations here = EquationsAt(x, values, weights);
  for (int i = 0; i < kMostSteps; ++i) {
    ContactVector change = BoundedChange(here, x, most, 0);
    if (LargestChange(change, x, 0) < kDescended) {
      start->contacts[0].arc_mm = x[0] * length_mm_;
      start->contacts[0].normal_N = x[1] * force_unit_N_;
      start->chi2 = here.chi2;
      return true;
    }
    ContactEquations there;
    for (int halvings = 0;; ++halvings) {
      if (halvings > kMostHalvings || !Covers(x[1] + change[1])) return false;
      there = EquationsAt(x + change, values, weights);
      if (there.chi2 <= here.chi2) break;
      change *= 0.5;
    }
    x += change;
    here = there;
  }
  return false;
}

}  // namespace finray
