#include "finray/calib/problem/parameters.h"

#include <gtest/gtest.h>

#include <cmath>

#include "calib/recovery.h"
#include "calib/standard_log.h"

namespace finray {
namespace {

std::string GaugeName(int j, const std::string& rest) {
  return "gauge_" + std::to_string(j + 1) + "_" + rest;
}

// Two hours in which it gets warmer and cooler.
void AddClock(FrameTable* log) {
  const std::size_t rows = log->rows();
  for (std::size_t i = 0; i < rows; ++i) {
    const double hours = 2.0 * i / (rows - 1);
    log->MutableNumbers("time_s")[i] = 1.7e9 + 3600 * hours;
    log->MutableNumbers("temperature_C")[i] = 22 + 4 * std::sin(4 * hours);
  }
}

TEST(ParametersTest, DriftAndTemperature) {
  const TempFolder folder;
  const Finger truth = HiddenFinger();
  const double rate[] = {0.01, -0.02, 0.005, 0.03};
  const double by_degree[] = {-0.002, 0.001, 0.003, 0.0015};
  FrameTable log = FrameTable::Read(StandardLog(folder, truth, 11));
  AddClock(&log);
  for (std::size_t i = 0; i < log.rows(); ++i) {
    const double hours = (log.Numbers("time_s")[i] - 1.7e9) / 3600;
    const double degrees = log.Numbers("temperature_C")[i] - 25;
    for (int j = 0; j < 4; ++j) {
      log.MutableNumbers(GaugeName(j, "V"))[i] +=
          rate[j] * hours + by_degree[j] * degrees;
    }
  }
  log.Write(folder.Path("drifting.csv"));
  Plan plan = StandardPlan();
  Free(ParameterFamily::kGaugeDrift, &plan).prior_std = 0.1;
  Free(ParameterFamily::kTemperatureCoefficient, &plan).prior_std = 0.01;
  plan.reference_temperature_C = 25;
  Recovery both(Nominal(), plan, {folder.Path("drifting.csv")});
  both.ExpectFinger(truth);
  for (int j = 0; j < 4; ++j) {
    both.Expect(GaugeName(j, "drift_V_per_h"), rate[j], 3e-4);
    both.Expect(GaugeName(j, "temperature_coefficient_V_per_C"), by_degree[j],
                1e-4);
    both.Expect(GaugeName(j, "offset_V"), truth.gauges[j].offset_V, 5e-3);
  }
  EXPECT_NEAR(both.Chi2PerDof(ResidualFamily::kGauge), 1, 0.15);

  // Corrected readings are those without drift, at 25 degrees.
  CalibrationParameters& parameters = both.problem().parameters();
  const Finger found = parameters.Apply(Nominal());
  const CalibrationLogs corrected =
      parameters.Corrected(both.problem().logs(), found);
  const FrameTable frames = StandardFrames(truth, 11);
  for (std::size_t i = 0; i < corrected.frames.size(); ++i) {
    for (int j = 0; j < 4; ++j) {
      EXPECT_NEAR(corrected.frames[i].gauges_V[j],
                  frames.Numbers(GaugeName(j, "V"))[i],
                  5 * truth.gauges[j].noise_V + 1e-3);
    }
  }

  // Without them the residuals say that something is missing.
  Recovery neither(Nominal(), StandardPlan(), {folder.Path("drifting.csv")});
  EXPECT_GT(neither.Chi2PerDof(ResidualFamily::kGauge), 20);
  EXPECT_FALSE(neither.Has("gauge_1_drift_V_per_h"));
}

TEST(ParametersTest, WanderingOffsets) {
  const TempFolder folder;
  const Finger truth = HiddenFinger();
  FrameTable log = FrameTable::Read(StandardLog(folder, truth, 12));
  AddClock(&log);
  constexpr int kSteps = 8;
  const double step_std = 0.02 * std::sqrt(2.0 / kSteps);
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal(0, step_std);
  double step[4][kSteps];
  for (auto& of_gauge : step) {
    for (double& change : of_gauge) change = normal(generator);
  }
  for (std::size_t i = 0; i < log.rows(); ++i) {
    const double at = (log.Numbers("time_s")[i] - 1.7e9) / 7200 * kSteps;
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < kSteps; ++k) {
        log.MutableNumbers(GaugeName(j, "V"))[i] +=
            step[j][k] * std::clamp(at - k, 0.0, 1.0);
      }
    }
  }
  log.Write(folder.Path("wandering.csv"));
  Plan plan = StandardPlan();
  Free(ParameterFamily::kGaugeDrift, &plan);
  plan.gauge_walk = {0.02, 7200.0 / kSteps};
  const Recovery walk(Nominal(), plan, {folder.Path("wandering.csv")});
  walk.ExpectFinger(truth);
  for (int j = 0; j < 4; ++j) {
    walk.Expect(GaugeName(j, "offset_V"), truth.gauges[j].offset_V, 6e-3);
    for (int k = 0; k < kSteps; ++k) {
      walk.Expect(
          GaugeName(j, "drift_" + std::to_string(k + 1) + "_V[wandering.csv]"),
          step[j][k], 0.3 * step_std);
    }
  }
  EXPECT_NEAR(walk.Chi2PerDof(ResidualFamily::kGauge), 1, 0.15);
}

