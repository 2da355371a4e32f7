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

// Touches that go in and half out again: friction pulls towards the tip, then
// towards the base. Both ways of a force sensor tell how much.
TEST(StaticsEffectsTest, FrictionTurnsRoundWithTheObject) {
  const FrameTable places = StandardFrames(HiddenFinger(), 46);
  FrameTable frames(places.rows());
  std::vector<double>& x = frames.MutableNumbers("object_x_mm");
  std::vector<double>& y = frames.MutableNumbers("object_y_mm");
  for (std::size_t i = 0; i < frames.rows(); ++i) {
    constexpr double kShares[] = {0.6, 1.0, 0.6};
    const std::size_t touch = i - i % 3;
    const double depth = places.Numbers("object_x_mm")[touch] + 15;
    x[i] = -15 + (depth > 0 ? kShares[i % 3] : 1) * depth;
    y[i] = 30 + 0.9 * (places.Numbers("object_y_mm")[touch] - 22);
  }
  Scene rough = StandardScene();
  rough.friction_coefficient = 0.3;
  rough.presliding_mm = 1e-3;
  ASSERT_EQ(Simulate(HiddenFinger(), rough, {}, &frames).not_converged, 0);
  const TempFolder folder;
  MakeLog(HiddenFinger(), frames, {0.02, 0.05, 46})
      .Write(folder.Path("log.csv"));
  Plan plan = StandardPlan();
  plan.scene.presliding_mm = 1e-3;
  Free(ParameterFamily::kFriction, &plan).prior_std = 0.3;
  Recovery with(Nominal(), plan, {folder.Path("log.csv")});
  with.ExpectFinger(HiddenFinger(), 0.06);
  with.Expect("friction_coefficient", 0.3, 0.02);
  EXPECT_NEAR(with.Chi2PerDof(ResidualFamily::kGauge), 1, 0.2);
  EXPECT_NEAR(with.Chi2PerDof(ResidualFamily::kForce), 1, 0.3);

  // A row's friction is that of the simulation, and how it follows the
  // coefficient is what another coefficient shows.
  CalibrationProblem& problem = with.problem();
  const CalibrationParameters& parameters = problem.parameters();
  const double found = parameters.friction();
  int forward = 0, backward = 0, near = 0;
  std::vector<RowFriction> rows;
  for (const CalibrationFrame& frame : problem.logs().frames) {
    rows.push_back(parameters.FrictionOf(frame));
    if (!frame.contact) continue;
    const double friction = rows.back().At(found);
    forward += friction > 0.9 * found;
    backward += friction < -0.9 * found;
    near += std::abs(friction - frames.Numbers("friction_1")[rows.size() - 1]) <
            0.03;
  }
  EXPECT_GT(forward, 80);
  EXPECT_GT(backward, 30);
  EXPECT_GT(near, 0.9 * (forward + backward));
  const int at = problem.parameters().free().size() - 1;
  ASSERT_EQ(parameters.FreeParameter(at).name, "friction_coefficient");
  Eigen::VectorXd values = problem.Values();
  values[at] += 2e-3;
  problem.SetValues(values);
  problem.KeepFriction();
  int same = 0, all = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const CalibrationFrame& frame = problem.logs().frames[i];
    if (!frame.contact) continue;
    ++all;
    same += std::abs(parameters.FrictionOf(frame).At(found + 2e-3) -
                     rows[i].At(found + 2e-3)) < 2e-4;
  }
  EXPECT_GT(same, 0.97 * all);
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
