// Which way friction pulls in each row, from how the object moves.

#include <algorithm>
#include <cmath>

#include "finray/calib/problem/parameters.h"
#include "finray/objects/sliding_friction.h"

namespace finray {
namespace {

// A coefficient below this counts as none: sticking would be invisible.
constexpr double kNoFriction = 0.005;
// The step of the coefficient that shows how friction follows it.
constexpr double kStep = 1e-3;
// The slip of a touch near the base is so small that a finger as drawn, with
// ribs that are 0.3 mm off, may have it the wrong way round. The first look
// takes so small a slip for little friction.
constexpr double kFirstPresliding_mm = 0.02;
// Mean change of the tangential share that asks for another solve.
constexpr double kMuch = 0.003;

// The contact of a row at a coefficient: z mu, and z itself.
struct Walk {
  std::optional<double> friction;
  double state = 0;
};

}  // namespace

bool CalibrationParameters::KeepFriction(const Finger& finger, const Plan& plan,
                                         const CalibrationLogs& logs,
                                         const Discretization& discretization) {
  const double coefficient = std::max(0.0, friction());
  if (!plan.scene.presliding_mm || !plan.scene.circle_radius_mm() ||
      !(object_radius_mm > 0) ||
      (!shared.friction_varies && coefficient == 0)) {
    return false;
  }
  RigidObject circle = *plan.scene.object;
  circle.outline = Outline(CircleOutline{object_radius_mm});
  const Finger present = Apply(finger);
  const double presliding_mm =
      std::max(*plan.scene.presliding_mm,
               frictions_.empty() ? kFirstPresliding_mm : 0.0);
  const auto walk = [&](double at) {
    EquilibriumSolver solver(present, discretization);
    SlidingFriction sliding(circle, at, presliding_mm, plan.object_std_mm);
    std::vector<Walk> rows;
    int log = -1;
    for (const CalibrationFrame& frame : logs.frames) {
      Walk row;
      if (frame.log != log || !frame.contact) sliding.Lift();
      log = frame.log;
      if (frame.contact) {
        row.friction = sliding.Next(
            {Stage(frame.log).InS(frame.object_mm), frame.object_angle_rad},
            &solver);
        row.state = sliding.state();
      }
      rows.push_back(row);
    }
    return rows;
  };
  const bool slides = coefficient > kNoFriction;
  const std::vector<Walk> at = walk(slides ? coefficient : 0);
  const std::vector<Walk> beside =
      slides && shared.friction_varies ? walk(coefficient + kStep) : at;
  std::vector<std::vector<RowFriction>> kept(logs.paths.size());
  double change = 0;
  int touched = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const CalibrationFrame& frame = logs.frames[i];
    std::vector<RowFriction>& rows = kept[frame.log];
    if (rows.size() <= static_cast<std::size_t>(frame.row)) {
      rows.resize(frame.row + 1);
    }
    if (!at[i].friction || !beside[i].friction) continue;
    RowFriction& row = rows[frame.row];
    if (slides && shared.friction_varies) {
      row.slope = (*beside[i].friction - *at[i].friction) / kStep;
      row.offset = *at[i].friction - row.slope * coefficient;
    } else {
      row = {0, at[i].state};
    }
    change += std::abs(row.At(coefficient) - FrictionOf(frame).At(coefficient));
    ++touched;
  }
  const bool first = frictions_.empty();
  frictions_ = std::move(kept);
  return touched > 0 && (first || change > kMuch * touched);
}

}  // namespace finray
