#include "finray/sensing/gauge_table.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "finray/finger/geometry.h"
#include "finray/io/error.h"

namespace finray {
namespace {

constexpr int kRows = 56;
// Forces in units of EI / l_0^2: 0.64 N for the paper's finger, so to 26 N.
constexpr double kForces[] = {0.5, 1, 2, 4, 7, 11, 16, 22, 30, 40};

}  // namespace

GaugeTable::GaugeTable(EquilibriumSolver* solver) {
  const Finger& finger = solver->model().finger();
  const double length = finger.front_length_mm;
  const double unit = ForceUnit(finger);
  const int gauges = solver->model().gauges();
  heaviest_N_ = unit * *std::rbegin(kForces);
  solver->Reset();
  if (!solver->Solve({})) {
    throw InputError("finger '" + finger.name +
                     "': no equilibrium without load; are the rib lengths "
                     "possible?");
  }
  free_angles_ = solver->outputs().head(gauges);
  free_state_ = solver->state();
  for (int i = 0; i < kRows; ++i) {
    Row row{length * (i + 0.5) / kRows, {}};
    solver->set_state(free_state_);
    for (const double force : kForces) {
      const PointContact contact{row.arc_mm, force * unit, 0};
      // Soft fingers fold over at the heavy end; the table ends there.
      if (!solver->Solve({contact})) break;
      row.nodes.push_back(
          {contact.normal_N, solver->outputs().head(gauges), solver->state()});
    }
    rows_.push_back(std::move(row));
  }
  solver->Reset();
}

void GaugeTable::FindStarts(const Eigen::VectorXd& angles_rad,
                            const Eigen::VectorXd& weight_per_rad,
                            std::vector<Start>* starts) const {
  // Per row: the nearest point of the curve of angles over force, which starts
  // at no load and is taken as straight between nodes.
  std::array<Start, kRows> best;
  for (int i = 0; i < kRows; ++i) {
    const Row& row = rows_[i];
    best[i] = {row.arc_mm, 0,
               0.5 * (angles_rad - free_angles_)
                         .cwiseProduct(weight_per_rad)
                         .squaredNorm(),
               &free_state_};
    for (std::size_t k = 0; k < row.nodes.size(); ++k) {
      const Node& to = row.nodes[k];
      const bool first = k == 0;
      const double from_force = first ? 0 : row.nodes[k - 1].normal_N;
      const Eigen::VectorXd& from =
          first ? free_angles_ : row.nodes[k - 1].angles_rad;
      double along = 0, square = 0;
      for (int j = 0; j < angles_rad.size(); ++j) {
        const double w = weight_per_rad[j];
        const double edge = w * (to.angles_rad[j] - from[j]);
        if (w > 0) along += edge * w * (angles_rad[j] - from[j]);
        square += edge * edge;
      }
      const double share =
          square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
      double cost = 0;
      for (int j = 0; j < angles_rad.size(); ++j) {
        const double w = weight_per_rad[j];
        if (w == 0) continue;
        const double misfit =
            w *
            (from[j] + share * (to.angles_rad[j] - from[j]) - angles_rad[j]);
        cost += 0.5 * misfit * misfit;
      }
      if (cost < best[i].cost) {
        best[i] = {row.arc_mm, from_force + share * (to.normal_N - from_force),
                   cost,
                   share > 0.5 || first ? &to.state : &row.nodes[k - 1].state};
      }
    }
  }
  starts->clear();
  for (int i = 0; i < kRows; ++i) {
    const bool below_left = i == 0 || best[i].cost <= best[i - 1].cost;
    const bool below_right = i + 1 == kRows || best[i].cost < best[i + 1].cost;
    if (below_left && below_right) starts->push_back(best[i]);
  }
  std::sort(starts->begin(), starts->end(),
            [](const Start& a, const Start& b) { return a.cost < b.cost; });
}

}  // namespace finray
