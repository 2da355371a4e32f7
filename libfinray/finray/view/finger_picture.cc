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
constexpr int kTableFrictions = 3;  // where frictions differ

constexpr Side kSides[] = {Side::kFront, Side::kBack};

std::vector<double> Difference(const std::vector<double>& a,
                               const std::vector<double>& b) {
  std::vector<double> difference(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) difference[i] = a[i] - b[i];
  return difference;
}

// Returns the largest distance between the points of `moves`, (x, y) each, and
// the mean of `corners`.
double DistanceFromMean(
    const std::vector<double>& moves,
    const std::vector<const std::vector<double>*>& corners) {
  double most = 0;
  for (std::size_t i = 0; i + 1 < moves.size(); i += 2) {
    double off[2];
    for (std::size_t k = 0; k < 2; ++k) {
      double sum = 0;
      for (const auto* corner : corners) sum += (*corner)[i + k];
      off[k] = moves[i + k] - sum / static_cast<double>(corners.size());
    }
    const double distance = std::hypot(off[0], off[1]);
    if (distance > most) most = distance;  // not if it is NaN
  }
  return most;
}

// Fills a ShapeTable.
class TableMaker {
 public:
  TableMaker(const Finger& finger, const Discretization& discretization,
             const PictureNodes& nodes, ShapeTable* table)
      : nodes_(nodes),
        table_(*table),
        undeformed_(nodes.Undeformed()),
        solver_(finger, discretization),
        states_(table->frictions.size() * kTableArcs, solver_.state()),
        lost_(states_.size(), 0) {}

  // The load grows from state to state. Where a finger has no equilibrium any
  // more, it has none under a larger load.
  void AddForce(std::size_t f) {
    solver_.set_near_only(f > 0);
    for (std::size_t at = 0; at < states_.size(); ++at) {
      solver_.set_state(states_[at]);
      table_.moves_mm.push_back(
          lost_[at] ? none()
                    : Moves(table_.arcs_mm[at % kTableArcs], table_.forces_N[f],
                            table_.frictions[at / kTableArcs]));
      lost_[at] = std::isnan(table_.moves_mm.back().front());
      if (!lost_[at]) states_[at] = solver_.state();
    }
  }
  // Holds the middles of the cells between the last two forces against their
  // corners.
  void CheckCells(std::size_t f) {
    const std::size_t layers = table_.frictions.size();
    for (std::size_t m = 0; m < std::max<std::size_t>(1, layers - 1); ++m) {
      const std::size_t next = std::min(m + 1, layers - 1);
      for (std::size_t a = 0; a + 1 < kTableArcs; ++a) {
        CheckCell(f, m, next, a);
      }
    }
  }

 private:
  std::vector<double> none() const {
    return std::vector<double>(undeformed_.size(), std::nan(""));
  }
  std::vector<double> Moves(double arc_mm, double normal_N, double friction) {
    const std::vector<PointContact> contacts = {{arc_mm, normal_N, friction}};
    return solver_.Solve(contacts)
               ? Difference(nodes_.Places(solver_, contacts), undeformed_)
               : none();
  }
  void CheckCell(std::size_t f, std::size_t m, std::size_t next,
                 std::size_t a) {
    std::vector<const std::vector<double>*> corners;
    for (const std::size_t layer : {m, next}) {
      for (const std::size_t arc : {a, a + 1}) {
        const std::size_t at = layer * kTableArcs + arc;
        if (lost_[at]) return;
        for (const std::size_t force : {f - 1, f}) {
          corners.push_back(&table_.moves_mm[force * states_.size() + at]);
        }
      }
    }
    solver_.set_state(states_[m * kTableArcs + a]);
    const auto middle = [](const std::vector<double>& values, std::size_t i,
                           std::size_t j) {
      return 0.5 * (values[i] + values[j]);
    };
    table_.largest_error_mm =
        std::max(table_.largest_error_mm,
                 DistanceFromMean(Moves(middle(table_.arcs_mm, a, a + 1),
                                        middle(table_.forces_N, f - 1, f),
                                        middle(table_.frictions, m, next)),
                                  corners));
  }

  const PictureNodes& nodes_;
  ShapeTable& table_;
  std::vector<double> undeformed_;
  EquilibriumSolver solver_;
  // By friction, then by arc length: under the last force.
  std::vector<LadderState> states_;
  std::vector<char> lost_;
};

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

std::string PictureNodes::Json() const {
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
      .Add("surface_mm", JsonNumber(finger_.front_surface_mm))
      .Add("undeformed", JsonNumbers(Undeformed()))
      .str();
}

ShapeTable MakeShapeTable(const Finger& finger,
                          const Discretization& discretization,
                          const PictureNodes& nodes, double least_friction,
                          double most_friction, double most_force_N) {
  ShapeTable table;
  const double length = BeamLength(finger, Side::kFront);
  for (int i = 0; i < kTableArcs; ++i) {
    table.arcs_mm.push_back(length * i / (kTableArcs - 1));
  }
  for (int i = 0; i < kTableForces; ++i) {
    table.forces_N.push_back(most_force_N * i / (kTableForces - 1));
  }
  table.frictions = {least_friction};
  for (int i = 1; i < kTableFrictions && most_friction > least_friction; ++i) {
    table.frictions.push_back(least_friction +
                              (most_friction - least_friction) * i /
                                  (kTableFrictions - 1));
  }
  TableMaker maker(finger, discretization, nodes, &table);
  for (std::size_t f = 0; f < table.forces_N.size(); ++f) {
    maker.AddForce(f);
    if (f > 0) maker.CheckCells(f);
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
      .Add("frictions", JsonNumbers(table.frictions))
      .Add("error_mm", JsonNumber(table.largest_error_mm))
      .Add("moves", MovesJson(table.moves_mm))
      .str();
}

}  // namespace finray
