#include "finray/calib/analysis/free_scatter.h"

#include <gtest/gtest.h>

#include <random>

#include "calib/standard_log.h"
#include "finray/calib/report/calibration_result.h"

namespace finray {
namespace {

// A log that rests, with noise and a slow drift.
CalibrationLogs Resting(int rows, double noise_V, double drift_V) {
  CalibrationLogs logs;
  std::mt19937_64 generator(5);
  std::normal_distribution<double> noise(0, noise_V);
  for (int i = 0; i < rows; ++i) {
    CalibrationFrame frame;
    frame.gauges_V = {drift_V * i / rows + noise(generator)};
    logs.frames.push_back(frame);
  }
  return logs;
}

TEST(FreeScatterTest, IsTheNoiseWithoutTheDrift) {
  const auto found = MeasureFreeScatter(Resting(2000, 2e-3, 0.3), 1);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].differences, 1999);
  EXPECT_NEAR(found[0].std_V, 2e-3, 2e-4);
  EXPECT_TRUE(found[0].IsAbove(3e-4));
  EXPECT_FALSE(found[0].IsAbove(1.6e-3));
}

TEST(FreeScatterTest, AFewReadingsProveLittle) {
  EXPECT_TRUE(MeasureFreeScatter(Resting(5, 2e-3, 0), 1).empty());
  const auto found = MeasureFreeScatter(Resting(9, 2e-3, 0), 1);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_FALSE(found[0].IsAbove(1e-3));
}

// The noise that the plan gives is the noise that the finger is sensed with.
TEST(FreeScatterTest, ACalibrationKeepsTheNoiseItUsedAndWarnsOfAnother) {
  Finger noisy = HiddenFinger();
  for (Gauge& gauge : noisy.gauges) gauge.noise_V = 5e-3;
  const TempFolder folder;
  const std::string log = StandardLog(folder, noisy, 6);
  Finger start = Nominal();
  for (Gauge& gauge : start.gauges) gauge.noise_V = 3e-4;
  for (const bool told : {false, true}) {
    Plan plan = StandardPlan();
    if (told) plan.gauge_std_V = 5e-3;
    CalibrationProblem problem(start, plan,
                               ReadCalibrationLogs({log}, start, plan), {}, 2);
    const CalibrationResult result = Calibrate(&problem);
    for (const Gauge& gauge : result.finger.gauges) {
      EXPECT_EQ(gauge.noise_V, told ? 5e-3 : 3e-4);
    }
    if (told) {
      for (const Warning& warning : result.warnings) {
        EXPECT_NE(warning.code, "free_scatter");
      }
    } else {
      ASSERT_FALSE(result.warnings.empty());
      EXPECT_EQ(result.warnings[0].code, "free_scatter");
    }
  }
}

}  // namespace
}  // namespace finray