// Of the magnitude, and of the components. What is known of stiffness tells the
// scale.
TEST(ParametersTest, ForceSensor) {
  const TempFolder folder;
  const Finger truth = HiddenFinger();
  const FrameTable frames = StandardFrames(truth, 13);
  FrameTable log = MakeLog(truth, frames, {0.02, 0.05, 13});
  std::mt19937_64 generator(6);
  std::normal_distribution<double> normal(0, 0.02);
  for (std::size_t i = 0; i < log.rows(); ++i) {
    log.MutableNumbers("force_N")[i] = 1.06 * log.Numbers("force_N")[i] + 0.15;
  }
  log.Write(folder.Path("magnitude.csv"));
  const auto& angle = frames.Numbers("contact_1_angle_rad");
  for (std::size_t i = 0; i < log.rows(); ++i) {
    const double force = frames.Numbers("force_N")[i];
    const bool touches = force > 0;
    log.MutableNumbers("force_x_N")[i] =
        1.06 * (touches ? force * std::sin(angle[i]) : 0) + 0.1 +
        normal(generator);
    log.MutableNumbers("force_y_N")[i] =
        1.06 * (touches ? -force * std::cos(angle[i]) : 0) - 0.2 +
        normal(generator);
    log.MutableNumbers("force_N")[i] = std::nan("");
  }
  log.Write(folder.Path("components.csv"));
  Plan plan = StandardPlan();
  for (const ParameterFamily family :
       {ParameterFamily::kFrontStiffness, ParameterFamily::kBackStiffness}) {
    plan.families[static_cast<int>(family)] = {};
  }
  Free(ParameterFamily::kForceScale, &plan).prior_std = 20;
  Free(ParameterFamily::kForceOffset, &plan).prior_std = 0.5;
  Finger start = Nominal();
  start.front_stiffness_N_mm2 = truth.front_stiffness_N_mm2;
  start.back_stiffness_N_mm2 = truth.back_stiffness_N_mm2;
  Recovery magnitude(start, plan, {folder.Path("magnitude.csv")});
  magnitude.Expect("force_scale", 1.06, 0.01);
  magnitude.Expect("force_offset_N", 0.15, 0.01);
  EXPECT_FALSE(magnitude.Has("force_offset_x_N"));
  EXPECT_NEAR(magnitude.Chi2PerDof(ResidualFamily::kForce), 1, 0.35);
  Recovery components(start, plan, {folder.Path("components.csv")});
  components.Expect("force_scale", 1.06, 0.01);
  components.Expect("force_offset_x_N", 0.1, 0.01);
  components.Expect("force_offset_y_N", -0.2, 0.01);
  EXPECT_FALSE(components.Has("force_offset_N"));

  // A true sensor again.
  CalibrationParameters& parameters = magnitude.problem().parameters();
  const CalibrationLogs corrected =
      parameters.Corrected(magnitude.problem().logs(), parameters.Apply(start));
  for (std::size_t i = 0; i < corrected.frames.size(); ++i) {
    EXPECT_NEAR(corrected.frames[i].force_N, frames.Numbers("force_N")[i], 0.2);
  }
}

