// Calibration far from the usual: what docs/evidence/extremes.md says, in
// little.

#include <gtest/gtest.h>

#include "studies/calibration_extremes_tables.h"

namespace finray {
namespace {

// The first words of what is said: verdict and exit code.
void ExpectVerdict(const CalibrationOutcome& outcome,
                   const std::string& verdict) {
  ASSERT_EQ(outcome.said.size(), 1u);
  EXPECT_EQ(outcome.said[0].substr(0, verdict.size()), verdict);
}

TEST(ExtremesTest, WithoutNoiseTenDigits) {
  CalibrationCase c;
  c.noisy_gauges = false;
  c.force_std_N = c.object_std_mm = 0;
  c.plan = WithoutPriors(c.plan);
  const CalibrationOutcome outcome = RunCalibration(c, 1);
  ExpectVerdict(outcome, "doubtful 4, noise_below_plan");
  EXPECT_LT(outcome.stiffness, 3e-10);
  EXPECT_LT(outcome.gain, 3e-10);
  EXPECT_LT(outcome.rib_mm, 3e-9);
  EXPECT_LT(outcome.offset_V, 3e-10);
}

TEST(ExtremesTest, ErrorsGoWithTheNoise) {
  const CalibrationOutcome usual = RunCalibration(WithNoiseTimes(1), 1);
  const CalibrationOutcome fine = RunCalibration(WithNoiseTimes(1e-6), 1);
  ExpectVerdict(usual, "good 0");
  ExpectVerdict(fine, "good 0");
  EXPECT_LT(fine.worst_std, 4);
  EXPECT_NEAR(fine.chi2_per_dof, usual.chi2_per_dof, 0.02 * usual.chi2_per_dof);
  EXPECT_NEAR(1e6 * fine.stiffness / usual.stiffness, 1, 0.3);
}

TEST(ExtremesTest, UnitsOfForceChangeNothing) {
  const CalibrationOutcome before = RunCalibration(CalibrationCase(), 1);
  for (const double factor : {1e-3, 1e3}) {
    const CalibrationOutcome after = RunCalibration(WithForcesTimes(factor), 1);
    ExpectVerdict(after, "good 0");
    EXPECT_LT(DifferenceInStd(before, after, factor), 1e-4) << factor;
  }
}

// The prior of 1 +- 2 V/rad is 1e9 std of such a gain: what the information
// matrix has of stiffness is then below the rounding of what it has of gains.
TEST(ExtremesTest, TinyGainsLeaveTheStdOfTheRest) {
  const CalibrationOutcome tiny = RunCalibration(WithGainsTimes(1e-6, true), 1);
  const CalibrationOutcome usual = RunCalibration(CalibrationCase(), 1);
  ExpectVerdict(tiny, "good 0");
  ASSERT_EQ(tiny.std.size(), usual.std.size());
  for (int i = 0; i < 2; ++i) {  // stiffness
    EXPECT_NEAR(tiny.std[i] / usual.std[i], 1, 0.01);
  }
}

TEST(ExtremesTest, GaugesGivenTwice) {
  const CalibrationOutcome once = RunCalibration(CalibrationCase(), 1);
  const CalibrationOutcome twice =
      RunCalibration(WithGauges({1, 1, 2, 2, 3, 3, 4, 4}), 1);
  ExpectVerdict(twice, "good 0");
  EXPECT_LT(twice.worst_std, 4);
  // Stiffness is told by force and object as well: less than by sqrt(2).
  for (int i = 0; i < 2; ++i) {
    EXPECT_LT(twice.std[i], once.std[i]);
    EXPECT_GT(twice.std[i] * std::sqrt(2.1), once.std[i]);
  }
}

TEST(ExtremesTest, CoarseConverters) {
  CalibrationCase c;
  const double step = std::ldexp(2.0, -10);
  c.noisy_gauges = false;
  c.disturb = [step](FrameTable* log) {
    for (int j = 0; j < 4; ++j) {
      for (double& V : log->MutableNumbers(GaugeVolts(j))) {
        V = step * std::round(V / step);
      }
    }
  };
  for (Gauge& gauge : c.start.gauges) gauge.noise_V = step / std::sqrt(12.0);
  const CalibrationOutcome outcome = RunCalibration(c, 1);
  ExpectVerdict(outcome, "good 0");
  EXPECT_LT(outcome.worst_std, 4);
  EXPECT_NEAR(outcome.chi2_per_dof, 1, 0.15);
}

}  // namespace
}  // namespace finray
