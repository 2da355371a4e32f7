#include "finray/calib/design/finger_design.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "finray/calib/design/planned_recording.h"
#include "finray/calib/solve/robust_solve.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "studies/planned_log.h"
#include "test_finger.h"

namespace finray {
namespace {

Plan BundledPlan() {
  return ReadPlan(FINRAY_SOURCE_DIR "/configs/plans/force_and_circle.yaml");
}

PlacementTask PaperTask() {
  return {PaperFinger().gauges[0], {Side::kBack}, 18, 18, 1, 20, 105, 2};
}

// The estimator computes its std by another path.
TEST(ContactAccuracyTest, IsTheStdOfTheEstimator) {
  const Finger finger =
      AfterCalibration(PaperFinger(), {BundledPlan(), 60}, 2, {});
  ContactAccuracy accuracy(finger, 0, {});
  Scene scene;
  scene.contacts = 1;
  FrameEstimator estimator(finger, scene);
  EquilibriumSolver solver(finger, {});
  for (const double height : {30.0, 65.0, 90.0}) {
    solver.Reset();
    ASSERT_TRUE(solver.Solve({{height, 2}}));
    Measurements row;
    for (int j = 0; j < 4; ++j) {
      row.gauges_V.push_back(finger.gauges[j].Volts(solver.gauge_angle(j)));
    }
    const FrameEstimate estimate = estimator.Estimate(row);
    const ContactStd predicted = accuracy.At({{height, 2}});
    EXPECT_NEAR(predicted.total[0] / estimate.contact[0].arc_std_mm, 1, 0.01);
    EXPECT_NEAR(predicted.total[1] / estimate.contact[0].normal_std_N, 1, 0.01);
    EXPECT_GT(predicted.total[0], predicted.noise[0]);
  }
}

// 100 noisy frames spread as predicted; tests/studies/design_study.cc has a
// thousand at each height.
TEST(ContactAccuracyTest, NoisyFramesSpreadSo) {
  const Finger finger = PaperFinger();
  Scene scene;
  scene.contacts = 1;
  FrameEstimator estimator(finger, scene);
  EquilibriumSolver solver(finger, {});
  ASSERT_TRUE(solver.Solve({{60, 2}}));
  std::mt19937_64 generator(4);
  std::normal_distribution<double> normal;
  double place = 0, force = 0;
  constexpr int kFrames = 400;
  for (int k = 0; k < kFrames; ++k) {
    Measurements row;
    for (int j = 0; j < 4; ++j) {
      row.gauges_V.push_back(finger.gauges[j].Volts(solver.gauge_angle(j)) +
                             finger.gauges[j].noise_V * normal(generator));
    }
    const FrameEstimate estimate = estimator.Estimate(row);
    place += std::pow(estimate.contact[0].arc_mm - 60, 2);
    force += std::pow(estimate.contact[0].normal_N - 2, 2);
  }
  ContactAccuracy accuracy(finger, 0, {});
  const ContactStd predicted = accuracy.At({{60, 2}});
  EXPECT_NEAR(predicted.noise[0] / std::sqrt(place / kFrames), 1, 0.1);
  EXPECT_NEAR(predicted.noise[1] / std::sqrt(force / kFrames), 1, 0.1);
}

TEST(ContactAccuracyTest, OneGaugeTellsNoContact) {
  Finger finger = PaperFinger();
  finger.gauges.resize(1);
  ContactAccuracy accuracy(finger, 0, {});
  EXPECT_TRUE(std::isinf(accuracy.At({{60, 2}}).total[0]));
}

// What is promised of the parameters is what a calibration of noisy rows has.
TEST(PlannedRecordingTest, TheCovarianceIsThatOfACalibration) {
  const Finger finger = PaperFinger();
  Plan plan = BundledPlan();
  const std::vector<PlannedContact> contacts =
      SpreadContacts({14, 126, 0.6, 6}, 80, 1);
  const PlannedRecording planned(finger, plan, contacts, {});
  const Finger known = planned.Calibrated();
  std::mt19937_64 generator(5);
  CalibrationProblem problem(
      finger, plan,
      WithNoise(planned.problem().logs(), finger, plan, &generator), {}, 1);
  const CalibrationSolution solution = SolveOnce(&problem);
  ASSERT_TRUE(solution.solve.converged);
  Finger found = finger;
  KeepCovariance(problem.parameters(),
                 AnalyzeIdentifiability(&problem, solution.at), &found);
  ASSERT_EQ(known.calibration->std.size(), found.calibration->std.size());
  for (Eigen::Index k = 0; k < known.calibration->std.size(); ++k) {
    EXPECT_NEAR(known.calibration->std[k] / found.calibration->std[k], 1, 0.1);
  }
}

// Ribs that prestress the finger bend it at rest: its readings are no
// residuals.
TEST(PlannedRecordingTest, PrestressLeavesNoResidual) {
  Finger finger = PaperFinger();
  finger.ribs[1].length_mm += 0.5;
  finger.gauges[2].offset_V = 0.02;
  const PlannedRecording planned(finger, BundledPlan(),
                                 SpreadContacts({14, 126, 0.6, 6}, 20, 1), {});
  ASSERT_EQ(planned.rows().size(), 20u);
  for (const PlannedRecording::Row& row : planned.rows()) {
    EXPECT_LT(row.at.residuals.cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST(SpreadContactsTest, TheFirstRowsAreSpread) {
  const auto contacts = SpreadContacts({0, 100, 1, 2}, 400, 7);
  EXPECT_FALSE(contacts[0].touches());
  for (const std::size_t first : {40u, 100u, 400u}) {
    int low[5] = {}, light[2] = {};
    int count = 0;
    for (std::size_t i = 0; i < first; ++i) {
      if (!contacts[i].touches()) continue;
      ++count;
      ++low[static_cast<int>(contacts[i].contact_mm / 20)];
      ++light[contacts[i].normal_N < 1.5];
    }
    for (const int n : low) EXPECT_NEAR(n, count / 5.0, 2);
    EXPECT_NEAR(light[0], count / 2.0, 2);
  }
}

// The sums over tiles of one mm are the derivatives of the gauges themselves.
TEST(GaugePlacementTest, TheWorstStdIsThatOfTheFinger) {
  const PlacementTask task = PaperTask();
  const GaugePlaces places(PaperFinger(), task, {});
  const std::vector<Placement> found = PlaceGauges(places, 4, 1);
  ASSERT_FALSE(found.empty());
  Finger finger = PaperFinger();
  finger.gauges = found[0].gauges;
  ContactAccuracy accuracy(finger, 0, {});
  const WorstStd worst = WorstOf(HeightsOf(20, 105), 2, 0, &accuracy);
  EXPECT_NEAR(found[0].worst_std / worst.place_mm, 1, 1e-6);
  ContactAccuracy paper(PaperFinger(), 0, {});
  EXPECT_LT(worst.place_mm,
            0.95 * WorstOf(HeightsOf(20, 105), 2, 0, &paper).place_mm);
}

TEST(GaugePlacementTest, GaugesKeepTheirDistance) {
  PlacementTask task = PaperTask();
  task.beams = {Side::kBack, Side::kFront};
  task.least_length_mm = 6;
  const Finger finger = PaperFinger();
  const GaugePlaces places(finger, task, {});
  for (const Placement& placement : PlaceGauges(places, 6, 2)) {
    for (const Gauge& a : placement.gauges) {
      EXPECT_NEAR(a.gain_V_per_rad * a.length_mm, 18, 1e-9);
      for (const Rib& rib : finger.ribs) {
        const double hinge = HingePlace(rib, a.beam);
        EXPECT_TRUE(hinge <= a.start_mm - 1 ||
                    hinge >= a.start_mm + a.length_mm + 1);
      }
      for (const Gauge& b : placement.gauges) {
        if (&a == &b || a.beam != b.beam) continue;
        EXPECT_TRUE(a.start_mm + a.length_mm + 1 <= b.start_mm ||
                    b.start_mm + b.length_mm + 1 <= a.start_mm);
      }
    }
  }
  EXPECT_TRUE(PlaceGauges(GaugePlaces(finger, PaperTask(), {}), 7, 1).empty());
  task.least_length_mm = task.most_length_mm = 60;
  EXPECT_THROW(GaugePlaces(finger, task, {}), InputError);
}

// No exchange of one gauge betters the placement, and few gauges can be tried
// all.
TEST(GaugePlacementTest, TwoGaugesAreTheBestPair) {
  const PlacementTask task = PaperTask();
  const GaugePlaces places(PaperFinger(), task, {});
  double best = INFINITY;
  for (int a = 0; a < static_cast<int>(places.size()); ++a) {
    for (int b = 0; b < a; ++b) {
      if (places.MayBeTogether(a, b)) {
        best = std::min(best, places.WorstStd({a, b}));
      }
    }
  }
  EXPECT_NEAR(PlaceGauges(places, 2, 1)[0].worst_std / best, 1, 1e-12);
}

TEST(UntoldHeightsTest, BeyondTheLastRibContactsLookAlike) {
  const std::vector<double> untold =
      UntoldHeights(PaperFinger(), {60, 80, 120, 130}, 2, 0, {});
  EXPECT_EQ(untold, (std::vector<double>{120, 130}));
}

}  // namespace
}  // namespace finray
