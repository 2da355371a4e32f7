#include <cmath>
#include <utility>

#include "finray/calib/report/calibration_result.h"
#include "finray/finger/geometry.h"
#include "finray/scene/frame_columns.h"
#include "finray/statics/shape.h"

namespace finray {

FrameTable CalibrationFrames(CalibrationProblem& problem,
                             const CalibrationResult& result) {
  const CalibrationLogs& logs = problem.logs();
  FrameTable table(logs.frames.size());
  for (const char* name : {"log", "kind"}) table.MutableText(name);
  for (const char* name :
       {"row", "time_s", "held_out", "force_N", "force_before_N",
        "force_after_N", "contact_before_mm", "contact_after_mm",
        "force_after_std_N", "contact_after_std_mm", "fit_contact_mm",
        "fit_normal_N"}) {
    table.MutableNumbers(name);
  }
  const auto gauges = static_cast<int>(problem.finger().gauges.size());
  for (int j = 0; j < gauges; ++j) {
    table.MutableNumbers(IndexedColumn("gauge_", j, "_residual_std"));
  }
  for (const char* name : {"status_after", "rejected"}) table.MutableText(name);
  const auto fill = [&](const char* name, const auto& value) {
    std::vector<double>& column = table.MutableNumbers(name);
    for (std::size_t i = 0; i < logs.frames.size(); ++i) {
      column[i] = value(logs.frames[i]);
    }
  };
  fill("row", [](const auto& frame) { return frame.row + 1; });
  fill("time_s", [](const auto& frame) { return frame.time_s; });
  fill("held_out", [](const auto& frame) { return frame.held_out; });
  fill("force_N",
       [](const CalibrationFrame& frame) { return frame.Force().magnitude_N; });
  std::vector<std::string>&log = table.MutableText("log"),
  &kind = table.MutableText("kind");
  std::vector<double>&arc_mm = table.MutableNumbers("fit_contact_mm"),
  &normal_N = table.MutableNumbers("fit_normal_N");
  for (std::size_t i = 0; i < logs.frames.size(); ++i) {
    const CalibrationFrame& frame = logs.frames[i];
    log[i] = logs.paths[frame.log];
    kind[i] = frame.IsBench() ? "bench" : frame.contact ? "contact" : "free";
    arc_mm[i] = result.solution.contacts[i][0];
    normal_N[i] = result.solution.contacts[i][1];
  }
  const auto set = [&](int frame, const std::string& name, double value) {
    table.MutableNumbers(name)[frame] = value;
  };
  const double friction = problem.parameters().friction();
  const ForceCheck& forces = result.forces;
  for (std::size_t k = 0; k < forces.frames.size(); ++k) {
    const int frame = forces.frames[k];
    const FrameEstimate& estimate = forces.after[k];
    const FrameEstimate& drawn = forces.before[k];
    const ContactEstimate& before = drawn.contact[0];
    const ContactEstimate& after = estimate.contact[0];
    table.MutableText("status_after")[frame] = StatusName(estimate.status);
    set(frame, "force_before_N", EstimatedForce(drawn, friction));
    set(frame, "contact_before_mm", before.arc_mm);
    set(frame, "force_after_N", EstimatedForce(estimate, friction));
    set(frame, "force_after_std_N", EstimatedForceStd(estimate, friction));
    set(frame, "contact_after_mm", after.arc_mm);
    set(frame, "contact_after_std_mm", after.arc_std_mm);
  }
  std::vector<std::vector<double>*> residual_std;
  for (int j = 0; j < gauges; ++j) {
    residual_std.push_back(
        &table.MutableNumbers(IndexedColumn("gauge_", j, "_residual_std")));
  }
  const Linearization& at = result.solution.at;
  for (std::size_t k = 0; k < at.rows.size(); ++k) {
    if (at.rows[k].family != ResidualFamily::kGauge) continue;
    (*residual_std[at.rows[k].gauge])[at.rows[k].frame] = at.residuals[k];
  }
  for (const auto& [frame, reason] : problem.rejected()) {
    table.MutableText("rejected")[frame] = reason;
  }
  return table;
}

FrameTable CalibrationShape(CalibrationProblem& problem,
                            const CalibrationResult& result) {
  constexpr int kPoints = 80;
  std::array<double, 2> heaviest = {std::nan(""), 0};
  for (const auto& contact : result.solution.contacts) {
    if (contact[1] > heaviest[1]) heaviest = contact;
  }
  std::vector<std::string> states, parts;
  std::vector<double> x_mm, y_mm;
  const auto draw = [&](const char* state, const Finger& finger,
                        const std::vector<PointContact>& contacts,
                        bool straight) {
    EquilibriumSolver solver(finger, problem.discretization());
    if (!straight && !solver.Solve(contacts)) return;
    const Shape shape(solver, contacts);
    const auto point = [&](Side side, double arc) {
      if (straight) return UndeformedPoint(finger, side, arc);
      const Section at = shape.At(side, arc);
      return Eigen::Vector2d(at.x_mm, at.y_mm);
    };
    const auto add = [&](const std::string& part, const Eigen::Vector2d& at) {
      states.push_back(state);
      parts.push_back(part);
      x_mm.push_back(at.x());
      y_mm.push_back(at.y());
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
    draw("deformed", result.finger,
         {{heaviest[0], heaviest[1], problem.parameters().friction()}}, false);
  }
  FrameTable table(states.size());
  table.MutableText("state") = std::move(states);
  table.MutableText("part") = std::move(parts);
  table.MutableNumbers("x_mm") = std::move(x_mm);
  table.MutableNumbers("y_mm") = std::move(y_mm);
  return table;
}

}  // namespace finray
