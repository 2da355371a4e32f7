#include "finray/benchmark/noise_floor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "finray/estimation/row_fit.h"
#include "test_finger.h"

namespace finray {
namespace {

constexpr double kNoise_rad = 3e-4;

Finger NoisyFinger() {
  Finger finger = PaperFinger();
  for (Gauge& gauge : finger.gauges) {
    gauge.gain_V_per_rad = 20;
    gauge.noise_V = 20 * kNoise_rad;
  }
  return finger;
}

// Fits of noisy readings are off by as much as the floor says. The case has
// another noise, which does not matter.
TEST(NoiseFloorTest, IsWhatNoisyFitsAreOffBy) {
  const Finger finger = NoisyFinger();
  const BenchmarkCase c = MakeBenchmarkCase(finger, "one_contact", 8);
  const NoiseFloor floor = NoiseFloorOf(finger, c);
  EXPECT_EQ(floor.scene, "one_contact");
  EXPECT_NEAR(floor.gauge_rad, kNoise_rad, 1e-12);

  EquilibriumSolver solver(finger, {});
  RowFit fit(finger, c.scene, {}, nullptr,
             std::numeric_limits<double>::infinity());
  ContactSolution found;
  std::mt19937_64 generator(3);
  std::normal_distribution<double> noise(0, kNoise_rad);
  double arc = 0, normal = 0;
  int fits = 0;
  for (std::size_t k = 0; k < c.frames.size(); ++k) {
    Measurements row;
    for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
      const double angle =
          c.forward[k].gauges_rad[static_cast<Eigen::Index>(j)];
      row.gauges_V.push_back(finger.gauges[j].Volts(angle + noise(generator)));
    }
    const PointContact truth = c.frames[k].contacts[0];
    fit.set_row(row);
    ASSERT_TRUE(fit.FitFrom({truth}, &solver, &found));
    arc += std::pow(found.contacts[0].arc_mm - truth.arc_mm, 2);
    normal += std::pow(found.contacts[0].normal_N - truth.normal_N, 2);
    ++fits;
  }
  // The rms of 520 values is good to a twentieth or so.
  EXPECT_NEAR(std::sqrt(arc / fits) / floor.contact_mm, 1, 0.12);
  EXPECT_NEAR(std::sqrt(normal / fits) / floor.normal_N, 1, 0.12);
}

TEST(NoiseFloorTest, GoesWithTheNoiseOfTheFinger) {
  Finger finger = NoisyFinger();
  const BenchmarkCase c = MakeBenchmarkCase(finger, "two_contacts", 1);
  const NoiseFloor one = NoiseFloorOf(finger, c);
  for (Gauge& gauge : finger.gauges) gauge.noise_V *= 3;
  const NoiseFloor three = NoiseFloorOf(finger, c);
  EXPECT_NEAR(three.contact_mm / one.contact_mm, 3, 1e-6);
  EXPECT_NEAR(three.normal_N / one.normal_N, 3, 1e-6);
}

TEST(NoiseFloorTest, AMeasuredCircleLowersIt) {
  const Finger finger = NoisyFinger();
  const NoiseFloor circle =
      NoiseFloorOf(finger, MakeBenchmarkCase(finger, "circle", 1));
  EXPECT_LT(circle.contact_mm, 0.2);
  EXPECT_GT(circle.contact_mm, 0);
}

TEST(NoiseFloorTest, FramesWithoutAContactHaveGaugesOnly) {
  const Finger finger = NoisyFinger();
  const NoiseFloor none =
      NoiseFloorOf(finger, MakeBenchmarkCase(finger, "no_contact", 1));
  EXPECT_TRUE(std::isnan(none.contact_mm));
  EXPECT_NEAR(none.gauge_rad, kNoise_rad, 1e-12);
  EXPECT_TRUE(std::isnan(FloorOf({none}, "one_contact").gauge_rad));
}

}  // namespace
}  // namespace finray
