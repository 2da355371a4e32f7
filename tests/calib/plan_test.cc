#include "finray/calib/problem/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "finray/io/error.h"
#include "temp_file.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

Plan Load(const std::string& text) {
  const TempFolder folder;
  return ReadPlan(folder.Write("plan.yaml", text));
}

TEST(PlanTest, ReadsEverything) {
  const Plan plan = Load(
      "schema_version: 1\n"
      "scene: {contacts: auto, object: {shape: circle, radius_mm: 15}}\n"
      "parameters:\n"
      "  front_stiffness: {prior_std_percent: 50}\n"
      "  gauge_gain:      {}\n"
      "  rib_length:      {prior_std_mm: 0.5}\n"
      "  gauge_offset:    {fixed: true}\n"
      "  gauge_drift:     {fixed: true}\n"
      "measurements: {force_std_N: 0.03, gauge_std_V: 0.001, object_std_mm: "
      "0.1, contact_std_mm: 0.2}\n"
      "robust_loss: {type: cauchy, scale: 3}\n"
      "holdout: {by: block, fraction: 0.25}\n");
  EXPECT_EQ(plan.scene.circle_radius_mm(), 15);
  EXPECT_EQ(plan.family(ParameterFamily::kFrontStiffness).prior_std, 50);
  EXPECT_TRUE(plan.family(ParameterFamily::kGaugeGain).free);
  EXPECT_FALSE(plan.family(ParameterFamily::kGaugeGain).prior_std.has_value());
  EXPECT_FALSE(plan.family(ParameterFamily::kGaugeOffset).free);
  EXPECT_FALSE(plan.family(ParameterFamily::kBackStiffness).free);
  EXPECT_EQ(plan.force_std_N, 0.03);
  EXPECT_EQ(plan.gauge_std_V, 0.001);
  EXPECT_EQ(plan.loss, RobustLoss::kCauchy);
  EXPECT_EQ(plan.holdout_by, HoldoutBy::kBlock);
}

TEST(PlanTest, ReadsParametersOfLogs) {
  const Plan plan = Load(
      "schema_version: 1\n"
      "parameters:\n"
      "  gauge_offset: {prior_std_V: 1, per_log: true}\n"
      "  object_origin: {per_log: true}\n"
      "  force_scale: {prior_std_percent: 5}\n"
      "  force_offset: {prior_std_N: 0.1}\n"
      "  temperature_coefficient: {prior_std_V_per_C: 0.01, reference_C: 25}\n"
      "  gauge_drift: {walk_std_V_per_sqrt_h: 0.02, knot_every_s: 60}\n"
      "measurements: {pin_std_mm: 0.5, tip_std_mm: 0.4}\n");
  EXPECT_TRUE(plan.family(ParameterFamily::kGaugeOffset).per_log);
  EXPECT_TRUE(plan.family(ParameterFamily::kObjectOrigin).per_log);
  EXPECT_EQ(plan.family(ParameterFamily::kForceScale).prior_std, 5);
  EXPECT_EQ(plan.family(ParameterFamily::kForceOffset).prior_std, 0.1);
  EXPECT_EQ(plan.reference_temperature_C, 25);
  ASSERT_TRUE(plan.gauge_walk);
  EXPECT_EQ(plan.gauge_walk->std_V_per_sqrt_h, 0.02);
  EXPECT_EQ(plan.gauge_walk->knot_every_s, 60);
  EXPECT_EQ(plan.pin_std_mm, 0.5);
  EXPECT_EQ(plan.tip_std_mm, 0.4);
}

TEST(PlanTest, SceneMayBeAFileBesideThePlan) {
  const TempFolder folder;
  folder.Write("scene.yaml", "object: {shape: circle, radius_mm: 7}\n");
  const Plan plan = ReadPlan(folder.Write(
      "plan.yaml",
      "schema_version: 1\nscene: scene.yaml\nparameters: {rib_length: {}}\n"));
  EXPECT_EQ(plan.scene.circle_radius_mm(), 7);
}

TEST(PlanTest, RefusesUnknownKeysAndUnits) {
  const auto error = [](const std::string& text, const std::string& message) {
    EXPECT_THAT([&] { Load("schema_version: 1\n" + text); },
                ThrowsMessage<InputError>(HasSubstr(message)));
  };
  error("parameters: {rib_lenght: {}}\n",
        "plan.yaml:2:14: unknown key 'rib_lenght' in parameters (did you mean "
        "'rib_length'?)");
  error("parameters: {rib_length: {prior_std_V: 1}}\n",
        "unknown key 'prior_std_V' in rib_length (did you mean "
        "'prior_std_mm'?)");
  error("parameters: {gauge_drift: {fixed: true, prior_std_V_per_h: 1}}\n",
        "plan.yaml:2:60: a fixed parameter has no prior_std_V_per_h");
  error("parameters: {gauge_drift: {walk_std_V_per_sqrt_h: 1}}\n",
        "'knot_every_s' is missing in gauge_drift");
  error(
      "parameters: {gauge_drift: {prior_std_V_per_h: 1, "
      "walk_std_V_per_sqrt_h: 1, knot_every_s: 60}}\n",
      "either at a rate");
  error("parameters: {gauge_gain: {per_log: true}}\n",
        "unknown key 'per_log' in gauge_gain");
  error("parameters: {}\nmeasurements: {pin_std_mm: 0}\n", "above 0");
  error("parameters: {rib_length: {prior_std_mm: -1}}\n", "a number above 0");
  error("parameters: {}\nholdout: {by: day}\n", "expected one of log, block");
  error("scene: {contacts: 2}\nparameters: {}\n", "one contact or none");
  // Keys that would do nothing.
  error(
      "scene: {gauge_offset_walk: {start_std_V: 1, std_V_per_sqrt_s: 1}}\n"
      "parameters: {}\n",
      "expected parameters: {gauge_drift: {walk_std_V_per_sqrt_h");
  error("scene: {measurements: {pin_std_mm: 1}}\nparameters: {}\n",
        "no measurements");
  error("parameters: {}\nrobust_loss: {type: none, scale: 2}\n",
        "plan.yaml:3:34: scale: type none has no scale");
  error(
      "scene: {object: {shape: ellipse, semi_axis_x_mm: 9, semi_axis_y_mm: "
      "8}}\nparameters: {}\n",
      "plan.yaml:2:8: calibration takes circles");
  error(
      "scene: {object: {shape: circle, radius_mm: 9, spring: "
      "{stiffness_N_per_mm: 1, direction_deg: 0}}}\nparameters: {}\n",
      "no other shape and no spring");
}

}  // namespace
}  // namespace finray
