// Does finray_design predict the std of noisy frames? And does the placement of
// gauges that it chooses sense better than the paper's?
//
// The frames are simulated by the model that also predicts: the study shows
// that the linear prediction of the std is right, not that the model is. All
// frames with a contact count, also those that are not ok: leaving out the ones
// that scatter most would flatter the prediction.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "finray/calib/design/finger_design.h"
#include "finray/calib/design/planned_recording.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/finger/geometry.h"
#include "finray/io/number_text.h"
#include "studies/planned_log.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kForce_N = 2, kLarge_N = 6;
constexpr int kFrames = 1000, kCalibrations = 100;

// Errors of noisy frames with a contact.
struct Spread {
  std::vector<double> place_mm, force_N;
  int frames = 0, ok = 0;
};

double Rms(const std::vector<double>& errors) {
  double squares = 0;
  for (const double error : errors) squares += error * error;
  return std::sqrt(squares / static_cast<double>(errors.size()));
}

// Half of the range of the middle 68.27 %: the std of normal errors, whatever a
// few frames do that find another contact.
double Middle(std::vector<double> errors) {
  std::sort(errors.begin(), errors.end());
  const auto at = [&](double share) {
    return errors[static_cast<std::size_t>(
        share * static_cast<double>(errors.size() - 1) + 0.5)];
  };
  return (at(0.84135) - at(0.15865)) / 2;
}

// Adds errors of noisy frames.
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
    ++sum->frames;
    sum->ok += estimate.status == FrameStatus::kOk;
    const ContactEstimate& found = estimate.contact[0];
    if (!std::isfinite(found.arc_mm) || !std::isfinite(found.normal_N)) {
      continue;
    }
    sum->place_mm.push_back(found.arc_mm - contact.arc_mm);
    sum->force_N.push_back(found.normal_N - contact.normal_N);
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

void PrintHead() {
  std::printf(
      "| l_c mm | predicted mm | rms | off | middle 68 %% | off | predicted N "
      "| rms | off | middle 68 %% | off | with contact | ok |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

// Where the predictions are within 10 % of the middle 68 % of the frames.
class Within {
 public:
  void Add(double height, double predicted, double found, int quantity) {
    const double off = predicted / found - 1;
    if (std::abs(off) <= 0.1) return;
    beyond_[quantity] +=
        FormatText("%s%.0f mm (%+.0f %%)",
                   beyond_[quantity].empty() ? "" : ", ", height, 100 * off);
  }
  void Print() const {
    const char* names[] = {"place", "force"};
    std::printf("\n");
    for (int i = 0; i < 2; ++i) {
      std::printf("%s: within 10 %% of the middle 68 %% %s%s\n", names[i],
                  beyond_[i].empty() ? "everywhere" : "but for ",
                  beyond_[i].c_str());
    }
  }

 private:
  std::string beyond_[2];
};

void PrintRow(double height, const Eigen::VectorXd& std, const Spread& spread,
              Within* within) {
  std::printf("| %.0f ", height);
  const auto print = [](double predicted, const std::vector<double>& errors,
                        int digits) {
    std::printf("| %.*f ", digits, predicted);
    for (const double found : {Rms(errors), Middle(errors)}) {
      std::printf("| %.*f | %+.0f %% ", digits, found,
                  100 * (predicted / found - 1));
    }
  };
  print(std[0], spread.place_mm, 3);
  print(std[1], spread.force_N, 4);
  std::printf(
      "| %.1f %% | %.0f %% |\n",
      100.0 * static_cast<double>(spread.force_N.size()) / spread.frames,
      100.0 * spread.ok / spread.frames);
  within->Add(height, std[0], Middle(spread.place_mm), 0);
  within->Add(height, std[1], Middle(spread.force_N), 1);
}

const std::vector<double> kHeights = {14, 20, 30, 40,  50,  60,
                                      70, 80, 90, 100, 105, 110};

// Frames with so many times the noise of the finger's gauges. Where the
// prediction is off with all of it and not with a tenth, the curvature of the
// readings is the cause.
void NoiseAlone(Finger finger, double normal_N, double times_noise) {
  std::printf(
      "\npaper's finger: %d frames of %g N by %g times the noise of the "
      "gauges\n\n",
      kFrames, normal_N, times_noise);
  for (Gauge& gauge : finger.gauges) gauge.noise_V *= times_noise;
  PrintHead();
  Scene scene;
  scene.contacts = 1;
  FrameEstimator estimator(finger, scene);
  ContactAccuracy accuracy(finger, 0, {});
  std::mt19937_64 generator(1);
  Within within;
  for (const double height : kHeights) {
    Spread sum;
    const PointContact contact{height, normal_N};
    AddFrames(&estimator, Exact(finger, contact), contact, kFrames, &generator,
              &sum);
    const ContactStd predicted = accuracy.At({contact});
    PrintRow(height, predicted.noise, sum, &within);
  }
  within.Print();
}

void Calibrated(const Finger& finger, const Plan& plan) {
  std::printf(
      "\npaper's finger, calibrated %d times from 200 frames each, %d "
      "noisy frames each\n\n",
      kCalibrations, kFrames / kCalibrations);
  PrintHead();
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
  Within within;
  for (std::size_t i = 0; i < kHeights.size(); ++i) {
    const ContactStd predicted = accuracy.At({{kHeights[i], kForce_N}});
    PrintRow(kHeights[i], predicted.total, sums[i], &within);
  }
  within.Print();
}

// The worst rms errors of noisy frames from 20 to 105 mm: place, force.
std::array<double, 2> WorstSpread(const Finger& finger) {
  Scene scene;
  scene.contacts = 1;
  FrameEstimator estimator(finger, scene);
  std::mt19937_64 generator(3);
  std::array<double, 2> worst = {};
  for (const double height : HeightsOf(20, 105)) {
    Spread sum;
    const PointContact contact{height, kForce_N};
    AddFrames(&estimator, Exact(finger, contact), contact, kFrames, &generator,
              &sum);
    worst[0] = std::max(worst[0], Rms(sum.place_mm));
    worst[1] = std::max(worst[1], Rms(sum.force_N));
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
    const auto [place_mm, force_N] = WorstSpread(finger);
    std::printf("| %s | %.2f mm | %.3f N | %.2f mm | %.3f N |\n", name,
                worst.place_mm, worst.force_N, place_mm, force_N);
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
  NoiseAlone(paper, kForce_N, 1);
  NoiseAlone(paper, kForce_N, 0.1);
  NoiseAlone(paper, kLarge_N, 1);
  Placements(paper, plan);
  std::fflush(stdout);
  Calibrated(paper, plan);
  return 0;
}
