#include "finray/calib/analysis/reading_noise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib/standard_log.h"

namespace finray {
namespace {

using testing::HasSubstr;

// SetReadingNoise() applied to a finger whose readings have 0.3 mV.
struct Noise {
  explicit Noise(const FrameTable& log, std::optional<double> row_std_V) {
    Finger start = Nominal();
    for (Gauge& gauge : start.gauges) gauge.noise_V = 3e-4;
    Plan plan = StandardPlan();
    plan.gauge_std_V = row_std_V;
    const CalibrationProblem problem(
        start, plan,
        ReadCalibrationLogs(std::vector<FrameTable>{log}, start, plan), {}, 1);
    Finger finger = problem.finger();
    SetReadingNoise(problem, &finger, &warnings);
    for (const Gauge& gauge : finger.gauges) V.push_back(gauge.noise_V);
    words = ReadingNoiseWords(problem, finger);
  }

  std::vector<double> V;
  std::string words;
  std::vector<Warning> warnings;
};

TEST(ReadingNoiseTest, ScatterAboutMeansIsTheNoiseOfOneReading) {
  FrameTable log = StandardFrames(HiddenFinger(), 7);
  log.MutableNumbers("gauge_1_scatter_V").assign(log.rows(), 2.5e-4);
  log.MutableNumbers("gauge_1_scatter_V")[3] = std::nan("");
  std::vector<double>& second = log.MutableNumbers("gauge_2_scatter_V");
  for (std::size_t i = 0; i < log.rows(); ++i) second[i] = i % 2 ? 3e-4 : 4e-4;
  log.MutableNumbers("gauge_3_scatter_V").assign(log.rows(), 0);  // steps
  log.MutableNumbers("gauge_4_scatter_V").assign(log.rows(), 1e-3);
  const Noise noise(log, 2.8e-5);
  EXPECT_NEAR(noise.V[0], 2.5e-4, 1e-12);
  EXPECT_NEAR(noise.V[1], std::sqrt(12.5e-8), 1e-12);
  EXPECT_EQ(noise.V[2], 2.8e-5);
  EXPECT_NEAR(noise.V[3], 1e-3, 1e-12);
  EXPECT_TRUE(noise.warnings.empty());
  EXPECT_EQ(noise.words,
            "0.25 0.35 0.028 1 mV, the scatter of single readings; rows have "
            "0.028 mV");
  // The noise of the finger counts if the plan gives none for rows.
  EXPECT_EQ(Noise(log, {}).V[3], 3e-4);
  EXPECT_EQ(Noise(log, {}).words, "");
}

TEST(ReadingNoiseTest, WordsNameTheGaugesWithAScatter) {
  FrameTable log = StandardFrames(HiddenFinger(), 7);
  EXPECT_EQ(Noise(log, 2.8e-5).words, "");
  log.MutableNumbers("gauge_2_scatter_V").assign(log.rows(), 3e-4);
  EXPECT_EQ(Noise(log, 2.8e-5).words,
            "0.028 0.3 0.028 0.028 mV, the scatter of single readings of gauge "
            "2; rows have 0.028 mV");
  log.MutableNumbers("gauge_4_scatter_V").assign(log.rows(), 4e-4);
  EXPECT_THAT(Noise(log, 2.8e-5).words, HasSubstr(" of gauges 2, 4; rows"));
}

TEST(ReadingNoiseTest, AMuchSmallerNoiseOfRowsIsAWarning) {
  FrameTable log = StandardFrames(HiddenFinger(), 7);
  for (const double row_std_V : {2e-4, 5e-3}) {
    const Noise noise(log, row_std_V);
    EXPECT_EQ(noise.V[0], row_std_V);
    EXPECT_TRUE(noise.warnings.empty());
  }
  log.MutableNumbers("gauge_1_scatter_V").assign(log.rows(), 3e-4);
  const Noise noise(log, 2.8e-5);
  EXPECT_EQ(noise.V[1], 2.8e-5);
  ASSERT_EQ(noise.warnings.size(), 1u);
  EXPECT_EQ(noise.warnings[0].code, "noise_of_rows");
  EXPECT_THAT(
      noise.warnings[0].text,
      HasSubstr("gauge_std_V of 0.028 mV replaces a noise_V of 0.3 mV"));
}

// Without a std of rows in the plan, a row has the noise of a reading over the
// root of its count; with one, it has that.
TEST(ReadingNoiseTest, RowsOfMeansAreFittedWithTheNoiseOfMeans) {
  FrameTable log = StandardFrames(HiddenFinger(), 7);
  log.MutableNumbers("gauge_readings").assign(log.rows(), 25);
  log.MutableNumbers("gauge_readings")[0] = std::nan("");
  log.MutableNumbers("force_readings").assign(log.rows(), 4);
  log.MutableNumbers("force_x_scatter_N").assign(log.rows(), 0.03);
  log.MutableNumbers("force_y_scatter_N").assign(log.rows(), 0.05);
  Plan plan = StandardPlan();
  const auto frames = [&] {
    return ReadCalibrationLogs(std::vector<FrameTable>{log}, Nominal(), plan)
        .frames;
  };
  EXPECT_NEAR(frames()[1].GaugeStd_V(0, 3e-4), 6e-5, 1e-12);
  EXPECT_EQ(frames()[0].GaugeStd_V(0, 3e-4), 3e-4);
  EXPECT_NEAR(frames()[1].ForceStd_N(plan), std::sqrt(17e-4) / 2, 1e-12);
  plan.gauge_std_V = 1e-4;
  plan.force_std_stated = true;
  EXPECT_EQ(frames()[1].GaugeStd_V(0, 1e-4), 1e-4);
  EXPECT_EQ(frames()[1].ForceStd_N(plan), plan.force_std_N);
}

}  // namespace
}  // namespace finray
