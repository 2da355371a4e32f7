#include "finray/calib/analysis/next_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "calib/calibrated.h"
#include "calib/log_rows.h"
#include "finray/calib/analysis/identifiability.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/objects/circle_centre.h"

namespace finray {
namespace {

using testing::HasSubstr;

// A log of 20 frames as advised, recorded with the true finger.
std::string Record(const TempFolder& folder, const FrameAdvice& advice,
                   double radius_mm) {
  const Finger truth = HiddenFinger();
  FrameTable frames(FrameAdvice::kFrames);
  EquilibriumSolver solver(truth, {});
  for (int i = 0; i < FrameAdvice::kFrames; ++i) {
    const double arc = std::isnan(advice.contact_mm)
                           ? std::round(14 * (1 + i % 9))
                           : advice.contact_mm;
    frames.MutableNumbers("contact_1_mm")[i] = arc;
    frames.MutableNumbers("normal_1_N")[i] = advice.normal_N;
    EXPECT_TRUE(solver.Solve({{arc, advice.normal_N, 0}}));
    const Eigen::Vector2d centre =
        CircleCentre(solver.contact_pose(0), radius_mm);
    frames.MutableNumbers("object_x_mm")[i] = centre.x();
    frames.MutableNumbers("object_y_mm")[i] = centre.y();
  }
  EXPECT_EQ(Simulate(truth, {}, {}, &frames).not_converged, 0);
  MakeLog(truth, frames, {0.02, 0.05, 9}).Write(folder.Path("more.csv"));
  return folder.Path("more.csv");
}

// One height only: the ribs together are weak. What is promised of 20 more
// frames is what a calibration with them has.
TEST(NextFramesTest, WhatIsPromisedIsKept) {
  const TempFolder folder;
  const std::string log = folder.Path("one_height.csv");
  RowsWhere(FrameTable::Read(StandardLog(folder, HiddenFinger(), 21)),
            [](const FrameTable& all, std::size_t i) {
              return std::abs(all.Numbers("object_y_mm")[i] - 60) < 6 ||
                     all.Numbers("force_N")[i] < 0.06;
            })
      .Write(log);
  Calibrated before(StandardPlan(), {log});
  ASSERT_FALSE(before.found.weak.empty());
  const auto advised =
      AdviseNextFrames(before.problem.get(), before.solution, &before.found)
          .advice;
  ASSERT_FALSE(advised.empty());
  const FrameAdvice& best = advised[0];
  EXPECT_TRUE(best.added.empty());
  Calibrated after(StandardPlan(), {log, Record(folder, best, 15)});
  const CalibrationParameter& p =
      before.problem->parameters().all()[best.parameter];
  std::printf("%s; found %.4f mm\n", best.words.c_str(), after.Std(p.name));
  EXPECT_NEAR(best.parameter_std_before, before.Std(p.name), 1e-9);
  EXPECT_LT(best.parameter_std_after, 0.5 * best.parameter_std_before);
  EXPECT_NEAR(best.parameter_std_after / after.Std(p.name), 1, 0.12);
  // Frames like those that are there would not do.
  FrameAdvice same = best;
  same.contact_mm = 60;
  Calibrated more(StandardPlan(), {log, Record(folder, same, 15)});
  EXPECT_GT(more.Std(p.name), 1.5 * after.Std(p.name));
}

// A calibration from two dozen rows promises a force std for the advised
// frames. A calibration with these frames predicts the same std, and the errors
// of calibrated fingers are as large.
TEST(NextFramesTest, ThePredictedForceStdIsKept) {
  const TempFolder folder;
  double squares = 0, predicted_squares = 0;
  for (const unsigned seed : {31u, 32u, 33u, 34u, 35u, 36u}) {
    const std::string log = folder.Path("few.csv");
    RowsWhere(FrameTable::Read(StandardLog(folder, HiddenFinger(), seed)),
              [](const FrameTable&, std::size_t i) { return i % 7 == 0; })
        .Write(log);
    Calibrated few(StandardPlan(), {log});
    const NextRecording next =
        AdviseNextFrames(few.problem.get(), few.solution, &few.found);
    ASSERT_GT(next.force_contacts, 10u);
    predicted_squares += next.force_calibration_N * next.force_calibration_N;

    // Exact readings of the true finger at the same contacts, by the calibrated
    // one.
    const PredictedForce at = PredictForce(
        *few.problem, PredictFrames(few.problem.get(), few.solution.contacts,
                                    few.found.unit));
    const Finger found = few.problem->parameters().Apply(few.problem->finger());
    Scene scene;
    scene.contacts = 1;
    FrameEstimator estimator(found, scene, {});
    EquilibriumSolver truth(HiddenFinger(), {});
    double of_seed = 0;
    for (const auto& [arc_mm, normal_N] : at.contacts) {
      truth.Reset();
      ASSERT_TRUE(truth.Solve({{arc_mm, normal_N, 0}}));
      Measurements row;
      for (int j = 0; j < 4; ++j) {
        row.gauges_V.push_back(
            HiddenFinger().gauges[j].Volts(truth.gauge_angle(j)));
      }
      const double error =
          estimator.Estimate(row).contact[0].normal_N - normal_N;
      of_seed += error * error;
    }
    squares += of_seed / static_cast<double>(at.contacts.size());
    if (seed != 31) continue;

    ASSERT_FALSE(next.advice.empty());
    const FrameAdvice& best = next.advice[0];
    ASSERT_TRUE(best.force_std_after_N.has_value());
    EXPECT_LT(best.std_after, 0.9 * best.std_before);
    Calibrated after(StandardPlan(), {log, Record(folder, best, 15)});
    const NextRecording then =
        AdviseNextFrames(after.problem.get(), after.solution, &after.found);
    std::printf("%s; found %.3f N\n", best.words.c_str(), then.force_std_N());
    EXPECT_NEAR(*best.force_std_before_N, next.force_std_N(), 1e-12);
    EXPECT_NEAR(best.std_after / then.force_calibration_N, 1, 0.12);
    EXPECT_NEAR(*best.force_std_after_N / then.force_std_N(), 1, 0.12);
  }
  std::printf(
      "force error of calibrated fingers %.4f N rms, predicted %.4f N\n",
      std::sqrt(squares / 6), std::sqrt(predicted_squares / 6));
  EXPECT_NEAR(std::sqrt(squares / predicted_squares), 1, 0.5);
}

TEST(NextFramesTest, SaysWhenEnoughIsRecorded) {
  const TempFolder folder;
  Calibrated much(StandardPlan(), {StandardLog(folder, HiddenFinger(), 26)});
  const NextRecording next =
      AdviseNextFrames(much.problem.get(), much.solution, &much.found);
  EXPECT_TRUE(next.enough);
  const std::string few = folder.Path("few.csv");
  RowsWhere(FrameTable::Read(folder.Path("log.csv")), [](const FrameTable&,
                                                         std::size_t i) {
    return i % 15 == 0;
  }).Write(few);
  Calibrated little(StandardPlan(), {few});
  EXPECT_FALSE(
      AdviseNextFrames(little.problem.get(), little.solution, &little.found)
          .enough);
  EXPECT_LT(next.force_calibration_N, next.force_noise_N);
  EXPECT_THAT(NextWords(next), HasSubstr("enough recorded: predicted force"));
}

TEST(NextFramesTest, AMissingForceIsAskedFor) {
  const TempFolder folder;
  FrameTable log = FrameTable::Read(StandardLog(folder, HiddenFinger(), 22));
  log.MutableNumbers("force_N").assign(210, NAN);
  log.Write(folder.Path("blind.csv"));
  Plan plan = StandardPlan();
  for (FamilyPlan& family : plan.families) family.prior_std.reset();
  Calibrated blind(plan, {folder.Path("blind.csv")});
  const auto advised =
      AdviseNextFrames(blind.problem.get(), blind.solution, &blind.found)
          .advice;
  ASSERT_FALSE(advised.empty());
  EXPECT_EQ(advised[0].added,
            std::vector<ResidualFamily>{ResidualFamily::kForce});
  EXPECT_TRUE(std::isinf(advised[0].parameter_std_before));
  EXPECT_THAT(advised[0].words, HasSubstr("force_N"));
  EXPECT_THAT(advised[0].words, HasSubstr("would determine"));
  EXPECT_EQ(blind.found.weak[0].remedy, advised[0].words);
  Calibrated seeing(plan,
                    {folder.Path("blind.csv"), Record(folder, advised[0], 15)});
  const CalibrationParameter& p =
      blind.problem->parameters().all()[advised[0].parameter];
  // The blind log does not tell the scale of stiffness: relative to it.
  const double predicted =
      advised[0].parameter_std_after / p.Value(*p.variable);
  const double seen = seeing.Variable(p.name);
  EXPECT_NEAR(
      predicted / (p.ValueStd(seen, seeing.Std(p.name)) / p.Value(seen)), 1,
      0.12);
}

// Steps of a drift, and offsets of a log that not all gauges are in: what is
// proposed has fewer of them.
TEST(NextFramesTest, ParametersOfLogsAreMatchedByName) {
  const TempFolder folder;
  const std::string path = StandardLog(folder, HiddenFinger(), 25);
  FrameTable log = FrameTable::Read(path);
  std::vector<double>& time = log.MutableNumbers("time_s");
  for (std::size_t i = 0; i < time.size(); ++i) time[i] = 10.0 * i;
  log.Write(path);
  Plan plan = StandardPlan();
  FamilyPlan& drift =
      plan.families[static_cast<int>(ParameterFamily::kGaugeDrift)];
  drift.free = true;
  plan.gauge_walk = {0.01, 300};
  Calibrated steps(plan, {path});
  for (const FrameAdvice& advice :
       AdviseNextFrames(steps.problem.get(), steps.solution, &steps.found)
           .advice) {
    EXPECT_LT(advice.std_after, advice.std_before);
  }

  plan = StandardPlan();
  plan.families[static_cast<int>(ParameterFamily::kGaugeOffset)].per_log = true;
  const std::string bench = folder.Write(
      "bench.csv",
      "cylinder_radius_mm,gauge_1_V\ninf,0.05\n100,0.374\n60,0.59\n");
  Calibrated of_logs(plan, {path, bench});
  for (const ParameterStatus status : of_logs.found.status) {
    EXPECT_EQ(status, ParameterStatus::kEstimated);
  }
}

// Force, but no place: gains ride on stiffness; known gains settle it.
TEST(NextFramesTest, KnownGainsSettleStiffness) {
  const TempFolder folder;
  FrameTable log = FrameTable::Read(StandardLog(folder, HiddenFinger(), 23));
  log.MutableNumbers("object_x_mm").assign(210, NAN);
  log.Write(folder.Path("placeless.csv"));
  Plan plan = StandardPlan();
  plan.families[static_cast<int>(ParameterFamily::kRibLength)] = {};
  plan.families[static_cast<int>(ParameterFamily::kGaugeOffset)] = {};
  // Offsets are those of the truth then, and ribs too.
  Finger start = HiddenFinger();
  CalibrationProblem problem(
      start, plan,
      ReadCalibrationLogs({folder.Path("placeless.csv")}, start, plan), {}, 2);
  const CalibrationSolution solution = SolveOnce(&problem);
  ASSERT_TRUE(solution.solve.converged);
  Identifiability found = AnalyzeIdentifiability(&problem, solution.at);
  const auto advised = AdviseNextFrames(&problem, solution, &found).advice;
  ASSERT_FALSE(advised.empty());
  const FrameAdvice& known = advised.back();
  std::printf("%s\n", known.words.c_str());
  ASSERT_TRUE(known.known_gains);
  plan.families[static_cast<int>(ParameterFamily::kGaugeGain)] = {};
  CalibrationProblem fixed(
      start, plan,
      ReadCalibrationLogs({folder.Path("placeless.csv")}, start, plan), {}, 2);
  const CalibrationSolution of_fixed = SolveOnce(&fixed);
  ASSERT_TRUE(of_fixed.solve.converged);
  const Identifiability settled = AnalyzeIdentifiability(&fixed, of_fixed.at);
  const CalibrationParameter& p = problem.parameters().all()[known.parameter];
  EXPECT_NEAR(known.parameter_std_after /
                  p.ValueStd(*p.variable, settled.std[known.parameter]),
              1, 0.05);
}

}  // namespace
}  // namespace finray
