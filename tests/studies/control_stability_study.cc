// Closed-loop stability of force control, the estimator in the loop: a circle
// of R = 15 mm, steps of the set-point 3 -> 5 -> 3 N of 8 s each, 30 Hz, a
// servo of 30 ms, 50 mm/s, gauges 3e-4 rad; the plant differs from the model by
// 1 % of EI, 0.3 % of gains, 0.5 mV, 0.03 mm of ribs. Over the object's
// stiffness and the delay of the actuation, and over the height of the contact.
// Three draws each. A cell is the rms error in N over all of both steps / over
// 5 to 8 s behind each, of the worst draw; "not settled": above 0.3 N there;
// "stopped": the contact was not observable on the approach, and the loop gave
// up.
//
//   build/test/tests/control_stability_study

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "finray/control/model_controller.h"
#include "finray/control/run_experiment.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kSettled_N = 0.3;
constexpr int kDraws = 3;
constexpr double kRigid = 0;

using Numbers = std::vector<double>;

const Numbers kStiffness = {kRigid, 20, 5, 2, 1, 0.5, 0.2, 0.1};
const Numbers kDelays_ms = {33, 80, 130, 180, 300};
const Numbers kNearDelays_ms = {110, 120, 130, 140, 150};
const Numbers kHeights_mm = {30, 50, 70, 90, 100, 105, 110};

Experiment MakeExperiment(double stiffness, double believed_ms,
                          double true_ms) {
  Experiment experiment;
  experiment.scene.most_contacts = 1;
  experiment.scene.object = RigidObject{Outline(CircleOutline{15}), {}};
  if (stiffness != kRigid) {
    experiment.scene.object->spring = ObjectSpring{stiffness, M_PI};
  }
  experiment.start = {80, 0, 1};
  experiment.actuation = {1.0 / 30, 1e-3 * believed_ms, 0.03, 50};
  experiment.true_delay_s = 1e-3 * true_ms;
  experiment.set_point = Trajectory{{3, 5, 3}, 8};
  experiment.model_error = {1, 0.3, 5e-4, 0.03};
  experiment.duration_s = 24;
  experiment.measure_from_s = 8;
  experiment.settled_after_s = 5;
  return experiment;
}

std::string Cell(const Finger& finger, const Experiment& experiment,
                 const ControllerSettings& controller) {
  double all = 0, settled = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const LoopRun run = RunLoop(finger, experiment, controller, {}, 1 + draw);
    const ControlStatistics s = StatisticsOf(run, experiment, true);
    if (s.failed_runs > 0) return "lost";
    if (s.stopped_runs > 0) return "stopped";
    all = std::max(all, s.control.rms());
    settled = std::max(settled, s.settled.rms());
  }
  if (!(settled < kSettled_N)) return "not settled";
  char text[32];
  std::snprintf(text, sizeof text, "%.2f / %.2f", all, settled);
  return text;
}

struct Setting {
  ControllerSettings controller;
  bool delay_is_known = true;
  bool drive_is_measured = true;
};

void PrintTable(const char* title, const Setting& setting,
                const Numbers& delays_ms) {
  const Finger finger = PaperFinger();
  std::printf("\n%s\n\n| true delay, ms |", title);
  for (const double stiffness : kStiffness) {
    if (stiffness == kRigid) {
      std::printf(" rigid |");
    } else {
      std::printf(" %g N/mm |", stiffness);
    }
  }
  std::printf("\n|---|");
  for (std::size_t i = 0; i < kStiffness.size(); ++i) std::printf("---|");
  std::printf("\n");
  for (const double delay : delays_ms) {
    std::printf("| %g |", delay);
    for (const double stiffness : kStiffness) {
      Experiment experiment = MakeExperiment(
          stiffness, setting.delay_is_known ? delay : 130, delay);
      experiment.drive_is_measured = setting.drive_is_measured;
      std::printf(" %s |",
                  Cell(finger, experiment, setting.controller).c_str());
      std::fflush(stdout);
    }
    std::printf("\n");
  }
}

// A fixed object at other heights, where the finger is up to ten times stiffer.
void PrintHeights(const ControllerSettings& model,
                  const ControllerSettings& pi) {
  const Finger finger = PaperFinger();
  PushModel push_model(finger, 15, 0, {});
  const auto here = MakePose<double>(0, Eigen::Vector2d::Zero());
  std::printf(
      "\nHeight of a fixed object, 130 ms\n\n| y, mm | finger, N/mm at 4 N | "
      "model-based | PI, tuned at 70 mm |\n|---|---|---|---|\n");
  for (const double y_mm : kHeights_mm) {
    Experiment experiment = MakeExperiment(kRigid, 130, 130);
    experiment.start.y_mm = y_mm;
    std::printf("| %g | %.2f | %s |", y_mm,
                push_model.At(here, y_mm, 4, y_mm)->stiffness_N_per_mm,
                Cell(finger, experiment, model).c_str());
    std::printf(" %s |\n", Cell(finger, experiment, pi).c_str());
    std::fflush(stdout);
  }
}

void Run() {
  ControllerSettings model, rigid, pi;
  rigid.prior.compliance_mm_per_N = 0;
  pi.kind = ControllerKind::kPi;
  pi.tuned_at_mm = 70;
  PrintHeights(model, pi);
  PrintTable("Model-based, delay known", {model}, kDelays_ms);
  PrintTable("PI, delay known", {pi}, kDelays_ms);
  PrintTable("Model-based, taking the delay for 130 ms", {model, false},
             kDelays_ms);
  PrintTable("PI, taking the delay for 130 ms", {pi, false}, kDelays_ms);
  PrintTable("Model-based, taking the object for rigid, delay known", {rigid},
             kDelays_ms);
  PrintTable("Model-based, drive not measured, taking the delay for 130 ms",
             {model, false, false}, kNearDelays_ms);
}

}  // namespace
}  // namespace finray

int main() { finray::Run(); }