TEST(ParametersTest, EachLogItsOwnOffsetsAndOrigin) {
  const TempFolder folder;
  const Finger truth = HiddenFinger();
  const double shift[2][2] = {{0.4, -0.3}, {-0.2, 0.25}};
  const double moved_V = 0.04;
  for (int k = 0; k < 2; ++k) {
    FrameTable log = FrameTable::Read(StandardLog(folder, truth, 14 + k));
    for (std::size_t i = 0; i < log.rows(); ++i) {
      log.MutableNumbers("object_x_mm")[i] -= shift[k][0];
      log.MutableNumbers("object_y_mm")[i] -= shift[k][1];
      if (k == 1) log.MutableNumbers("gauge_2_V")[i] += moved_V;
    }
    log.Write(folder.Path(k == 0 ? "a.csv" : "b.csv"));
  }
  Plan plan = StandardPlan();
  Free(ParameterFamily::kGaugeOffset, &plan).per_log = true;
  FamilyPlan& origin = Free(ParameterFamily::kObjectOrigin, &plan);
  origin.per_log = true;
  origin.prior_std = 1;
  const std::vector<std::string> logs = {folder.Path("a.csv"),
                                         folder.Path("b.csv")};
  Recovery each(Nominal(), plan, logs);
  each.ExpectFinger(truth);
  each.Expect("gauge_2_offset_V[a.csv]", truth.gauges[1].offset_V, 5e-3);
  each.Expect("gauge_2_offset_V[b.csv]", truth.gauges[1].offset_V + moved_V,
              5e-3);
  each.Expect("object_origin_x_mm[a.csv]", shift[0][0], 0.05);
  each.Expect("object_origin_y_mm[a.csv]", shift[0][1], 0.3);
  each.Expect("object_origin_x_mm[b.csv]", shift[1][0], 0.05);
  EXPECT_FALSE(each.Has("gauge_2_offset_V"));

  // The finger has the last log's, with its std.
  Finger found = each.problem().parameters().Apply(Nominal());
  EXPECT_NEAR(found.gauges[1].offset_V, truth.gauges[1].offset_V + moved_V,
              4 * each.Std("gauge_2_offset_V[b.csv]"));
  KeepCovariance(each.problem().parameters(), each.found(), &found);
  ASSERT_TRUE(found.calibration);
  const auto& known = found.calibration->parameters;
  ASSERT_EQ(known.size(), 15u);
  EXPECT_EQ(ParameterName(known[7]), "gauge_2_offset_V");
  EXPECT_DOUBLE_EQ(found.calibration->std[7],
                   each.Std("gauge_2_offset_V[b.csv]"));

  // A log that is held out has no say, and is zeroed in its free frames.
  plan.holdout_by = HoldoutBy::kLog;
  plan.holdout_fraction = 0.5;
  Recovery held_out(Nominal(), plan, logs);
  EXPECT_TRUE(held_out.Has("gauge_2_offset_V[a.csv]"));
  EXPECT_FALSE(held_out.Has("gauge_2_offset_V[b.csv]"));
  ZeroHeldOutLogs(&held_out.problem());
  CalibrationParameters& parameters = held_out.problem().parameters();
  EXPECT_NEAR(*parameters.readings.offset_V(1, 1),
              truth.gauges[1].offset_V + moved_V, 2e-3);
  EXPECT_NEAR(parameters.Apply(Nominal()).gauges[1].offset_V,
              truth.gauges[1].offset_V, 2e-3);
}

// What is known from the bench holds the gains where there is no place; the
// finger keeps its own offsets though the bench comes last.
TEST(ParametersTest, BenchBesideALogOfTheFinger) {
  const TempFolder folder;
  const Finger truth = HiddenFinger();
  FrameTable log = FrameTable::Read(StandardLog(folder, truth, 19));
  log.MutableNumbers("object_x_mm").assign(210, std::nan(""));
  log.Write(folder.Path("placeless.csv"));
  std::string rows =
      "cylinder_radius_mm,gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V\n";
  std::mt19937_64 generator(8);
  std::normal_distribution<double> normal;
  for (const char* radius : {"inf", "150", "100", "75", "inf", "150", "75"}) {
    rows += radius;
    for (const Gauge& gauge : truth.gauges) {
      const double bent = gauge.gain_V_per_rad * 18 / std::stod(radius);
      rows +=
          "," + std::to_string(0.5 + bent + gauge.noise_V * normal(generator));
    }
    rows += "\n";
  }
  const std::string bench = folder.Write("bench.csv", rows);
  Plan plan = StandardPlan();
  Free(ParameterFamily::kGaugeOffset, &plan).per_log = true;
  const Recovery alone(Nominal(), plan, {folder.Path("placeless.csv")});
  Recovery both(Nominal(), plan, {folder.Path("placeless.csv"), bench});
  both.ExpectFinger(truth, 0.2);
  both.Expect("gauge_3_offset_V[bench.csv]", 0.5, 1e-3);
  EXPECT_LT(both.Std("gauge_1_gain_V_per_rad"),
            0.5 * alone.Std("gauge_1_gain_V_per_rad"));
  EXPECT_NEAR(both.problem().parameters().Apply(Nominal()).gauges[2].offset_V,
              truth.gauges[2].offset_V, 0.01);
}

