#include "finray/view/finger_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/finger/geometry.h"
#include "finray/statics/shape.h"
#include "finray/view/channel.h"
#include "finray/view/json_text.h"

namespace finray {
namespace {

constexpr int kNodes = 20;      // evenly spaced ones of a beam
constexpr int kTableArcs = 57;  // 2.5 mm apart on a beam of 140 mm
constexpr int kTableForces = 25;

constexpr Side kSides[] = {Side::kFront, Side::kBack};

std::vector<double> Difference(const std::vector<double>& a,
                               const std::vector<double>& b) {
  std::vector<double> difference(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) difference[i] = a[i] - b[i];
  return difference;
}

// Returns the largest distance between the points of `moves`, (x, y) each, and
// the mean of four others.
double DistanceFromMean(const std::vector<double>& moves,
                        const std::vector<double>* const (&corners)[4]) {
  double most = 0;
  for (std::size_t i = 0; i + 1 < moves.size(); i += 2) {
    double off[2];
    for (std::size_t k = 0; k < 2; ++k) {
      double mean = 0;
      for (const auto* corner : corners) mean += 0.25 * (*corner)[i + k];
      off[k] = moves[i + k] - mean;
    }
    const double distance = std::hypot(off[0], off[1]);
    if (distance > most) most = distance;  // not if it is NaN
  }
  return most;
}

}  // namespace

PictureNodes::PictureNodes(const Finger& finger) : finger_(finger) {
  for (const Side side : kSides) {
    std::vector<double>& arcs = arcs_mm_[static_cast<int>(side)];
    const double length = BeamLength(finger, side);
    for (const Rib& rib : finger.ribs) arcs.push_back(HingePlace(rib, side));
    // An even node that is almost a hinge would only bend the drawn line.
    for (int i = 0; i <= kNodes; ++i) {
      const double arc = length * i / kNodes;
      const bool taken = std::any_of(
          finger.ribs.begin(), finger.ribs.end(), [&](const Rib& rib) {
            return std::abs(HingePlace(rib, side) - arc) <
                   0.2 * length / kNodes;
          });
      if (!taken || i == 0 || i == kNodes) arcs.push_back(arc);
    }
    std::sort(arcs.begin(), arcs.end());
  }
}

std::vector<double> PictureNodes::Places(
    const EquilibriumSolver& solver,
    const std::vector<PointContact>& contacts) const {
  const Shape shape(solver, contacts);
  std::vector<double> places;
  places.reserve(2 * size());
  for (const Side side : kSides) {
    for (const double arc : arcs_mm_[static_cast<int>(side)]) {
      const Section section = shape.At(side, arc);
      places.push_back(section.x_mm);
      places.push_back(section.y_mm);
    }
  }
  return places;
}

std::vector<double> PictureNodes::Undeformed() const {
  std::vector<double> places;
  for (const Side side : kSides) {
    for (const double arc : arcs_mm_[static_cast<int>(side)]) {
      const Eigen::Vector2d point = UndeformedPoint(finger_, side, arc);
      places.push_back(point.x());
      places.push_back(point.y());
    }
  }
  return places;
}

std::string PictureNodes::Json(double friction) const {
  JsonArray ribs, gauges;
  const auto node = [&](const Rib& rib, Side side) {
    const auto& arcs = arcs_mm_[static_cast<int>(side)];
    return std::to_string(
        std::lower_bound(arcs.begin(), arcs.end(), HingePlace(rib, side)) -
        arcs.begin());
  };
  for (const Rib& rib : finger_.ribs) {
    ribs.Add("[" + node(rib, Side::kFront) + "," + node(rib, Side::kBack) +
             "]");
  }
  for (const Gauge& gauge : finger_.gauges) {
    gauges.Add(JsonObject()
                   .Add("beam", JsonText(SideName(gauge.beam)))
                   .Add("start", JsonNumber(gauge.start_mm))
                   .Add("end", JsonNumber(gauge.start_mm + gauge.length_mm))
                   .str());
  }
  return JsonObject()
      .Add("name", JsonText(finger_.name))
      .Add("front", JsonNumbers(arcs_mm_[0]))
      .Add("back", JsonNumbers(arcs_mm_[1]))
      .Add("ribs", ribs.str())
      .Add("gauges", gauges.str())
      .Add("friction", JsonNumber(friction))
      .Add("surface_mm", JsonNumber(finger_.front_surface_mm))
      .Add("undeformed", JsonNumbers(Undeformed()))
      .str();
}

ShapeTable MakeShapeTable(const Finger& finger,
                          const Discretization& discretization,
                          const PictureNodes& nodes, double friction,
                          double most_force_N) {
  ShapeTable table;
  const double length = BeamLength(finger, Side::kFront);
  for (int i = 0; i < kTableArcs; ++i) {
    table.arcs_mm.push_back(length * i / (kTableArcs - 1));
  }
  for (int i = 0; i < kTableForces; ++i) {
    table.forces_N.push_back(most_force_N * i / (kTableForces - 1));
  }
  EquilibriumSolver solver(finger, discretization);
  const std::vector<double> undeformed = nodes.Undeformed();
  const std::vector<double> none(undeformed.size(), std::nan(""));
  const auto moves_at = [&](double arc_mm, double normal_N) {
    const std::vector<PointContact> contacts = {{arc_mm, normal_N, friction}};
    return solver.Solve(contacts)
               ? Difference(nodes.Places(solver, contacts), undeformed)
               : none;
  };
  // The load grows at each arc length from state to state. Where a finger has
  // no equilibrium any more, it has none under a larger load.
  std::vector<LadderState> states(kTableArcs, solver.state());
  std::vector<char> lost(kTableArcs, 0);
  for (int f = 0; f < kTableForces; ++f) {
    solver.set_near_only(f > 0);
    for (std::size_t a = 0; a < kTableArcs; ++a) {
      solver.set_state(states[a]);
      table.moves_mm.push_back(
          lost[a] ? none : moves_at(table.arcs_mm[a], table.forces_N[f]));
      lost[a] = std::isnan(table.moves_mm.back().front());
      if (!lost[a]) states[a] = solver.state();
    }
    for (std::size_t a = 0; f > 0 && a + 1 < kTableArcs; ++a) {
      if (lost[a] || lost[a + 1]) continue;
      const auto* const corner =
          &table.moves_mm[static_cast<std::size_t>(f - 1) * kTableArcs + a];
      const std::vector<double>* const corners[4] = {
          corner, corner + 1, corner + kTableArcs, corner + kTableArcs + 1};
      solver.set_state(states[a]);
      table.largest_error_mm = std::max(
          table.largest_error_mm,
          DistanceFromMean(
              moves_at(0.5 * (table.arcs_mm[a] + table.arcs_mm[a + 1]),
                       0.5 * (table.forces_N[f - 1] + table.forces_N[f])),
              corners));
    }
  }
  return table;
}

std::string MovesJson(const std::vector<std::vector<double>>& moves_mm) {
  ChannelScale scale;
  scale.low = std::numeric_limits<double>::infinity();
  scale.high = -scale.low;
  for (const auto& moves : moves_mm) {
    for (const double move : moves) {
      if (std::isnan(move)) continue;
      scale.low = std::min(scale.low, move);
      scale.high = std::max(scale.high, move);
    }
  }
  if (scale.low > scale.high) scale.low = scale.high = 0;
  std::vector<std::uint16_t> codes;
  for (const auto& moves : moves_mm) {
    for (const double move : moves) codes.push_back(scale.Code(move));
  }
  return JsonObject()
      .Add("low", JsonNumber(scale.low))
      .Add("high", JsonNumber(scale.high))
      .Add("codes", '"' + PackCodes(codes, scale.bits) + '"')
      .str();
}

std::string ShapeTableJson(const ShapeTable& table) {
  return JsonObject()
      .Add("arcs", JsonNumbers(table.arcs_mm))
      .Add("forces", JsonNumbers(table.forces_N))
      .Add("error_mm", JsonNumber(table.largest_error_mm))
      .Add("moves", MovesJson(table.moves_mm))
      .str();
}

}  // namespace finray
