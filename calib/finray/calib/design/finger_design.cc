#include "finray/calib/design/finger_design.h"

#include <algorithm>
#include <cmath>

#include "finray/calib/design/planned_recording.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/finger/geometry.h"
#include "finray/io/number_text.h"
#include "finray/scene/frame_columns.h"

namespace finray {
namespace {

constexpr double kUsualLoads = 10, kMostLoads = 40;          // EI / l_0^2
constexpr double kOneStep = 1.0 / 56, kPairStep = 1.0 / 14;  // of l_0
constexpr double kLeastDistance = 0.2;  // of two contacts, of l_0

void AddAccuracy(const std::vector<PointContact>& contacts,
                 ContactAccuracy* accuracy, std::size_t row,
                 FrameTable* table) {
  const ContactStd std = accuracy->At(contacts);
  for (int c = 0; c < static_cast<int>(contacts.size()); ++c) {
    table->MutableNumbers(ContactArc(c))[row] = contacts[c].arc_mm;
    table->MutableNumbers(NormalForce(c))[row] = contacts[c].normal_N;
    table->MutableNumbers(ContactArcStd(c))[row] = std.total[2 * c];
    table->MutableNumbers(NormalForceStd(c))[row] = std.total[2 * c + 1];
    const auto text = [](double value) {
      return std::isfinite(value) ? NumberText(value) : "";
    };
    table->MutableText(IndexedColumn("contact_", c, "_noise_mm"))[row] =
        text(std.noise[2 * c]);
    table->MutableText(IndexedColumn("normal_", c, "_noise_N"))[row] =
        text(std.noise[2 * c + 1]);
  }
}

}  // namespace

Finger AfterCalibration(const Finger& finger,
                        const FutureCalibration& calibration, double normal_N,
                        const Discretization& discretization) {
  if (!calibration.plan) return finger;
  const double most_N = std::max(normal_N, kUsualLoads * ForceUnit(finger));
  const ContactRange range{0.1 * finger.front_length_mm,
                           0.9 * finger.front_length_mm, 0.1 * most_N, most_N};
  return PlannedRecording(finger, *calibration.plan,
                          SpreadContacts(range, calibration.frames, 1),
                          discretization)
      .Calibrated();
}

std::vector<double> UntoldHeights(const Finger& finger,
                                  const std::vector<double>& heights_mm,
                                  double normal_N, double friction,
                                  const Discretization& discretization) {
  Scene scene;
  scene.contacts = 1;
  scene.friction_coefficient = friction;
  scene.force_max_N = std::max(normal_N, kMostLoads * ForceUnit(finger));
  FrameEstimator estimator(finger, scene, discretization);
  EquilibriumSolver solver(finger, discretization);
  std::vector<double> untold;
  for (const double height : heights_mm) {
    solver.Reset();
    Measurements exact;
    if (solver.Solve({{height, normal_N, friction}})) {
      for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
        exact.gauges_V.push_back(
            finger.gauges[j].Volts(solver.gauge_angle(static_cast<int>(j))));
      }
      if (estimator.Estimate(exact).status == FrameStatus::kOk) continue;
    }
    untold.push_back(height);
  }
  return untold;
}

std::optional<GaugeChoice> ChooseGauges(const Finger& finger,
                                        const GaugePlaces& places,
                                        const PlacementTask& task, int count,
                                        const FutureCalibration& calibration,
                                        std::uint64_t seed,
                                        const Discretization& discretization) {
  const std::vector<double> heights = HeightsOf(task.from_mm, task.to_mm);
  const auto of_goal = [&](const WorstStd& worst) {
    return task.goal == PlacementGoal::kPlace ? worst.place_mm : worst.force_N;
  };
  std::optional<GaugeChoice> best;
  for (const Placement& placement : PlaceGauges(places, count, seed)) {
    Finger placed = finger;
    placed.calibration.reset();  // that of other gauges
    placed.gauges = placement.gauges;
    placed =
        AfterCalibration(placed, calibration, task.normal_N, discretization);
    ContactAccuracy accuracy(placed, task.friction, discretization);
    const WorstStd worst =
        WorstOf(heights, task.normal_N, task.friction, &accuracy);
    const std::vector<double> untold = UntoldHeights(
        placed, heights, task.normal_N, task.friction, discretization);
    if (!best || std::pair(untold.size(), of_goal(worst)) <
                     std::pair(best->untold_mm.size(), of_goal(best->worst))) {
      best = GaugeChoice{placed, worst, untold};
    }
  }
  return best;
}

FrameTable AccuracyTable(const Finger& finger, double normal_N, double friction,
                         const Discretization& discretization) {
  ContactAccuracy accuracy(finger, friction, discretization);
  const double length = finger.front_length_mm;
  std::vector<std::vector<PointContact>> cases;
  for (double at = kOneStep; at < 1 - kOneStep / 2; at += kOneStep) {
    cases.push_back({{at * length, normal_N, friction}});
  }
  for (double at = kPairStep;
       finger.gauges.size() >= 4 && at < 1 - kPairStep / 2; at += kPairStep) {
    for (double above = at + kPairStep; above < 1 - kPairStep / 2;
         above += kPairStep) {
      if (above - at < kLeastDistance) continue;
      cases.push_back({{at * length, normal_N, friction},
                       {above * length, normal_N, friction}});
    }
  }
  FrameTable table(cases.size());
  std::vector<double> singles;
  for (std::size_t row = 0; row < cases.size(); ++row) {
    AddAccuracy(cases[row], &accuracy, row, &table);
    if (cases[row].size() == 1) singles.push_back(cases[row][0].arc_mm);
  }
  const std::vector<double> untold =
      UntoldHeights(finger, singles, normal_N, friction, discretization);
  std::vector<std::string>& status = table.MutableText("status");
  for (std::size_t row = 0; row < singles.size(); ++row) {
    const bool is_untold =
        std::find(untold.begin(), untold.end(), singles[row]) != untold.end();
    status[row] = is_untold ? "unobservable" : "ok";
  }
  return table;
}

}  // namespace finray
