// Sensing far from the usual: what docs/evidence/extremes.md says, in little.

#include <gtest/gtest.h>

#include "studies/sensing_extremes_tables.h"

namespace finray {
namespace {

constexpr int kFrames = 10;  // at each of 18 places

void ExpectSound(const SensingOutcome& outcome) {
  EXPECT_EQ(outcome.not_a_number, 0);
  EXPECT_EQ(outcome.explained_over_6_std, 0);
}

// The data come from another mesh, so that an error of one mesh is not in both.
TEST(ExtremesTest, WithoutNoiseElevenDigits) {
  SensingCase c;
  c.disturb = NoNoise;
  const SensingOutcome outcome = RunSensing(c, kFrames);
  ExpectSound(outcome);
  EXPECT_LT(Quantile(outcome.arc_error, 0.5), 1e-12);
  EXPECT_LT(Quantile(outcome.arc_error, 1), 1e-11);
  EXPECT_LT(Quantile(outcome.force_error, 1), 2e-10);
}

TEST(ExtremesTest, ErrorsGoWithTheNoiseOverEightDecades) {
  const auto median = [](double noise) {
    SensingCase c;
    c.noise_of_reading = noise;
    const SensingOutcome outcome = RunSensing(c, kFrames);
    ExpectSound(outcome);
    EXPECT_GT(outcome.ok(), 0.95 * outcome.frames) << noise;
    return Quantile(outcome.force_error, 0.5) / noise;
  };
  const double usual = median(1e-4);
  EXPECT_GT(usual, 0.1);
  EXPECT_NEAR(median(1e-6) / usual, 1, 1e-3);
  EXPECT_NEAR(median(1e-10) / usual, 1, 0.05);
  EXPECT_NEAR(median(1e-2) / usual, 1, 0.1);
}

// Two ends of one fit are no two places, however small the std.
TEST(ExtremesTest, NoiseOfSomeRoundingErrorsLeavesNoRival) {
  for (const double noise : {1e-12, 1e-13, 1e-14}) {
    SCOPED_TRACE(noise);
    SensingCase c;
    c.noise_of_reading = noise;
    const SensingOutcome outcome = RunSensing(c, kFrames);
    EXPECT_EQ(outcome.ok(), outcome.frames);
    if (noise < 1e-12) continue;  // less than the model's own rounding
    ExpectSound(outcome);
    EXPECT_NEAR(double(outcome.arc_within[0]) / outcome.ok(), 0.683, 0.08);
    EXPECT_GT(outcome.arc_within[1], 0.9 * outcome.ok());
  }
}

TEST(ExtremesTest, GainsAndUnitsChangeNothing) {
  SensingCase usual;
  const SensingOutcome before = RunSensing(usual, kFrames);
  const double l0 = usual.truth.front_length_mm;
  const auto expect_same = [&](const SensingOutcome& after, double length,
                               double force) {
    int compared = 0;
    for (std::size_t i = 0; i < before.estimates.size(); ++i) {
      const FrameEstimate &one = before.estimates[i], &two = after.estimates[i];
      ASSERT_EQ(one.status, two.status) << i;
      if (one.status != FrameStatus::kOk) continue;
      ++compared;
      EXPECT_NEAR(two.contact[0].arc_mm / length, one.contact[0].arc_mm,
                  1e-11 * l0);
      EXPECT_NEAR(two.contact[0].normal_N / force / one.contact[0].normal_N, 1,
                  1e-10);
      EXPECT_NEAR(
          two.contact[0].normal_std_N / force / one.contact[0].normal_std_N, 1,
          1e-7);  // the table of a curved valley is less exact
    }
    EXPECT_GT(compared, 100);
  };
  for (const double gain : {1e-12, 1e12}) {
    SCOPED_TRACE(gain);
    SensingCase c;
    for (Gauge& gauge : c.truth.gauges) {
      gauge.gain_V_per_rad *= gain;
      gauge.noise_V *= gain;
    }
    c.told = c.truth;
    expect_same(RunSensing(c, kFrames), 1, 1);
  }
  // Softer fingers too, for which 0.03 N is a large force.
  for (const double force : {1e-6, 1e6}) {
    for (const double length : {1e-3, 1.0, 1e3}) {
      SCOPED_TRACE(testing::Message() << length << ", " << force);
      SensingCase c;
      c.truth = c.told = InUnits(c.truth, length, force);
      c.arc_spread_mm *= length;
      for (PointContact& place : c.places) {
        place.arc_mm *= length;
        place.normal_N *= force;
      }
      expect_same(RunSensing(c, kFrames), length, force);
    }
  }
}

// Doubling every gauge halves the variance if their noise is independent. If
// both copies carry the same noise, nothing is gained, but the reported std
// still shrink to 1 / sqrt(2): they then hold 52 %.
TEST(ExtremesTest, GaugesGivenTwice) {
  const auto layouts = GaugeLayouts();
  const auto std_of = [](const Finger& finger) {
    Scene scene;
    scene.contacts = 1;
    FrameEstimator estimator(finger, scene, {});
    EquilibriumSolver solver(finger, {});
    EXPECT_TRUE(solver.Solve({{75, 2, 0}}));
    const FrameEstimate estimate = estimator.Estimate(CleanReadings(solver));
    EXPECT_EQ(estimate.status, FrameStatus::kOk);
    return estimate.contact[0];
  };
  const ContactEstimate once = std_of(layouts[0].second);
  ASSERT_EQ(layouts[3].first, "all twice");
  const ContactEstimate twice = std_of(layouts[3].second);
  EXPECT_NEAR(twice.arc_std_mm * std::sqrt(2), once.arc_std_mm,
              1e-7 * once.arc_std_mm);
  EXPECT_NEAR(twice.normal_std_N * std::sqrt(2), once.normal_std_N,
              1e-7 * once.normal_std_N);
  SensingCase c;
  c.truth = c.told = layouts[3].second;
  const SensingOutcome noisy = RunSensing(c, 4 * kFrames);
  ExpectSound(noisy);
  EXPECT_NEAR(double(noisy.force_within[0]) / noisy.ok(), 0.683, 0.06);
  c.disturb = [](const Finger& told, std::mt19937_64* generator,
                 Measurements* readings) {
    *readings = WithNoise(*readings, told, generator);
    std::vector<double>& V = readings->gauges_V;
    for (std::size_t j = 0; j < V.size(); j += 2) V[j + 1] = V[j];
  };
  const SensingOutcome copied = RunSensing(c, 4 * kFrames);
  EXPECT_NEAR(double(copied.force_within[0]) / copied.ok(), 0.52, 0.06);
}

TEST(ExtremesTest, GaugesAtOnePlaceTellNothing) {
  int tried = 0;
  for (const auto& [name, finger] : GaugeLayouts()) {
    if (name.find("at one place") == std::string::npos &&
        name.find("mm apart") == std::string::npos) {
      continue;
    }
    SCOPED_TRACE(name);
    ++tried;
    SensingCase c;
    c.truth = c.told = finger;
    const SensingOutcome outcome = RunSensing(c, kFrames);
    EXPECT_EQ(outcome.count(FrameStatus::kUnobservable), outcome.frames);
  }
  EXPECT_GE(tried, 3);
}

// Two gauges cannot tell a wrong contact from the right one, so the search has
// to find all contacts that explain the readings. When it stopped at the first
// one, 30 % of the frames that were ok (the first pair) were elsewhere.
TEST(ExtremesTest, TwoGaugesFindTheirRivals) {
  for (const std::vector<int>& gauges : {std::vector<int>{0, 3}, {2, 3}}) {
    const Finger paper = PaperFinger();
    SensingCase c;
    c.truth.gauges = {paper.gauges[gauges[0]], paper.gauges[gauges[1]]};
    c.told = c.truth;
    const SensingOutcome outcome = RunSensing(c, 2 * kFrames);
    EXPECT_GT(outcome.ok(), 30);
    EXPECT_LE(outcome.over_6_std, 1);
    EXPECT_EQ(outcome.not_a_number, 0);
  }
}

TEST(ExtremesTest, OffsetsTakeTheirDigitsAndNoMore) {
  for (const double offset : {1e3, 1e6, 1e9}) {
    SCOPED_TRACE(offset);
    SensingCase c;
    for (Gauge& gauge : c.truth.gauges) gauge.offset_V = offset;
    c.told = c.truth;
    c.disturb = NoNoise;
    const SensingOutcome outcome = RunSensing(c, kFrames);
    ExpectSound(outcome);
    const double rounding = offset * 1.1e-16;
    EXPECT_GT(Quantile(outcome.arc_error, 0.5), rounding);
    EXPECT_LT(Quantile(outcome.arc_error, 1), 200 * rounding + 1e-11);
  }
}

TEST(ExtremesTest, ConvertersOfFewBits) {
  for (const int bits : {10, 12, 16}) {
    SCOPED_TRACE(bits);
    const double step = std::ldexp(2.0, -bits);
    SensingCase c;
    c.told = WithGaugeNoise(c.truth, step / std::sqrt(12.0));
    c.disturb = [step](const Finger&, std::mt19937_64*,
                       Measurements* readings) {
      for (double& V : readings->gauges_V) V = step * std::round(V / step);
    };
    const SensingOutcome outcome = RunSensing(c, 2 * kFrames);
    ExpectSound(outcome);
    EXPECT_GT(outcome.ok(), 0.68 * outcome.frames);
    EXPECT_NEAR(double(outcome.arc_within[1]) / outcome.ok(), 0.95, 0.04);
  }
}

}  // namespace
}  // namespace finray
