// Does finray_design predict the std of noisy frames? And does the placement of
// gauges that it chooses sense better than the paper's?
//
// The frames are simulated by the model that also predicts: the study shows
// that the linear prediction of the std is right, not that the model is.

#include <cmath>
#include <cstdio>
#include <random>

#include "finray/calib/design/finger_design.h"
#include "finray/calib/design/planned_recording.h"
#include "finray/finger/geometry.h"
#include "finray/sensing/frame_estimator.h"
#include "studies/planned_log.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kForce_N = 2, kLarge_N = 6;
constexpr int kFrames = 1000, kCalibrations = 100;

struct Spread {
  double place_mm = 0, force_N = 0;
  int usable = 0;
};

// Sums squares of errors of noisy frames.
void AddFrames(FrameEstimator* estimator, const Measurements& exact,
               const PointContact& contact, int frames,
               std::mt19937_64* generator, Spread* sum) {
  std::normal_distribution<double> normal;
  const Finger& finger = estimator->finger();
  for (int k = 0; k < frames; ++k) {
    Measurements row = exact;
    for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
      row.gauges_V[j] += finger.gauges[j].noise_V * normal(*generator);
    }
    const FrameEstimate estimate = estimator->Estimate(row);
    sum->usable += estimate.status == FrameStatus::kOk;
    sum->place_mm += std::pow(estimate.contact[0].arc_mm - contact.arc_mm, 2);
    sum->force_N +=
        std::pow(estimate.contact[0].normal_N - contact.normal_N, 2);
  }
}

Measurements Exact(const Finger& finger, const PointContact& contact) {
  EquilibriumSolver solver(finger, {});
  if (!solver.Solve({contact})) std::abort();
  Measurements row;
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    row.gauges_V.push_back(
        finger.gauges[j].Volts(solver.gauge_angle(static_cast<int>(j))));
  }
  return row;
}

void PrintRow(double height, const Eigen::VectorXd& std, const Spread& sum,
              int frames) {
  const double place = std::sqrt(sum.place_mm / frames);
  const double force = std::sqrt(sum.force_N / frames);
  std::printf(
      "| %.0f | %.3f | %.3f | %+.0f %% | %.4f | %.4f | %+.0f %% | %.0f %% |\n",
      height, std[0], place, 100 * (std[0] / place - 1), std[1], force,
      100 * (std[1] / force - 1), 100.0 * sum.usable / frames);
}

const std::vector<double> kHeights = {14, 20, 30, 40,  50,  60,
                                      70, 80, 90, 100, 105, 110};

void NoiseAlone(const Finger& finger, double normal_N) {
  std::printf(
      "\npaper's finger: %d frames of %g N by the noise of the gauges\n\n",
      kFrames, normal_N);
  std::printf(
      "| l_c mm | predicted mm | spread mm | off | predicted N | spread "
      "N | off | ok |\n|---|---|---|---|---|---|---|---|\n");
  Scene scene;
  scene.contacts = 1;
  FrameEstimator estimator(finger, scene);
  ContactAccuracy accuracy(finger, 0, {});
  std::mt19937_64 generator(1);
  for (const double height : kHeights) {
    Spread sum;
    const PointContact contact{height, normal_N};
    AddFrames(&estimator, Exact(finger, contact), contact, kFrames, &generator,
              &sum);
    const ContactStd predicted = accuracy.At({contact});
    PrintRow(height, predicted.noise, sum, kFrames);
  }
}

void Calibrated(const Finger& finger, const Plan& plan) {
  std::printf(
      "\npaper's finger, calibrated %d times from 200 frames each, %d "
      "noisy frames each\n\n",
      kCalibrations, kFrames / kCalibrations);
  std::printf(
      "| l_c mm | predicted mm | spread mm | off | predicted N | spread "
      "N | off | ok |\n|---|---|---|---|---|---|---|---|\n");
  const double most_N = 10 * ForceUnit(finger);
  PlannedRecording recording(
      finger, plan, SpreadContacts({14, 126, 0.1 * most_N, most_N}, 200, 1),
      {});
  ContactAccuracy accuracy(recording.Calibrated(), 0, {});
  std::mt19937_64 generator(2);
  Scene scene;
  scene.contacts = 1;
  std::vector<Spread> sums(kHeights.size());
  for (int c = 0; c < kCalibrations; ++c) {
    const Finger found = CalibratedFrom(
        finger, plan,
        WithNoise(recording.problem().logs(), finger, plan, &generator));
    FrameEstimator estimator(found, scene);
    for (std::size_t i = 0; i < kHeights.size(); ++i) {
      const PointContact contact{kHeights[i], kForce_N};
      AddFrames(&estimator, Exact(finger, contact), contact,
                kFrames / kCalibrations, &generator, &sums[i]);
    }
  }
  for (std::size_t i = 0; i < kHeights.size(); ++i) {
    const ContactStd predicted = accuracy.At({{kHeights[i], kForce_N}});
    PrintRow(kHeights[i], predicted.total, sums[i], kFrames);
  }
}

// The worst spread of noisy frames from 20 to 105 mm.
Spread WorstSpread(const Finger& finger) {
  Scene scene;
  scene.contacts = 1;
  FrameEstimator estimator(finger, scene);
  std::mt19937_64 generator(3);
  Spread worst;
  for (const double height : HeightsOf(20, 105)) {
    Spread sum;
    const PointContact contact{height, kForce_N};
    AddFrames(&estimator, Exact(finger, contact), contact, kFrames, &generator,
              &sum);
    worst.place_mm =
        std::max(worst.place_mm, std::sqrt(sum.place_mm / kFrames));
    worst.force_N = std::max(worst.force_N, std::sqrt(sum.force_N / kFrames));
  }
  return worst;
}

void Placements(const Finger& paper, const Plan& plan) {
  std::printf("\nworst std of %g N from 20 to 105 mm\n\n", kForce_N);
  std::printf(
      "| gauges | after calibration, predicted | | by noise, spread of "
      "%d frames | |\n|---|---|---|---|---|\n",
      kFrames);
  const auto print = [&](const char* name, const Finger& finger,
                         const WorstStd& worst) {
    const Spread spread = WorstSpread(finger);
    std::printf("| %s | %.2f mm | %.3f N | %.2f mm | %.3f N |\n", name,
                worst.place_mm, worst.force_N, spread.place_mm, spread.force_N);
  };
  const FutureCalibration calibration{plan, 200};
  const Finger known = AfterCalibration(paper, calibration, kForce_N, {});
  ContactAccuracy accuracy(known, 0, {});
  print("the paper's four", known,
        WorstOf(HeightsOf(20, 105), kForce_N, 0, &accuracy));
  PlacementTask task{paper.gauges[0], {Side::kBack}, 18, 18, 1, 20, 105,
                     kForce_N};
  const char* names[] = {"four on the back beam", "four on both beams"};
  for (const char* name : names) {
    const GaugePlaces places(paper, task, {});
    const auto choice =
        ChooseGauges(paper, places, task, 4, calibration, 1, {});
    print(name, choice->finger, choice->worst);
    task.beams.push_back(Side::kFront);
  }
}

}  // namespace
}  // namespace finray

int main() {
  using namespace finray;
  const Finger paper = PaperFinger();
  const Plan plan =
      ReadPlan(FINRAY_SOURCE_DIR "/configs/plans/force_and_circle.yaml");
  NoiseAlone(paper, kForce_N);
  NoiseAlone(paper, kLarge_N);
  Placements(paper, plan);
  std::fflush(stdout);
  Calibrated(paper, plan);
  return 0;
}
