#include <cmath>

#include "finray/calib/calibration_result.h"
#include "finray/finger/geometry.h"
#include "finray/sensing/frame_columns.h"
#include "finray/statics/shape.h"

namespace finray {

FrameTable CalibrationFrames(CalibrationProblem& problem,
                             const CalibrationResult& result) {
  const auto& frames = problem.logs().frames;
  FrameTable table(frames.size());
  for (const char* name : {"log", "kind"}) table.MutableText(name);
  for (const char* name :
       {"row", "time_s", "held_out", "force_N", "force_before_N",
        "force_after_N", "contact_before_mm", "contact_after_mm",
        "force_after_std_N", "contact_after_std_mm", "fit_contact_mm",
        "fit_normal_N"}) {
    table.MutableNumbers(name);
  }
  const int gauges = static_cast<int>(problem.finger().gauges.size());
  for (int j = 0; j < gauges; ++j) {
    table.MutableNumbers(IndexedColumn("gauge_", j, "_residual_std"));
  }
  table.MutableText("status_after");
  table.MutableText("rejected");
  const double per_normal =
      std::hypot(1, problem.plan().scene.friction_coefficient);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const CalibrationFrame& frame = frames[i];
    const auto set = [&](const std::string& name, double value) {
      table.MutableNumbers(name)[i] = value;
    };
    table.MutableText("log")[i] = problem.logs().paths[frame.log];
    table.MutableText("kind")[i] = frame.IsBench() ? "bench"
                                   : frame.contact ? "contact"
                                                   : "free";
    set("row", frame.row + 1);
    set("time_s", frame.time_s);
    set("held_out", frame.held_out);
    set("force_N", ReferenceForce(frame));
    const auto contact = problem.contact(static_cast<int>(i));
    set("fit_contact_mm", contact[0]);
    set("fit_normal_N", contact[1]);
  }
  for (std::size_t k = 0; k < result.checked.size(); ++k) {
    const int i = result.checked[k];
    const ContactEstimate& before = result.forces.before[k].contact[0];
    const ContactEstimate& after = result.forces.after[k].contact[0];
    const auto set = [&](const std::string& name, double value) {
      table.MutableNumbers(name)[i] = value;
    };
    table.MutableText("status_after")[i] =
        StatusName(result.forces.after[k].status);
    if (result.forces.has_before[k]) {
      set("force_before_N", per_normal * before.normal_N);
      set("contact_before_mm", before.arc_mm);
    }
    set("force_after_N", per_normal * after.normal_N);
    set("force_after_std_N", per_normal * after.normal_std_N);
    set("contact_after_mm", after.arc_mm);
    set("contact_after_std_mm", after.arc_std_mm);
  }
  for (const auto& [frame, reason] : problem.rejected()) {
    table.MutableText("rejected")[frame] = reason;
  }
  const Linearization& at = problem.AtSolution();
  for (std::size_t row = 0; row < at.rows.size(); ++row) {
    if (at.rows[row].family != ResidualFamily::kGauge) continue;
    table.MutableNumbers(IndexedColumn("gauge_", at.rows[row].gauge,
                                       "_residual_std"))[at.rows[row].frame] =
        at.residuals[row];
  }
  return table;
}

FrameTable CalibrationShape(CalibrationProblem& problem,
                            const CalibrationResult& result,
                            const Discretization& discretization) {
  constexpr int kPoints = 80;
  std::array<double, 2> heaviest = {std::nan(""), 0};
  for (std::size_t i = 0; i < problem.logs().frames.size(); ++i) {
    const auto contact = problem.contact(static_cast<int>(i));
    if (contact[1] > heaviest[1]) heaviest = contact;
  }
  struct Point {
    std::string state, part;
    double x, y;
  };
  std::vector<Point> points;
  const auto draw = [&](const char* state, const Finger& finger,
                        const std::vector<PointContact>& contacts,
                        bool straight) {
    EquilibriumSolver solver(finger, discretization);
    if (!straight && !solver.Solve(contacts)) return;
    const Shape shape(solver, contacts);
    const auto point = [&](Side side, double arc) {
      if (straight) return UndeformedPoint(finger, side, arc);
      const Section at = shape.At(side, arc);
      return Eigen::Vector2d(at.x_mm, at.y_mm);
    };
    const auto add = [&](const std::string& part, const Eigen::Vector2d& at) {
      points.push_back({state, part, at.x(), at.y()});
    };
    for (const Side side : {Side::kFront, Side::kBack}) {
      for (int k = 0; k <= kPoints; ++k) {
        add(SideName(side),
            point(side, BeamLength(finger, side) * k / kPoints));
      }
    }
    for (std::size_t i = 0; i < finger.ribs.size(); ++i) {
      const std::string part = "rib_" + std::to_string(i + 1);
      add(part, point(Side::kFront, finger.ribs[i].front_mm));
      add(part, point(Side::kBack, finger.ribs[i].back_mm));
    }
    for (const PointContact& contact : contacts) {
      const Section at = shape.At(Side::kFront, contact.arc_mm);
      const Eigen::Vector2d normal(std::sin(at.theta_rad),
                                   -std::cos(at.theta_rad));
      const Eigen::Vector2d place(at.x_mm, at.y_mm);
      add("contact", place);
      add("contact", place - 0.15 * finger.front_length_mm * normal);
    }
  };
  draw("undeformed", problem.finger(), {}, true);
  if (std::isfinite(heaviest[0])) {
    draw(
        "deformed", result.finger,
        {{heaviest[0], heaviest[1], problem.plan().scene.friction_coefficient}},
        false);
  }
  FrameTable table(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    table.MutableText("state")[i] = points[i].state;
    table.MutableText("part")[i] = points[i].part;
    table.MutableNumbers("x_mm")[i] = points[i].x;
    table.MutableNumbers("y_mm")[i] = points[i].y;
  }
  return table;
}

}  // namespace finray