// Gains wrong by 3 either way, and one with the wrong sign.
TEST(ParametersTest, GainsArriveFromFarAway) {
  const TempFolder folder;
  const Finger truth = HiddenFinger();
  const std::string log = StandardLog(folder, truth, 16);
  Plan plan = StandardPlan();
  plan.families[static_cast<int>(ParameterFamily::kGaugeGain)].prior_std = {};
  const double factor[] = {3, 1.0 / 3, -1, 3};
  Finger start = Nominal();
  for (int j = 0; j < 4; ++j) {
    start.gauges[j].gain_V_per_rad = factor[j] * truth.gauges[j].gain_V_per_rad;
  }
  Recovery(start, plan, {log}).ExpectFinger(truth);
}

TEST(ParametersTest, PinsAndTipWithoutObject) {
  const TempFolder folder;
  const Finger truth = HiddenFinger();
  const FrameTable frames = StandardFrames(truth, 17);
  FrameTable log = MakeLog(truth, frames, {0.02, 0.05, 17, 0.1});
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal(0, 0.1);
  for (std::size_t i = 0; i < log.rows(); ++i) {
    log.MutableNumbers("object_x_mm")[i] = std::nan("");
    for (const char* axis : {"tip_x_mm", "tip_y_mm"}) {
      log.MutableNumbers(axis)[i] = frames.Numbers(axis)[i] + normal(generator);
    }
  }
  // A camera that counts from (0.7, -1.1).
  for (const std::string& name : log.headers()) {
    if (name.rfind("rib", 0) != 0 && name.rfind("tip", 0) != 0) continue;
    const double origin = name[name.size() - 4] == 'x' ? 0.7 : -1.1;
    for (double& value : log.MutableNumbers(name)) value -= origin;
  }
  log.Write(folder.Path("seen.csv"));
  Plan plan = StandardPlan();
  plan.pin_std_mm = plan.tip_std_mm = 0.1;
  Free(ParameterFamily::kCameraOrigin, &plan).prior_std = 2;
  const Recovery seen(Nominal(), plan, {folder.Path("seen.csv")});
  seen.ExpectFinger(truth);
  seen.Expect("camera_origin_x_mm", 0.7, 0.03);
  seen.Expect("camera_origin_y_mm", -1.1, 0.03);
  EXPECT_NEAR(seen.Chi2PerDof(ResidualFamily::kPin), 1, 0.08);
  EXPECT_NEAR(seen.Chi2PerDof(ResidualFamily::kTip), 1, 0.3);
}

// A finger without gauges: camera and force sensor tell stiffness and ribs.
TEST(ParametersTest, PinsWithoutGauges) {
  const TempFolder folder;
  const Finger truth = HiddenFinger();
  FrameTable all =
      MakeLog(truth, StandardFrames(truth, 18), {0.02, 0.05, 18, 0.1});
  FrameTable log(all.rows());
  for (const std::string& name : all.headers()) {
    if (name.rfind("gauge", 0) == 0) continue;
    log.MutableNumbers(name) = all.Numbers(name);
  }
  log.Write(folder.Path("pins.csv"));
  Plan plan = StandardPlan();
  plan.pin_std_mm = 0.1;
  for (const ParameterFamily family :
       {ParameterFamily::kGaugeGain, ParameterFamily::kGaugeOffset}) {
    plan.families[static_cast<int>(family)] = {};
  }
  const Recovery seen(Nominal(), plan, {folder.Path("pins.csv")});
  seen.Expect("front_stiffness_N_mm2", truth.front_stiffness_N_mm2, 200);
  seen.Expect("back_stiffness_N_mm2", truth.back_stiffness_N_mm2, 250);
  for (int i = 0; i < 5; ++i) {
    seen.Expect("rib_" + std::to_string(i + 1) + "_length_mm",
                truth.ribs[i].length_mm, 0.05);
  }
}

}  // namespace
}  // namespace finray
