// `contacts: auto` with a finger that is slightly wrong, and says so.

#include <gtest/gtest.h>

#include <cstdio>

#include "finray/estimation/frame_estimator.h"
#include "finray/scene/clean_readings.h"
#include "test_finger.h"

namespace finray {
namespace {

// The noise of two_contacts_study.
Finger FinelyMeasured() {
  Finger finger = PaperFinger();
  for (Gauge& gauge : finger.gauges) gauge.noise_V = 1e-4;
  return finger;
}

// Stiffness and gains known to 1 %, each by itself.
Finger KnownToAPercent() {
  Finger finger = FinelyMeasured();
  ParameterCovariance known;
  for (const FingerParameter& parameter : ParametersOf(finger)) {
    if (parameter.kind == FingerParameterKind::kRibLength ||
        parameter.kind == FingerParameterKind::kGaugeOffset) {
      continue;
    }
    known.parameters.push_back(parameter);
  }
  const auto count = static_cast<Eigen::Index>(known.parameters.size());
  known.std.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    known.std[k] = 0.01 * ParameterValue(finger, known.parameters[k]);
  }
  known.correlations = Eigen::MatrixXd::Identity(count, count);
  finger.calibration = known;
  return finger;
}

// Counts frames by the contacts found.
struct Counts {
  int frames = 0, two = 0;
};

Counts Count(const Finger& told, const Finger& truth,
             const std::vector<std::vector<PointContact>>& all) {
  FrameEstimator estimator(told, Scene(), {});
  EquilibriumSolver solver(truth, {});
  Counts counts;
  for (const std::vector<PointContact>& contacts : all) {
    EXPECT_TRUE(solver.Solve(contacts));
    ++counts.frames;
    counts.two += estimator.Estimate(CleanReadings(solver)).contacts == 2;
  }
  return counts;
}

TEST(SecondContactTest, ErrorsOfTheCalibrationAreNoContact) {
  Finger truth = FinelyMeasured();
  truth.front_stiffness_N_mm2 *= 1.01;
  for (std::size_t j = 0; j < truth.gauges.size(); ++j) {
    truth.gauges[j].gain_V_per_rad *= j % 2 == 0 ? 1.01 : 0.99;
  }
  std::vector<std::vector<PointContact>> one, two;
  for (const double arc_mm : {30., 45., 60., 75., 90., 100.}) {
    for (const double normal_N : {2., 4., 6., 8., 10., 12.}) {
      one.push_back({{arc_mm, normal_N, 0}});
    }
  }
  for (const double arc_mm : {30., 40., 50.}) {
    for (const double normal_N : {2., 4., 6.}) {
      two.push_back({{arc_mm, normal_N, 0}, {arc_mm + 45, normal_N, 0}});
    }
  }
  const Counts unaware = Count(FinelyMeasured(), truth, one);
  const Counts aware = Count(KnownToAPercent(), truth, one);
  const Counts real = Count(KnownToAPercent(), truth, two);
  std::printf(
      "two contacts found: in %d of %d frames with one, %d without the "
      "covariance; in %d of %d frames with two\n",
      aware.two, aware.frames, unaware.two, real.two, real.frames);
  EXPECT_GE(unaware.two, 5);
  EXPECT_EQ(aware.two, 0);
  EXPECT_EQ(real.two, real.frames);
}

}  // namespace
}  // namespace finray
