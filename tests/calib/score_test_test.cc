#include "finray/calib/analysis/score_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "calib/calibrated.h"
#include "calib/turned_stage.h"
#include "finray/calib/analysis/cross_validation.h"
#include "finray/calib/analysis/refit.h"
#include "finray/calib/solve/summed_solve.h"
#include "finray/finger/geometry.h"

namespace finray {
namespace {

ScoreTest ScoresOf(Calibrated* calibrated) {
  return TestScores(*calibrated->problem, calibrated->found,
                    LinearizeWide(*calibrated->problem, calibrated->solution));
}

const ScoreTest::Effect* Find(const ScoreTest& score, ParameterFamily family) {
  for (const ScoreTest::Effect& effect : score.effects) {
    if (effect.family == family) return &effect;
  }
  return nullptr;
}

double Cost(const Calibrated& at) {
  return SumsWithPriors(at.solution.at, at.problem->parameters()).cost;
}

TEST(ScoreTestTest, EveryFamilyIsACandidate) {
  std::size_t shared = 0;
  for (int i = 0; i < kParameterFamilies; ++i) {
    const auto family = static_cast<ParameterFamily>(i);
    if (FrontFamilyOf(family) != family) ++shared;
    EXPECT_GT(CandidateOf(family).prior_std, 0);
  }
  EXPECT_EQ(AllCandidateEffects().size() + shared,
            static_cast<std::size_t>(kParameterFamilies));
}

// What Apply keeps from going below 0 is impossible there.
TEST(ScoreTestTest, WhatIsAtLeastZeroHasThatBound) {
  for (int i = 0; i < kFingerParameterKinds; ++i) {
    if (!IsAtLeastZero(static_cast<FingerParameterKind>(i))) continue;
    EXPECT_EQ(CandidateOf(static_cast<ParameterFamily>(i)).least, 0) << i;
  }
}

// 5 % stiffer than on average at the base of both beams, 5 % softer at the tip.
TEST(ScoreTestTest, BeamsThatTaperAreNamedFirst) {
  Finger tapered = HiddenFinger();
  for (auto* pieces : {&tapered.front_pieces, &tapered.back_pieces}) {
    const Side side =
        pieces == &tapered.front_pieces ? Side::kFront : Side::kBack;
    for (int k = 1; k <= 20; ++k) {
      pieces->push_back(
          {BeamLength(tapered, side) * k / 20, 1.05 - 0.1 * (k - 0.5) / 20});
    }
  }
  const TempFolder folder;
  Calibrated calibrated(StandardPlan(), {StandardLog(folder, tapered, 51)});
  const ScoreTest score = ScoresOf(&calibrated);
  ASSERT_NE(score.Best(), nullptr);
  EXPECT_EQ(score.Best()->family, ParameterFamily::kFrontPiece);
  EXPECT_EQ(score.Best()->values.size(), 8u);
}

// Readings on cylinders are linear in offsets, so the first order is all.
TEST(ScoreTestTest, IsExactWhereReadingsAreLinear) {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  const Finger finger = Nominal();
  FrameTable log(40);
  for (int j = 0; j < 4; ++j) {
    const Gauge& gauge = finger.gauges[j];
    for (int i = 0; i < 40; ++i) {
      // Half of the rows are flat: too many for outliers, and they tell an
      // offset from a curve.
      const double radius = i % 2 == 0 ? 1e12 : 40 + 10 * (i % 5);
      log.MutableNumbers("cylinder_radius_mm")[i] = radius;
      log.MutableNumbers("gauge_" + std::to_string(j + 1) + "_V")[i] =
          0.01 * (j == 2) + 1.02 * gauge.length_mm / radius +
          0.5 * gauge.noise_V * normal(generator);
    }
  }
  const TempFolder folder;
  log.Write(folder.Path("bench.csv"));
  Plan plan;
  plan.families[static_cast<int>(ParameterFamily::kGaugeGain)] = {true, 50.0,
                                                                  false};
  Calibrated fixed(plan, {folder.Path("bench.csv")}, finger);
  const ScoreTest score = ScoresOf(&fixed);
  const ScoreTest::Effect* best = score.Best();
  ASSERT_NE(best, nullptr);
  EXPECT_EQ(best->family, ParameterFamily::kGaugeOffset);
  EXPECT_EQ(best->values[0].name, "gauge_3_offset_V");
  EXPECT_EQ(best->values.size(), 1u);  // one gauge explains all of it

  Plan wide = Freed(plan, CandidateOf(ParameterFamily::kGaugeOffset));
  const Calibrated free(wide, {folder.Path("bench.csv")}, finger);
  const auto& value = best->values[0];
  EXPECT_NEAR(value.value, free.Variable(value.name), 1e-9);
  EXPECT_NEAR(value.std, free.Std(value.name), 1e-9);
  // The other three offsets are free in the refit, of gauges of their own.
  EXPECT_LT(best->drop, 2 * (Cost(fixed) - Cost(free)));
  EXPECT_GT(best->drop, 2 * (Cost(fixed) - Cost(free)) - 20);
}

TEST(ScoreTestTest, AgreesWithARefit) {
  const TempFolder folder;
  const std::string log = TurnedStageLog(folder, 31, 0.3);
  Calibrated fixed(StandardPlan(), {log});
  const ScoreTest score = ScoresOf(&fixed);
  for (const ParameterFamily family :
       {ParameterFamily::kObjectRotation, ParameterFamily::kObjectRadius,
        ParameterFamily::kForceScale}) {
    const ScoreTest::Effect* effect = Find(score, family);
    ASSERT_NE(effect, nullptr);
    const Calibrated free(Freed(StandardPlan(), CandidateOf(family)), {log});
    const auto& value = effect->values[0];
    const std::string& name = value.name;
    const double refit = free.problem->parameters()
                             .FreeParameter(free.Free(name))
                             .Value(free.Variable(name));
    EXPECT_NEAR(value.value, refit,
                0.2 * value.std + 0.03 * std::abs(refit - 1))
        << name;
    const double drop = 2 * (Cost(fixed) - Cost(free));
    EXPECT_NEAR(effect->drop, drop, 0.05 * drop + 0.5) << name;
  }
}

// The turn explains everything, but derivatives so far from the truth say less
// of it than of clamps that give.
TEST(ScoreTestTest, RefitsNameATurnedStageFirst) {
  int first = 0;
  for (unsigned seed = 40; seed < 44; ++seed) {
    const TempFolder folder;
    Calibrated calibrated(StandardPlan(), {TurnedStageLog(folder, seed, 1)});
    const WideLinearization wide =
        LinearizeWide(*calibrated.problem, calibrated.solution);
    const SolvedProblem at{
        calibrated.problem.get(), nullptr, calibrated.solution,
        CrossValidatedLogLikelihood(*calibrated.problem, wide)};
    ScoreTest score = TestScores(*calibrated.problem, calibrated.found, wide,
                                 RefitRivals(at, ScoresOf(&calibrated)));
    const ScoreTest::Effect* best = score.Best();
    ASSERT_NE(best, nullptr);
    EXPECT_NEAR(best->values[0].value, 1, 5 * best->values[0].std);
    first += best->family == ParameterFamily::kObjectRotation;
    // Nothing is named before a refit has shown that it explains them.
    EXPECT_EQ(score.Words(), "");
    EXPECT_FALSE(score.FoundNone());
    if (seed > 40) continue;
    JudgeEffects(at, &score);
    EXPECT_EQ(score.Words().find("residuals look like a turned stage"), 0u);
  }
  EXPECT_EQ(first, 4);
}

// The plan's circle has the same normal at the same place whether it is larger
// or further in: one log tells their sum only.
TEST(ScoreTestTest, WhatALogCannotTellApartIsNamedTogether) {
  const TempFolder folder;
  FrameTable log = FrameTable::Read(StandardLog(folder, HiddenFinger(), 45));
  for (double& x : log.MutableNumbers("object_x_mm")) x -= 0.5;
  log.Write(folder.Path("shifted.csv"));
  Calibrated calibrated(StandardPlan(), {folder.Path("shifted.csv")});
  const ScoreTest score = ScoresOf(&calibrated);
  ASSERT_NE(score.Best(), nullptr);
  std::vector<ParameterFamily> named = {score.Best()->family};
  for (const auto& effect : score.alike) named.push_back(effect.family);
  EXPECT_NE(
      std::count(named.begin(), named.end(), ParameterFamily::kObjectOrigin),
      0);
  EXPECT_NE(
      std::count(named.begin(), named.end(), ParameterFamily::kObjectRadius),
      0);
}

// Four columns of which the data tell little cost little evidence, so that they
// may have more of it than a column that chance does not explain.
TEST(ScoreTestTest, WhatChanceExplainsHidesNothing) {
  const TempFolder folder;
  const Calibrated calibrated(StandardPlan(),
                              {StandardLog(folder, HiddenFinger(), 58)});
  WideLinearization wide =
      LinearizeWide(*calibrated.problem, calibrated.solution);
  for (Linearization& fold : wide.folds) {
    fold.gradient.setZero();
    fold.pulls.setZero();
    for (auto& [stretch, families] : fold.information) {
      for (Eigen::MatrixXd& part : families) part.setZero();
    }
  }
  const CalibrationParameters& parameters = wide.problem->parameters();
  const Eigen::VectorXd unit = parameters.Units();
  Linearization& fold = wide.folds[0];
  for (const Eigen::Index k : wide.candidates) {
    const ParameterFamily family =
        parameters.FreeParameter(static_cast<std::size_t>(k)).family;
    const bool starts = family == ParameterFamily::kGaugeStart;
    if (!starts && family != ParameterFamily::kObjectRotation) continue;
    const double a = starts ? 0.5 : 1e5, drop = starts ? 3.5 : 20;
    fold.gradient[k] = std::sqrt(drop * (a + 1)) / unit[k];
    fold.information.begin()->second[0](k, k) = a / (unit[k] * unit[k]);
  }
  const ScoreTest score =
      TestScores(*calibrated.problem, calibrated.found, wide);
  const ScoreTest::Effect* starts = Find(score, ParameterFamily::kGaugeStart);
  ASSERT_NE(starts, nullptr);
  EXPECT_EQ(starts->values.size(), 4u);
  EXPECT_FALSE(starts->significant);
  ASSERT_NE(score.Best(), nullptr);
  EXPECT_EQ(score.Best()->family, ParameterFamily::kObjectRotation);
  EXPECT_LT(score.Best()->evidence, starts->evidence);
  // Nor does a refit of another one.
  const std::vector<Refit> refits = {
      {ParameterFamily::kObjectRotation, 20, 8, {}}};
  EXPECT_NE(
      TestScores(*calibrated.problem, calibrated.found, wide, refits).Best(),
      nullptr);
}

// No plan frees what changes in mid-log. Where it is the second effect, it is
// judged by what the first one leaves.
TEST(ScoreTestTest, TheSecondEffectIsJudgedByWhatTheFirstLeaves) {
  const TempFolder folder;
  FrameTable log = FrameTable::Read(TurnedStageLog(folder, 46, 0.3));
  for (std::size_t i = 105; i < log.rows(); ++i) {
    log.MutableNumbers("force_N")[i] += 0.1;
  }
  log.Write(folder.Path("two.csv"));
  Calibrated calibrated(StandardPlan(), {folder.Path("two.csv")});
  const SolvedProblem at{calibrated.problem.get(), nullptr,
                         calibrated.solution};
  std::string why_not;
  auto turned =
      SolveWith(CandidateOf(ParameterFamily::kObjectRotation), at, &why_not);
  ASSERT_TRUE(turned) << why_not;
  JudgeAgain(&*turned);
  const TotalChi2 left = TotalChi2::Of(
      AnalyzeIdentifiability(turned->problem, turned->solution.at));
  ASSERT_TRUE(left.IsLoud());
  ScoreTest score;
  score.effects.resize(1);
  score.effects[0].family = ParameterFamily::kObjectRotation;
  score.effects[0].significant = true;
  score.next.emplace();
  score.next->family = ParameterFamily::kForceOffset;
  score.next->where = ScoreTest::Where::kFrom;
  score.next->drop = left.chi2 - left.dof;
  JudgeEffects(at, &score);
  EXPECT_TRUE(score.explained.value());
  score.next->drop /= 2;
  JudgeEffects(at, &score);
  EXPECT_FALSE(score.explained.value());
}

TEST(ScoreTestTest, CleanLogsNameNothing) {
  int named = 0;
  for (unsigned seed = 50; seed < 58; ++seed) {
    const TempFolder folder;
    Calibrated calibrated(StandardPlan(),
                          {StandardLog(folder, HiddenFinger(), seed)});
    named += ScoresOf(&calibrated).Best() != nullptr;
  }
  EXPECT_EQ(named, 0);
}

}  // namespace
}  // namespace finray
