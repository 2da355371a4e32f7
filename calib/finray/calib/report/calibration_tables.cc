#include <algorithm>
#include <cmath>

#include "finray/calib/report/calibration_result.h"
#include "finray/finger/geometry.h"
#include "finray/scene/frame_columns.h"
#include "finray/statics/shape.h"

namespace finray {

namespace {

// So many rows are made at a time, because the text of a million frames alone
// is large.
constexpr std::size_t kChunk = 20000;

// Makes the rows of frames [first, last). Calls go on from the first frame to
// the last.
class FrameRows {
 public:
  FrameRows(CalibrationProblem& problem, const CalibrationResult& result)
      : problem_(problem),
        result_(result),
        at_(result.solution.at),
        per_normal_(std::hypot(1, problem.plan().scene.friction_coefficient)) {}

  FrameTable Next(std::size_t first, std::size_t last) {
    FrameTable table(last - first);
    AddColumns(&table);
    for (std::size_t i = first; i < last; ++i) {
      const CalibrationFrame& frame = problem_.logs().frames[i];
      const auto set = [&](const std::string& name, double value) {
        table.MutableNumbers(name)[i - first] = value;
      };
      table.MutableText("log")[i - first] = problem_.logs().paths[frame.log];
      table.MutableText("kind")[i - first] = frame.IsBench() ? "bench"
                                             : frame.contact ? "contact"
                                                             : "free";
      set("row", frame.row + 1);
      set("time_s", frame.time_s);
      set("held_out", frame.held_out);
      set("force_N", ReferenceForce(frame));
      const auto contact = result_.solution.contacts[i];
      set("fit_contact_mm", contact[0]);
      set("fit_normal_N", contact[1]);
    }
    AddForces(first, last, &table);
    for (; residual_ < at_.rows.size(); ++residual_) {
      const ResidualInfo& row = at_.rows[residual_];
      const auto frame = static_cast<std::size_t>(row.frame);
      if (frame >= last) break;
      if (row.family != ResidualFamily::kGauge) continue;
      table.MutableNumbers(
          IndexedColumn("gauge_", row.gauge, "_residual_std"))[frame - first] =
          at_.residuals[residual_];
    }
    for (auto it = problem_.rejected().lower_bound(static_cast<int>(first));
         it != problem_.rejected().end() &&
         static_cast<std::size_t>(it->first) < last;
         ++it) {
      table.MutableText("rejected")[it->first - first] = it->second;
    }
    return table;
  }

 private:
  void AddColumns(FrameTable* table) const {
    for (const char* name : {"log", "kind"}) table->MutableText(name);
    for (const char* name :
         {"row", "time_s", "held_out", "force_N", "force_before_N",
          "force_after_N", "contact_before_mm", "contact_after_mm",
          "force_after_std_N", "contact_after_std_mm", "fit_contact_mm",
          "fit_normal_N"}) {
      table->MutableNumbers(name);
    }
    const int gauges = static_cast<int>(problem_.finger().gauges.size());
    for (int j = 0; j < gauges; ++j) {
      table->MutableNumbers(IndexedColumn("gauge_", j, "_residual_std"));
    }
    table->MutableText("status_after");
    table->MutableText("rejected");
  }

  void AddForces(std::size_t first, std::size_t last, FrameTable* table) {
    const ForceCheck& forces = result_.forces;
    for (; checked_ < result_.checked.size(); ++checked_) {
      const auto frame = static_cast<std::size_t>(result_.checked[checked_]);
      if (frame >= last) break;
      const ContactEstimate& before = forces.before[checked_].contact[0];
      const ContactEstimate& after = forces.after[checked_].contact[0];
      const auto set = [&](const char* name, double value) {
        table->MutableNumbers(name)[frame - first] = value;
      };
      table->MutableText("status_after")[frame - first] =
          StatusName(forces.after[checked_].status);
      if (forces.has_before[checked_]) {
        set("force_before_N", per_normal_ * before.normal_N);
        set("contact_before_mm", before.arc_mm);
      }
      set("force_after_N", per_normal_ * after.normal_N);
      set("force_after_std_N", per_normal_ * after.normal_std_N);
      set("contact_after_mm", after.arc_mm);
      set("contact_after_std_mm", after.arc_std_mm);
    }
  }

  CalibrationProblem& problem_;
  const CalibrationResult& result_;
  const Linearization& at_;
  double per_normal_;
  std::size_t residual_ = 0, checked_ = 0;  // the next indices
};

}  // namespace

std::string CalibrationFramesCsv(CalibrationProblem& problem,
                                 const CalibrationResult& result) {
  const std::size_t frames = problem.logs().frames.size();
  FrameRows rows(problem, result);
  std::string csv;
  for (std::size_t first = 0; first < frames; first += kChunk) {
    const FrameTable table = rows.Next(first, std::min(first + kChunk, frames));
    if (first == 0) csv = table.HeaderCsv();
    csv += table.RowsCsv();
  }
  return csv;
}

FrameTable CalibrationShape(CalibrationProblem& problem,
                            const CalibrationResult& result,
                            const Discretization& discretization) {
  constexpr int kPoints = 80;
  std::array<double, 2> heaviest = {std::nan(""), 0};
  for (const auto& contact : result.solution.contacts) {
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
