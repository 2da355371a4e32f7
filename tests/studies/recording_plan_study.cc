// Does a recording that finray_plan proposes meet its target? Fingers are drawn
// from the priors of a plan; the recording is planned with the drawing alone,
// simulated with each drawn finger, and calibrated from the drawing. Then noisy
// frames of the drawn finger are estimated over the region of the target.
//
// The fingers differ from the drawing as the priors say, but the physics are
// those of the model that plans.

#include <cmath>
#include <cstdio>
#include <random>

#include "finray/calib/design/contact_accuracy.h"
#include "finray/calib/design/recording_plan.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/objects/object_contact.h"
#include "finray/scene/simulation.h"
#include "studies/planned_log.h"
#include "temp_file.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr int kDraws = 20, kFramesPerHeight = 20;

// The log that a lab records of the finger at the places of the plan: by the
// simulation, with noise. Rows above the largest force are left out.
std::string Record(const KnownFinger& truth, const Plan& plan,
                   const std::vector<RecordingRow>& rows,
                   const RecordingLimits& limits, unsigned seed,
                   const std::string& path) {
  FrameTable frames(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Vector2d place = truth.stage.InS(rows[i].object_mm);
    frames.MutableNumbers("object_x_mm")[i] = place.x();
    frames.MutableNumbers("object_y_mm")[i] = place.y();
  }
  Simulate(truth.finger, plan.scene, {}, &frames);
  const FrameTable log = MakeLog(truth.finger, frames,
                                 {plan.force_std_N, plan.object_std_mm, seed});
  std::size_t kept = 0;
  const std::vector<double>& force = log.Numbers("force_N");
  for (const double f : force) kept += f <= limits.force_max_N;
  FrameTable copy(kept);
  for (const std::string& name : log.headers()) {
    const std::vector<double>& from = log.Numbers(name);
    std::vector<double>& to = copy.MutableNumbers(name);
    std::size_t next = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (force[i] > limits.force_max_N) continue;
      to[next] = from[i];
      // The stage counts from its own origin.
      if (name == "object_x_mm") to[next] -= truth.stage.origin_mm.x();
      if (name == "object_y_mm") to[next] -= truth.stage.origin_mm.y();
      ++next;
    }
  }
  copy.Write(path);
  return path;
}

struct Errors {
  double place_mm = 0, force_N = 0;
};

Errors Sense(const Finger& truth, const Finger& found,
             const RecordingTarget& target, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Scene scene;
  scene.contacts = 1;
  FrameEstimator estimator(found, scene);
  EquilibriumSolver solver(truth, {});
  Errors sum;
  int frames = 0;
  for (const double height : HeightsOf(target.from_mm, target.to_mm)) {
    solver.Reset();
    if (!solver.Solve({{height, target.normal_N}})) std::abort();
    for (int k = 0; k < kFramesPerHeight; ++k, ++frames) {
      Measurements row;
      for (std::size_t j = 0; j < truth.gauges.size(); ++j) {
        const Gauge& gauge = truth.gauges[j];
        row.gauges_V.push_back(
            gauge.Volts(solver.gauge_angle(static_cast<int>(j))) +
            gauge.noise_V * normal(generator));
      }
      const FrameEstimate estimate = estimator.Estimate(row);
      sum.place_mm += std::pow(estimate.contact[0].arc_mm - height, 2);
      sum.force_N +=
          std::pow(estimate.contact[0].normal_N - target.normal_N, 2);
    }
  }
  return {std::sqrt(sum.place_mm / frames), std::sqrt(sum.force_N / frames)};
}

// Returns how many of the draws meet the target.
int Meet(const char* name, const Finger& drawing, const Plan& plan,
         const RecordingTarget& target, double more) {
  const TempFolder folder;
  const RecordingLimits limits{{-30, 0}, {15, 150}, 8};
  const KnownFinger known = FromDrawing(drawing, plan, {});
  const RecordingPlan promised =
      PlanRecording(known, plan, limits, target, 1, 400, {});
  // With more rows than promised: the plan of a recording that cannot suffice
  // has as many as are allowed.
  RecordingTarget never = target;
  never.force_N = 1e-9;
  const auto rows = static_cast<std::size_t>(
      std::lround(more * static_cast<double>(promised.rows.size())));
  const RecordingPlan recorded =
      more == 1 ? promised
                : PlanRecording(known, plan, limits, never, 1, rows, {});
  int met = 0;
  std::printf(
      "\n%s: %.3g mm and %.3g N rms of %.3g N from %g to %g mm; %zu rows "
      "promised (met by %.0f %%), %zu recorded\n\n| draw | rms mm | rms N "
      "| met |\n|---|---|---|---|\n",
      name, *target.place_mm, *target.force_N, target.normal_N, target.from_mm,
      target.to_mm, promised.rows.size(), 100 * promised.met,
      recorded.rows.size());
  for (unsigned k = 0; k < kDraws; ++k) {
    const KnownFinger truth = DrawFrom(known, plan, 777000 + k, {});
    const std::string log = Record(truth, plan, recorded.rows, limits, k + 1,
                                   folder.Path("log.csv"));
    CalibrationProblem problem(
        drawing, plan, ReadCalibrationLogs({log}, drawing, plan), {}, 2);
    SolveRobustly(&problem);
    const Errors errors =
        Sense(truth.finger, problem.parameters().Apply(drawing), target, k + 1);
    const bool meets = errors.place_mm <= *target.place_mm &&
                       errors.force_N <= *target.force_N;
    met += meets;
    std::printf("| %u | %.3f | %.4f | %s |\n", k + 1, errors.place_mm,
                errors.force_N, meets ? "yes" : "no");
    std::fflush(stdout);
  }
  std::printf("\n%d of %d draws meet the target\n", met, kDraws);
  return met;
}

}  // namespace
}  // namespace finray

int main() {
  using namespace finray;
  const Plan plan =
      ReadPlan(FINRAY_SOURCE_DIR "/configs/plans/drawn_finger.yaml");
  const Finger paper = PaperFinger();
  const RecordingTarget target{28, 98, 3, 0.7, 0.066, 0.95};
  Meet("as promised", paper, plan, target, 1);
  Meet("1.3 times as many", paper, plan, target, 1.3);
  return 0;
}
