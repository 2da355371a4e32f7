// Effects inside the equilibrium that a plan may free.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "calib/expect_forces.h"
#include "calib/recovery.h"
#include "calib/standard_log.h"
#include "finray/io/error.h"

namespace finray {
namespace {

constexpr char kHinges[] = "hinge_stiffness_N_mm_per_rad";

TEST(StaticsEffectsTest, HingeStiffness) {
  const TempFolder folder;
  Finger truth = HiddenFinger();
  SetParameter({FingerParameterKind::kHingeStiffness}, 40, &truth);
  const std::string log = StandardLog(folder, truth, 41);
  Plan plan = StandardPlan();
  const Recovery without(Nominal(), plan, {log});
  Free(ParameterFamily::kHingeStiffness, &plan).prior_std = 50;
  Recovery with(Nominal(), plan, {log});
  with.ExpectFinger(truth);
  with.Expect(kHinges, 40, 5);
  EXPECT_LT(std::abs(with.Value(kHinges) - 40), 3 * with.Std(kHinges));
  EXPECT_FALSE(without.Has(kHinges));
  EXPECT_GT(without.Chi2(), with.Chi2() + 300);
  EXPECT_NEAR(with.Chi2PerDof(ResidualFamily::kGauge), 1, 0.2);

  // The finger that it finds estimates another log, with intervals that hold.
  Finger found = with.problem().parameters().Apply(Nominal());
  EXPECT_EQ(found.ribs[4].back_hinge_N_mm_per_rad, with.Value(kHinges));
  KeepCovariance(with.problem().parameters(), with.found(), &found);
  EXPECT_EQ(found.calibration->parameters.size(), 16u);
  ExpectForces(truth, found, 42);
}

// A finger without springs is told to have none.
TEST(StaticsEffectsTest, NoHingeStiffness) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, HiddenFinger(), 43);
  Plan plan = StandardPlan();
  Free(ParameterFamily::kHingeStiffness, &plan).prior_std = 50;
  const Recovery with(Nominal(), plan, {log});
  with.Expect(kHinges, 0, 5);
  with.ExpectFinger(HiddenFinger());
}

// Frames pressed with friction, of which the scene knows nothing. A sensor of
// components sees it.
TEST(StaticsEffectsTest, Friction) {
  const TempFolder folder;
  Scene scene = StandardScene();
  scene.friction_coefficient = 0.3;
  const FrameTable frames = StandardFrames(HiddenFinger(), 45, scene);
  MakeLog(HiddenFinger(), frames, {0.02, 0.05, 45})
      .Write(folder.Path("log.csv"));
  const std::string log = folder.Path("log.csv");
  Plan plan = StandardPlan();
  const Recovery without(Nominal(), plan, {log});
  Free(ParameterFamily::kFriction, &plan).prior_std = 0.3;
  Recovery with(Nominal(), plan, {log});
  with.ExpectFinger(HiddenFinger());
  with.Expect("friction_coefficient", 0.3, 0.05);
  EXPECT_GT(without.Chi2(), with.Chi2() + 100);
  EXPECT_NEAR(with.Chi2PerDof(ResidualFamily::kGauge), 1, 0.2);
  const CalibrationParameters& parameters = with.problem().parameters();
  EXPECT_EQ(parameters.Corrected(plan).scene.friction_coefficient,
            with.Value("friction_coefficient"));

  // Together with an effect of the finger, in one block with it, where one has
  // a prior and the other has none.
  Free(ParameterFamily::kHingeStiffness, &plan);
  Free(ParameterFamily::kFriction, &plan).prior_std.reset();
  const Recovery both(Nominal(), plan, {log});
  both.Expect("friction_coefficient", 0.3, 0.06);
  both.Expect(kHinges, 0, 10);
}

// Beams that taper by 10 % from base to tip.
TEST(StaticsEffectsTest, StiffnessPieces) {
  const TempFolder folder;
  Plan plan = StandardPlan();
  Free(ParameterFamily::kFrontPiece, &plan).prior_std = 10;
  Free(ParameterFamily::kBackPiece, &plan).prior_std = 10;
  Finger truth = plan.CutIntoPieces(HiddenFinger());
  ASSERT_EQ(truth.front_pieces.size(), 5u);
  for (int i = 1; i < 5; ++i) {
    truth.front_pieces[i].stiffness_ratio = 1 - 0.025 * i;
    truth.back_pieces[i].stiffness_ratio = 1 - 0.025 * i;
  }
  const std::string log = StandardLog(folder, truth, 46);
  const Recovery without(Nominal(), StandardPlan(), {log});
  Recovery with(Nominal(), plan, {log});
  for (int i = 1; i < 5; ++i) {
    for (const auto kind :
         {FingerParameterKind::kFrontPiece, FingerParameterKind::kBackPiece}) {
      with.Expect(ParameterName({kind, i}), ParameterValue(truth, {kind, i}),
                  0.11);
    }
  }
  with.Expect("front_stiffness_N_mm2", truth.front_stiffness_N_mm2, 1500);
  with.Expect("back_stiffness_N_mm2", truth.back_stiffness_N_mm2, 1500);
  EXPECT_GT(without.Chi2(), with.Chi2() + 50);
  EXPECT_NEAR(with.Chi2PerDof(ResidualFamily::kGauge), 1, 0.2);
  Finger found =
      with.problem().parameters().Apply(plan.CutIntoPieces(Nominal()));
  KeepCovariance(with.problem().parameters(), with.found(), &found);
  ExpectForces(truth, found, 47);
}

TEST(StaticsEffectsTest, HingesThatShareAValueMustAgree) {
  const TempFolder folder;
  Finger finger = Nominal();
  finger.ribs[1].front_hinge_N_mm_per_rad = 20;
  const std::string log = StandardLog(folder, finger, 44);
  Plan plan = StandardPlan();
  Free(ParameterFamily::kHingeStiffness, &plan).prior_std = 50;
  EXPECT_THROW(Recovery(finger, plan, {log}), InputError);
}

}  // namespace
}  // namespace finray
