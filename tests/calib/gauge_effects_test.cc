// Effects of the gauges that a plan may free: curve, place, creep, hysteresis.

#include <gtest/gtest.h>

#include <cmath>

#include "calib/recovery.h"
#include "calib/standard_log.h"
#include "finray/batch/batch_estimation.h"
#include "finray/io/error.h"
#include "finray/scene/measurement_columns.h"

namespace finray {
namespace {

std::string Name(int gauge, const std::string& rest) {
  return "gauge_" + std::to_string(gauge + 1) + "_" + rest;
}

// That the intervals of forces in another log, estimated from gauges alone by
// both solvers, hold about as often as they say.
void ExpectCoverage(const Finger& truth, const Finger& found, unsigned seed) {
  const FrameTable frames = StandardFrames(truth, seed);
  const FrameTable log = MakeLog(truth, frames, {0, 0, seed});
  const std::vector<Measurements> rows = ReadMeasurements(log, found);
  Scene scene;
  scene.contacts = 1;
  const std::vector<FrameEstimate> fast =
      EstimateFrames(found, scene, {}, rows, 2);
  const FrameSolver ceres =
      FrameSolvers(found, scene, {}, FrameMethod::kCeresReduced)();
  int usable = 0, within = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double force = frames.Numbers("force_N")[i];
    if (fast[i].status != FrameStatus::kOk || force < 0.3) continue;
    const auto& contact = fast[i].contact[0];
    ++usable;
    within += std::abs(contact.normal_N - force) < 1.96 * contact.normal_std_N;
    if (i % 20 != 1) continue;
    FrameEstimate slow;
    ceres(&rows[i], 1, &slow);
    EXPECT_NEAR(slow.contact[0].normal_N, contact.normal_N,
                0.05 * contact.normal_std_N);
    EXPECT_NEAR(slow.contact[0].normal_std_N, contact.normal_std_N,
                0.03 * contact.normal_std_N);
  }
  EXPECT_GT(usable, 100);
  EXPECT_GT(within, 0.85 * usable);
}

TEST(GaugeEffectsTest, Curve) {
  const TempFolder folder;
  Finger truth = HiddenFinger();
  const double curvatures[] = {0.5, -0.4, 0.8, -0.6};
  for (int j = 0; j < 4; ++j) {
    truth.gauges[j].curvature_per_rad = curvatures[j];
  }
  const std::string log = StandardLog(folder, truth, 31);
  Plan plan = StandardPlan();
  const Recovery without(Nominal(), plan, {log});
  Free(ParameterFamily::kGaugeCurvature, &plan).prior_std = 1;
  Recovery with(Nominal(), plan, {log});
  with.ExpectFinger(truth);
  for (int j = 0; j < 4; ++j) {
    with.Expect(Name(j, "curvature_per_rad"), curvatures[j], 0.3);
  }
  EXPECT_FALSE(without.Has("gauge_1_curvature_per_rad"));
  EXPECT_GT(without.Chi2(), with.Chi2() + 300);
  EXPECT_NEAR(with.Chi2PerDof(ResidualFamily::kGauge), 1, 0.2);

  // The finger that it finds estimates another log, with intervals that hold.
  Finger found = with.problem().parameters().Apply(Nominal());
  KeepCovariance(with.problem().parameters(), with.found(), &found);
  EXPECT_EQ(found.calibration->parameters.size(), 19u);
  ExpectCoverage(truth, found, 32);
}

TEST(GaugeEffectsTest, LessSensitiveWhenFlat) {
  const TempFolder folder;
  Finger truth = HiddenFinger();
  const double shares[] = {0.2, 0.1, -0.1, 0.25};
  for (int j = 0; j < 4; ++j) {
    truth.gauges[j].flat_share = shares[j];
    truth.gauges[j].flat_width_rad = 0.02;
  }
  const std::string log = StandardLog(folder, truth, 41);
  Plan plan = StandardPlan();
  const Recovery without(Nominal(), plan, {log});
  Free(ParameterFamily::kGaugeFlatShare, &plan).prior_std = 0.2;
  Free(ParameterFamily::kGaugeFlatWidth, &plan).prior_std = 50;
  Recovery with(Nominal(), plan, {log});
  for (int j = 0; j < 4; ++j) {
    with.Expect(Name(j, "flat_share"), shares[j], 0.15);
  }
  EXPECT_GT(without.Chi2(), with.Chi2() + 300);
  EXPECT_NEAR(with.Chi2PerDof(ResidualFamily::kGauge), 1, 0.2);
  Finger found = with.problem().parameters().Apply(Nominal());
  KeepCovariance(with.problem().parameters(), with.found(), &found);
  ExpectCoverage(truth, found, 42);
}

TEST(GaugeEffectsTest, Hysteresis) {
  const TempFolder folder;
  Finger truth = HiddenFinger();
  const double widths[] = {1e-3, 0.5e-3, 1.5e-3, 0.8e-3};
  for (int j = 0; j < 4; ++j) truth.gauges[j].hysteresis_rad = widths[j];
  const std::string log = StandardLog(folder, truth, 43);
  Plan plan = StandardPlan();
  const Recovery without(Nominal(), plan, {log});
  Free(ParameterFamily::kGaugeHysteresis, &plan).prior_std = 1e-3;
  Recovery with(Nominal(), plan, {log});
  with.ExpectFinger(truth);
  for (int j = 0; j < 4; ++j) {
    with.Expect(Name(j, "hysteresis_rad"), widths[j], 1e-4);
  }
  EXPECT_GT(without.Chi2(), with.Chi2() + 300);
  EXPECT_LT(with.Chi2PerDof(ResidualFamily::kGauge), 1.2);
}

TEST(GaugeEffectsTest, Place) {
  const TempFolder folder;
  Finger truth = HiddenFinger();
  const double moved[] = {1, -0.8, 0.6, -1.1};
  for (int j = 0; j < 4; ++j) truth.gauges[j].start_mm += moved[j];
  truth.gauges[1].length_mm += 0.5;
  const std::string log = StandardLog(folder, truth, 33);
  Plan plan = StandardPlan();
  const Recovery without(Nominal(), plan, {log});
  Free(ParameterFamily::kGaugeStart, &plan).prior_std = 1;
  Free(ParameterFamily::kGaugeLength, &plan).prior_std = 0.5;
  Recovery with(Nominal(), plan, {log});
  with.Expect("front_stiffness_N_mm2", truth.front_stiffness_N_mm2, 300);
  with.Expect("back_stiffness_N_mm2", truth.back_stiffness_N_mm2, 400);
  for (int j = 0; j < 4; ++j) {
    // A longer gauge reads almost like one of a larger gain.
    with.Expect(Name(j, "gain_V_per_rad"), truth.gauges[j].gain_V_per_rad, 0.1);
    with.Expect(Name(j, "start_mm"), truth.gauges[j].start_mm, 0.6);
    with.Expect(Name(j, "length_mm"), truth.gauges[j].length_mm, 0.6);
  }
  EXPECT_GT(without.Chi2(), with.Chi2() + 50);
  Finger found = with.problem().parameters().Apply(Nominal());
  KeepCovariance(with.problem().parameters(), with.found(), &found);
  ExpectCoverage(truth, found, 34);
}

TEST(GaugeEffectsTest, Creep) {
  const TempFolder folder;
  Finger truth = HiddenFinger();
  const double shares[] = {0.08, 0.05, -0.04, 0.1};
  for (int j = 0; j < 4; ++j) {
    truth.gauges[j].creep_share = shares[j];
    truth.gauges[j].creep_time_constant_s = 20;
  }
  FrameTable frames = StandardFrames(HiddenFinger(), 35);
  for (std::size_t i = 0; i < frames.rows(); ++i) {
    frames.MutableNumbers("time_s")[i] = 3.0 * static_cast<double>(i);
  }
  ASSERT_EQ(Simulate(truth, StandardScene(), {}, &frames).not_converged, 0);
  MakeLog(truth, frames, {0.02, 0.05, 35}).Write(folder.Path("log.csv"));
  const std::string log = folder.Path("log.csv");
  Plan plan = StandardPlan();
  const Recovery without(Nominal(), plan, {log});
  Free(ParameterFamily::kGaugeCreepShare, &plan).prior_std = 0.2;
  Free(ParameterFamily::kGaugeCreepTime, &plan).prior_std = 100;
  Recovery with(Nominal(), plan, {log});
  with.ExpectFinger(truth);
  for (int j = 0; j < 4; ++j) {
    with.Expect(Name(j, "creep_share"), shares[j], 0.02);
    with.Expect(Name(j, "creep_time_constant_s"), 20, 8);
  }
  EXPECT_GT(without.Chi2(), with.Chi2() + 300);
  EXPECT_NEAR(with.Chi2PerDof(ResidualFamily::kGauge), 1, 0.2);

  // Corrected readings are those of gauges that do not creep.
  CalibrationParameters& parameters = with.problem().parameters();
  const CalibrationLogs corrected =
      parameters.Corrected(with.problem().logs(), parameters.Apply(Nominal()));
  const FrameTable plain = StandardFrames(HiddenFinger(), 35);
  for (std::size_t i = 0; i < corrected.frames.size(); ++i) {
    for (int j = 0; j < 4; ++j) {
      EXPECT_NEAR(corrected.frames[i].gauges_V[j],
                  plain.Numbers(Name(j, "V"))[i], 5e-3);
    }
  }
}

TEST(GaugeEffectsTest, CreepNeedsTime) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, HiddenFinger(), 36);
  Plan plan = StandardPlan();
  Free(ParameterFamily::kGaugeCreepShare, &plan).prior_std = 0.2;
  EXPECT_THROW(ReadCalibrationLogs({log}, Nominal(), plan), InputError);
}

}  // namespace
}  // namespace finray
