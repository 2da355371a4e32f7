// Places of hinges, clamps, the back angle and a surface that a plan may free.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "calib/expect_forces.h"
#include "calib/recovery.h"
#include "calib/standard_log.h"
#include "finray/calib/analysis/explore.h"
#include "finray/calib/report/calibration_result.h"

namespace finray {
namespace {

using Kind = FingerParameterKind;

Finger WithMovedHinges() {
  Finger finger = HiddenFinger();
  for (std::size_t i = 0; i < finger.ribs.size(); ++i) {
    finger.ribs[i].front_mm += i % 2 == 0 ? 0.5 : -0.5;
    finger.ribs[i].back_mm += i < 3 ? -0.5 : 0.5;
  }
  return finger;
}

void FreeWithPrior(ParameterFamily front, double prior_std, Plan* plan) {
  for (int i = 0; i < kParameterFamilies; ++i) {
    const auto family = static_cast<ParameterFamily>(i);
    if (FrontFamilyOf(family) == front)
      Free(family, plan).prior_std = prior_std;
  }
}

// That the truth is within 3 std.
void ExpectNear(const Recovery& found, const FingerParameter& parameter,
                const Finger& truth, double largest_std) {
  const std::string name = ParameterName(parameter);
  found.Expect(name, ParameterValue(truth, parameter), largest_std);
  EXPECT_LT(std::abs(found.Value(name) - ParameterValue(truth, parameter)),
            3 * found.Std(name))
      << name;
}

// The finger that it finds estimates another log, with intervals that hold.
void ExpectEstimates(const Finger& truth, Recovery* with, unsigned seed,
                     const Scene& scene = StandardScene()) {
  Finger found = with->problem().parameters().Apply(Nominal());
  KeepCovariance(with->problem().parameters(), with->found(), &found);
  ExpectForces(truth, found, seed, scene);
}

TEST(GeometryEffectsTest, MovedHinges) {
  const TempFolder folder;
  const Finger truth = WithMovedHinges();
  const std::string log = StandardLog(folder, truth, 51);
  Plan plan = StandardPlan();
  const Recovery without(Nominal(), plan, {log});
  FreeWithPrior(ParameterFamily::kFrontHinge, 0.5, &plan);
  Recovery with(Nominal(), plan, {log});
  for (int i = 0; i < 5; ++i) {
    ExpectNear(with, {Kind::kFrontHinge, i}, truth, 0.5);
    ExpectNear(with, {Kind::kBackHinge, i}, truth, 0.5);
  }
  EXPECT_GT(without.Chi2(), with.Chi2() + 100);
  EXPECT_NEAR(with.Chi2PerDof(ResidualFamily::kGauge), 1, 0.2);
  ExpectEstimates(truth, &with, 52);
}

TEST(GeometryEffectsTest, ExploreNamesMovedHinges) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, WithMovedHinges(), 53);
  CalibrationProblem problem(
      Nominal(), StandardPlan(),
      ReadCalibrationLogs({log}, Nominal(), StandardPlan()), {}, 2);
  const Exploration found = Explore(&problem);
  ASSERT_FALSE(found.steps.empty());
  EXPECT_EQ(found.steps[0].effect.family, ParameterFamily::kFrontHinge);
  EXPECT_TRUE(found.steps[0].kept);
  const Plan plan = Freed(StandardPlan(), found.steps[0].effect);
  EXPECT_TRUE(plan.family(ParameterFamily::kBackHinge).free);
}

TEST(GeometryEffectsTest, Clamps) {
  const TempFolder folder;
  Finger truth = HiddenFinger();
  truth.front_clamp_rad_per_N_mm = 2e-4;
  truth.back_clamp_rad_per_N_mm = 4e-4;
  const std::string log = StandardLog(folder, truth, 54);
  Plan plan = StandardPlan();
  const Recovery without(Nominal(), plan, {log});
  FreeWithPrior(ParameterFamily::kFrontClamp, 3e-4, &plan);
  Recovery with(Nominal(), plan, {log});
  ExpectNear(with, {Kind::kFrontClamp}, truth, 1.5e-4);
  ExpectNear(with, {Kind::kBackClamp}, truth, 1.5e-4);
  EXPECT_GT(without.Chi2(), with.Chi2() + 50);
  ExpectEstimates(truth, &with, 55);
}

TEST(GeometryEffectsTest, AClampBelowZeroCountsAsRigid) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, HiddenFinger(), 56);
  Plan plan = StandardPlan();
  FreeWithPrior(ParameterFamily::kFrontClamp, 3e-4, &plan);
  Recovery with(Nominal(), plan, {log});
  ExpectNear(with, {Kind::kFrontClamp}, HiddenFinger(), 1.5e-4);
  ExpectNear(with, {Kind::kBackClamp}, HiddenFinger(), 1.5e-4);
  for (const CalibrationParameter& p : with.problem().parameters().all()) {
    if (p.of_finger && IsAtLeastZero(p.of_finger->kind)) *p.variable = -1e-5;
  }
  const Finger applied = with.problem().parameters().Apply(Nominal());
  EXPECT_EQ(applied.front_clamp_rad_per_N_mm, 0);
  EXPECT_EQ(applied.back_clamp_rad_per_N_mm, 0);
}

TEST(GeometryEffectsTest, BackAngle) {
  const TempFolder folder;
  Finger truth = HiddenFinger();
  SetParameter({Kind::kBackAngle}, 112.5, &truth);
  const std::string log = StandardLog(folder, truth, 57);
  Plan plan = StandardPlan();
  Free(ParameterFamily::kBackAngle, &plan).prior_std = 0.5;
  Recovery with(Nominal(), plan, {log});
  ExpectNear(with, {Kind::kBackAngle}, truth, 0.5);
  EXPECT_NEAR(with.Chi2PerDof(ResidualFamily::kGauge), 1, 0.2);
  ExpectEstimates(truth, &with, 58);
}

TEST(GeometryEffectsTest, SurfaceOffset) {
  const TempFolder folder;
  Finger truth = HiddenFinger();
  truth.front_surface_mm = 0.8;
  Scene scene = StandardScene();
  scene.friction_coefficient = 0.3;
  MakeLog(truth, StandardFrames(truth, 59, scene), {0.02, 0.05, 59})
      .Write(folder.Path("log.csv"));
  const std::string log = folder.Path("log.csv");
  Plan plan = StandardPlan();
  plan.scene = scene;
  const Recovery without(Nominal(), plan, {log});
  Free(ParameterFamily::kSurfaceOffset, &plan).prior_std = 1;
  Recovery with(Nominal(), plan, {log});
  ExpectNear(with, {Kind::kSurfaceOffset}, truth, 0.2);
  EXPECT_GT(without.Chi2(), with.Chi2() + 50);
  ExpectEstimates(truth, &with, 60, scene);
}

}  // namespace
}  // namespace finray
