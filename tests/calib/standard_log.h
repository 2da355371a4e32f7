#ifndef FINRAY_TESTS_CALIB_STANDARD_LOG_H_
#define FINRAY_TESTS_CALIB_STANDARD_LOG_H_

// The standard log of docs/evidence/calibration_accuracy.md.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "finray/calib/problem/plan.h"
#include "finray/scene/simulation.h"
#include "temp_file.h"
#include "test_finger.h"

namespace finray {

/// A finger as it might come out of assembly when the paper's was meant.
inline Finger HiddenFinger() {
  Finger finger = PaperFinger();
  finger.front_stiffness_N_mm2 *= 0.88;
  finger.back_stiffness_N_mm2 *= 1.13;
  const double gains[] = {1.8, 2.2, 1.6, 2.5};
  const double offsets[] = {0.05, -0.03, 0.01, -0.06};
  const double ribs[] = {0.3, -0.25, 0.15, -0.1, 0.2};
  for (int j = 0; j < 4; ++j) {
    finger.gauges[j].gain_V_per_rad = gains[j];
    finger.gauges[j].offset_V = offsets[j];
    // The standard log's noise is 3e-4 rad.
    finger.gauges[j].noise_V = 3e-4 * gains[j];
  }
  for (int i = 0; i < 5; ++i) finger.ribs[i].length_mm += ribs[i];
  return finger;
}

inline Scene StandardScene() {
  Scene scene;
  scene.object = RigidObject{Outline(CircleOutline{15}), {}};
  return scene;
}

/// 200 frames with a circle of R = 15 mm pressed in, 10 free ones, as they are.
inline FrameTable StandardFrames(const Finger& finger, unsigned seed,
                                 const Scene& scene = StandardScene()) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform;
  FrameTable frames(210);
  std::vector<double>& x = frames.MutableNumbers("object_x_mm");
  std::vector<double>& y = frames.MutableNumbers("object_y_mm");
  for (int i = 0; i < 210; ++i) {
    y[i] = 22 + 90 * uniform(generator);
    // Stiff near the base, soft in the middle: forces of 0.5 to 7 N or so.
    const double stiffness = 0.85 + 6.5 * std::exp(-(y[i] - 22) / 10) +
                             1.2 * std::exp((y[i] - 118) / 8);
    x[i] =
        i % 21 == 0 ? -25 : -15 + (0.5 + 6.5 * uniform(generator)) / stiffness;
  }
  EXPECT_EQ(Simulate(finger, scene, {}, &frames).not_converged, 0);
  return frames;
}

/// Their log, written to a folder.
inline std::string StandardLog(const TempFolder& folder, const Finger& finger,
                               unsigned seed) {
  MakeLog(finger, StandardFrames(finger, seed), {0.02, 0.05, seed})
      .Write(folder.Path("log.csv"));
  return folder.Path("log.csv");
}

/// All of the finger free, nothing of the object.
inline Plan StandardPlan() {
  Plan plan;
  plan.scene = StandardScene();
  const double priors[] = {50, 50, 200, 1.0, 0.5};
  for (int i = 0; i < 5; ++i) {
    plan.families[i].free = true;
    plan.families[i].prior_std = priors[i];
  }
  return plan;
}

/// The nominal finger with unit gains and the true noise.
inline Finger Nominal() {
  Finger finger = PaperFinger();
  for (int j = 0; j < 4; ++j) {
    finger.gauges[j].noise_V = HiddenFinger().gauges[j].noise_V;
  }
  return finger;
}

}  // namespace finray

#endif  // FINRAY_TESTS_CALIB_STANDARD_LOG_H_
