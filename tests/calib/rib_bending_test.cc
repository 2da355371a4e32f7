// A one-piece finger: the stiffness of ribs that bend as a free parameter.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "calib/expect_forces.h"
#include "calib/recovery.h"
#include "calib/standard_log.h"
#include "finray/calib/analysis/candidate_effects.h"
#include "finray/io/error.h"

namespace finray {
namespace {

constexpr char kRibBending[] = "rib_bending_stiffness_N_mm2";

Finger OnePiece(Finger finger, double stiffness) {
  for (Rib& rib : finger.ribs) {
    rib.bending_stiffness_N_mm2 = stiffness;
    rib.front_hinge_N_mm_per_rad = rib.back_hinge_N_mm_per_rad =
        std::numeric_limits<double>::infinity();
    rib.front_rigid_mm = rib.back_rigid_mm = 0.6;
  }
  finger.ribs[4].bending_stiffness_N_mm2 *= 0.5;
  return finger;
}

bool HasCandidate(const Finger& finger, ParameterFamily family) {
  const auto all = CandidatesFor(finger, StandardPlan(), {});
  return std::any_of(all.begin(), all.end(), [family](const auto& effect) {
    return effect.family == family;
  });
}

TEST(RibBendingTest, IsFoundAndEstimatesForces) {
  const TempFolder folder;
  const Finger truth = OnePiece(HiddenFinger(), 2000);
  const std::string log = StandardLog(folder, truth, 51);
  Plan plan = StandardPlan();
  const Recovery without(OnePiece(Nominal(), 2800), plan, {log});
  Free(ParameterFamily::kRibBending, &plan).prior_std = 50;
  Recovery with(OnePiece(Nominal(), 2800), plan, {log});
  with.Expect(kRibBending, 2000, 200);
  with.Expect("front_stiffness_N_mm2", truth.front_stiffness_N_mm2, 400);
  with.Expect("back_stiffness_N_mm2", truth.back_stiffness_N_mm2, 400);
  EXPECT_GT(without.Chi2(), with.Chi2() + 100);
  EXPECT_NEAR(with.Chi2PerDof(ResidualFamily::kGauge), 1, 0.2);

  // Ribs keep their ratio, and all solvers agree with the finger found.
  Finger found = with.problem().parameters().Apply(OnePiece(Nominal(), 2800));
  EXPECT_NEAR(found.ribs[4].bending_stiffness_N_mm2,
              found.ribs[0].bending_stiffness_N_mm2 / 2, 1e-9);
  KeepCovariance(with.problem().parameters(), with.found(), &found);
  ExpectForces(truth, found, 52);
}

TEST(RibBendingTest, IsACandidateOnlyWhereRibsBend) {
  const Finger one_piece = OnePiece(Nominal(), 2000);
  EXPECT_TRUE(HasCandidate(one_piece, ParameterFamily::kRibBending));
  EXPECT_FALSE(HasCandidate(one_piece, ParameterFamily::kHingeStiffness));
  EXPECT_FALSE(HasCandidate(Nominal(), ParameterFamily::kRibBending));
  EXPECT_TRUE(HasCandidate(Nominal(), ParameterFamily::kHingeStiffness));
}

TEST(RibBendingTest, RefusesWhatTheFingerLacks) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, HiddenFinger(), 53);
  const auto expect_refused = [&](const Finger& finger, ParameterFamily family,
                                  const std::string& words) {
    Plan plan = StandardPlan();
    Free(family, &plan);
    try {
      const CalibrationProblem problem(
          finger, plan, ReadCalibrationLogs({log}, finger, plan), {}, 1);
      FAIL();
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos)
          << error.what();
    }
  };
  expect_refused(OnePiece(Nominal(), 2000), ParameterFamily::kHingeStiffness,
                 "ribs are clamped to the beams");
  expect_refused(Nominal(), ParameterFamily::kRibBending,
                 "no rib has a bending_stiffness_N_mm2");
}

}  // namespace
}  // namespace finray
