#ifndef FINRAY_TESTS_CALIB_RECORDED_LOG_H_
#define FINRAY_TESTS_CALIB_RECORDED_LOG_H_

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "calib/standard_log.h"
#include "finray/scene/simulation.h"

namespace finray {

/// Presses in the order in which a stage makes them: three free rows, then the
/// circle goes in and out again in ten steps each, at five rows a second.
inline FrameTable RecordedFrames(const Finger& finger, unsigned seed,
                                 int presses = 14) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform;
  constexpr int kFree = 3, kIn = 10, kOfPress = kFree + 2 * kIn - 1;
  FrameTable frames(static_cast<std::size_t>(presses) * kOfPress);
  std::vector<double>& time_s = frames.MutableNumbers("time_s");
  std::vector<double>& x = frames.MutableNumbers("object_x_mm");
  std::vector<double>& y = frames.MutableNumbers("object_y_mm");
  std::size_t row = 0;
  for (int press = 0; press < presses; ++press) {
    const double at = 25 + 90 * uniform(generator);
    const double stiffness =
        0.85 + 6.5 * std::exp(-(at - 22) / 10) + 1.2 * std::exp((at - 118) / 8);
    const double depth = (3 + 3.5 * uniform(generator)) / stiffness;
    for (int i = 0; i < kOfPress; ++i, ++row) {
      const int in = kIn - std::abs(i - kFree - kIn + 1);  // of kIn
      time_s[row] = 0.2 * static_cast<double>(row);
      y[row] = at;
      x[row] = i < kFree ? -25 : -15 + depth * in / kIn;
    }
  }
  EXPECT_EQ(Simulate(finger, StandardScene(), {}, &frames).not_converged, 0);
  return frames;
}

/// The same finger with gauges of another noise, in rad.
inline Finger WithNoise(Finger finger, double noise_rad) {
  for (int j = 0; j < 4; ++j) {
    finger.gauges[j].noise_V =
        noise_rad * HiddenFinger().gauges[j].gain_V_per_rad;
  }
  return finger;
}

/// Their log, with the noise of the finger's gauges.
inline std::string RecordedLog(const TempFolder& folder, const Finger& finger,
                               unsigned seed) {
  MakeLog(finger, RecordedFrames(finger, seed), {0.02, 0.05, seed})
      .Write(folder.Path("recorded.csv"));
  return folder.Path("recorded.csv");
}

}  // namespace finray

#endif  // FINRAY_TESTS_CALIB_RECORDED_LOG_H_
