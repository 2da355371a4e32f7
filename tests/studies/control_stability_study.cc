// Closed-loop stability of force control over the object's stiffness and the
// delay of the actuation, the estimator in the loop: a circle of R = 15 mm on a
// spring at 80 mm, steps of the set-point 3 -> 5 -> 3 N, 30 Hz, a servo of 30
// ms, 50 mm/s, gauges 3e-4 rad; the plant differs from the model by 1 % of EI,
// 0.3 % of gains, 0.5 mV, 0.03 mm of ribs. Three draws each, the worst one
// counts. A cell is the rms error in N over 5 to 8 s behind each step;
// "-" is unstable: above 0.3 N, or stopped.
//
//   build/test/tests/control_stability_study

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "finray/control/control_statistics.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kUnstable_N = 0.3;
constexpr int kDraws = 3;
constexpr double kRigid = 0;

const std::vector<double> kStiffness = {kRigid, 20, 5, 2, 1, 0.5, 0.2, 0.1};
const std::vector<double> kDelays_ms = {33, 80, 130, 180, 300};

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
  experiment.set_point = Trajectory(StepTrajectory{{3, 5, 3}, 8});
  experiment.model_error = {1, 0.3, 5e-4, 0.03};
  experiment.duration_s = 24;
  experiment.measure_from_s = 8;
  experiment.settled_after_s = 5;
  return experiment;
}

std::string Cell(const Finger& finger, const Experiment& experiment,
                 const ControllerSettings& controller) {
  double worst = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const LoopRun run = RunLoop(finger, experiment, controller, {}, 1 + draw);
    const ControlStatistics s = StatisticsOf(run, experiment, true);
    if (s.stopped_runs > 0 || s.failed_runs > 0) return "-";
    worst = std::max(worst, s.settled.rms());
  }
  if (!(worst < kUnstable_N)) return "-";
  char text[16];
  std::snprintf(text, sizeof text, "%.2f", worst);
  return text;
}

void PrintTable(const char* title, const ControllerSettings& controller,
                bool delay_is_known, bool drive_is_measured = true) {
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
  for (const double delay : kDelays_ms) {
    std::printf("| %g |", delay);
    for (const double stiffness : kStiffness) {
      Experiment experiment =
          MakeExperiment(stiffness, delay_is_known ? delay : 130, delay);
      experiment.drive_is_measured = drive_is_measured;
      std::printf(" %s |", Cell(finger, experiment, controller).c_str());
      std::fflush(stdout);
    }
    std::printf("\n");
  }
}

void Run() {
  ControllerSettings model, rigid, pi;
  rigid.prior.compliance_mm_per_N = 0;
  pi.kind = ControllerKind::kPi;
  PrintTable("Model-based, delay known", model, true);
  PrintTable("PI, delay known", pi, true);
  PrintTable("Model-based, taking the delay for 130 ms", model, false);
  PrintTable("PI, taking the delay for 130 ms", pi, false);
  PrintTable("Model-based, taking the object for rigid, delay known", rigid,
             true);
  PrintTable("Model-based, drive not measured, taking the delay for 130 ms",
             model, false, false);
}

}  // namespace
}  // namespace finray

int main() { finray::Run(); }
