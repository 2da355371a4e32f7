#include "finray/estimation/frame_estimator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <vector>

#include "finray/io/error.h"
#include "finray/objects/sliding_friction.h"
#include "finray/scene/history_filter.h"
#include "studies/gauge_frames.h"
#include "test_finger.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

Scene OneContact() {
  Scene scene;
  scene.contacts = 1;
  return scene;
}

TEST(FrameEstimatorTest, NoiseFreeGridFromACold) {
  Finger finger = PaperFinger();
  finger.gauges[1].gain_V_per_rad = -2.1;
  finger.gauges[3].offset_V = 0.4;
  FrameEstimator estimator(finger, OneContact(), {});
  EquilibriumSolver solver(finger, {});
  double worst_arc = 0, worst_force = 0;
  int right = 0;
  for (int i = 0; i < 30; ++i) {
    for (int j = 0; j < 20; ++j) {
      const double arc = 15 + (112 - 15) * i / 29.0;
      const double force = 0.1 * std::pow(100, j / 19.0);
      ASSERT_TRUE(solver.Solve({{arc, force, 0}}));
      const FrameEstimate estimate = estimator.Estimate(CleanReadings(solver));
      const double arc_error = std::abs(estimate.contact[0].arc_mm - arc);
      const double force_error =
          std::abs(estimate.contact[0].normal_N / force - 1);
      right += arc_error < 1e-5 && force_error < 1e-6;
      worst_arc = std::max(worst_arc, arc_error);
      worst_force = std::max(worst_force, force_error);
    }
  }
  std::printf("30 x 20 grid: %d of 600 right; worst %.1e mm, %.1e\n", right,
              worst_arc, worst_force);
  EXPECT_EQ(right, 600);
}

// One estimator for each thread, with the tables of the first.
TEST(FrameEstimatorTest, ThoseOfOtherThreadsEstimateTheSame) {
  const Finger finger = PaperFinger();
  Scene scene;
  scene.most_contacts = 2;
  std::vector<Measurements> readings;
  EquilibriumSolver solver(finger, {});
  for (int i = 0; i < 40; ++i) {
    ASSERT_TRUE(solver.Solve(
        i < 36 ? std::vector<PointContact>{{40.0 + i, 0.005 * i * i, 0}}
               : std::vector<PointContact>{{30, 4, 0}, {90, 3, 0}}));
    readings.push_back(CleanReadings(solver));
  }
  const auto estimate = [&](FrameEstimator* estimator) {
    std::vector<FrameEstimate> estimates(readings.size());
    estimator->EstimateBlock(readings.data(), readings.size(),
                             estimates.data());
    return estimates;
  };
  auto first = std::make_unique<FrameEstimator>(finger, scene);
  const auto before = first->ForAnotherThread();
  const std::vector<FrameEstimate> expected = estimate(before.get());
  EXPECT_EQ(expected.back().contacts, 2);
  const auto after = before->ForAnotherThread();
  first.reset();  // the others keep its tables alive
  FrameEstimator alone(finger, scene);
  for (FrameEstimator* other : {before.get(), after.get(), &alone}) {
    const std::vector<FrameEstimate> found = estimate(other);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].status, expected[i].status) << i;
      EXPECT_EQ(found[i].contacts, expected[i].contacts) << i;
      EXPECT_EQ(found[i].chi2, expected[i].chi2) << i;
      for (int c = 0; c < found[i].contacts; ++c) {
        const ContactEstimate &at = found[i].contact[c],
                              &of = expected[i].contact[c];
        EXPECT_EQ(at.arc_mm, of.arc_mm) << i;
        EXPECT_EQ(at.normal_N, of.normal_N) << i;
        EXPECT_EQ(at.arc_std_mm, of.arc_std_mm) << i;
      }
    }
  }
}

TEST(FrameEstimatorTest, StdIsWhatNoiseDoes) {
  // Compares the spread over noisy repeats with the reported std, at a good
  // place.
  const Finger finger = PaperFinger();
  FrameEstimator estimator(finger, OneContact(), {});
  EquilibriumSolver solver(finger, {});
  ASSERT_TRUE(solver.Solve({{75, 3, 0}}));
  const Measurements clean = CleanReadings(solver);
  std::mt19937_64 generator(5);
  std::normal_distribution<double> noise(0, 3e-4);
  double arc2 = 0, force2 = 0, arc_std = 0, force_std = 0, chi2 = 0;
  constexpr int kRepeats = 1000;
  for (int i = 0; i < kRepeats; ++i) {
    Measurements readings = clean;
    for (double& v : readings.gauges_V) v += noise(generator);
    const FrameEstimate estimate = estimator.Estimate(readings);
    ASSERT_EQ(estimate.status, FrameStatus::kOk);
    arc2 += std::pow(estimate.contact[0].arc_mm - 75, 2);
    force2 += std::pow(estimate.contact[0].normal_N - 3, 2);
    arc_std += estimate.contact[0].arc_std_mm;
    force_std += estimate.contact[0].normal_std_N;
    chi2 += estimate.chi2;
  }
  // The spread of 1000 repeats is known to 2.2 %.
  EXPECT_NEAR(std::sqrt(arc2 / kRepeats) / (arc_std / kRepeats), 1, 0.08);
  EXPECT_NEAR(std::sqrt(force2 / kRepeats) / (force_std / kRepeats), 1, 0.08);
  EXPECT_NEAR(chi2 / kRepeats, 2, 0.2);  // 4 gauges less 2 unknowns
}

TEST(FrameEstimatorTest, SaysWhatItCannotSee) {
  const Finger finger = PaperFinger();
  EquilibriumSolver solver(finger, {});
  FrameEstimator automatic(finger, Scene(), {});
  ASSERT_TRUE(solver.Solve({}));
  EXPECT_EQ(automatic.Estimate(CleanReadings(solver)).status,
            FrameStatus::kNoContact);
  // Under a light contact near the tip no gauge tells place from force.
  ASSERT_TRUE(solver.Solve({{128, 0.5, 0}}));
  FrameEstimator one(finger, OneContact(), {});
  const FrameEstimate tip = one.Estimate(CleanReadings(solver));
  EXPECT_EQ(tip.status, FrameStatus::kUnobservable);
  ASSERT_TRUE(solver.Solve({{70, 3, 0}}));
  Measurements readings = CleanReadings(solver);
  const FrameEstimate whole = one.Estimate(readings);
  EXPECT_EQ(whole.status, FrameStatus::kOk);
  // Three gauges still determine the contact, with less certainty. One gauge
  // does not.
  readings.gauges_V[0] = std::nan("");
  const FrameEstimate less = one.Estimate(readings);
  EXPECT_NEAR(less.contact[0].arc_mm, 70, 1e-6);
  EXPECT_GT(less.contact[0].arc_std_mm, whole.contact[0].arc_std_mm);
  readings.gauges_V[1] = readings.gauges_V[2] = std::nan("");
  EXPECT_EQ(one.Estimate(readings).status, FrameStatus::kBadInput);
  EXPECT_TRUE(std::isnan(one.Estimate(readings).contact[0].normal_N));
}

TEST(FrameEstimatorTest, FreeFramesWithNoiseAreNoContact) {
  const Finger finger = PaperFinger();
  FrameEstimator automatic(finger, Scene(), {});
  std::mt19937_64 generator(6);
  std::normal_distribution<double> noise(0, 3e-4);
  int free = 0;
  for (int i = 0; i < 300; ++i) {
    Measurements readings;
    readings.gauges_V.resize(4);
    for (double& v : readings.gauges_V) v = noise(generator);
    const FrameEstimate estimate = automatic.Estimate(readings);
    free += estimate.status == FrameStatus::kNoContact;
  }
  EXPECT_GE(free, 297);  // p = 0.001 a frame
}

TEST(FrameEstimatorTest, KnownFrictionIsPartOfTheModel) {
  const Finger finger = PaperFinger();
  EquilibriumSolver solver(finger, {});
  ASSERT_TRUE(solver.Solve({{64, 5, 0.3}}));
  Scene scene = OneContact();
  scene.friction_coefficient = 0.3;
  FrameEstimator estimator(finger, scene, {});
  const FrameEstimate estimate = estimator.Estimate(CleanReadings(solver));
  EXPECT_NEAR(estimate.contact[0].arc_mm, 64, 1e-6);
  EXPECT_NEAR(estimate.contact[0].normal_N, 5, 1e-6);
  EXPECT_NEAR(estimate.rib_tension_N[2], solver.rib_tension(2), 1e-6);
  EXPECT_NEAR((estimate.tip_pose - solver.tip_pose()).norm(), 0, 1e-6);
}

// An object that goes in, out and along, with its place in the log: each row
// has its own friction. Without its place, friction counts as the scene's.
TEST(FrameEstimatorTest, TheObjectsMotionTellsTheFriction) {
  const Finger finger = PaperFinger();
  Scene scene = OneContact();
  scene.friction_coefficient = 0.3;
  scene.object = {Outline(CircleOutline{15}), std::nullopt};
  EquilibriumSolver solver(finger, {});
  scene.presliding_mm = 1e-3;
  SlidingFriction sliding(*scene.object, 0.3, 1e-3, 0);
  std::vector<Measurements> rows;
  std::vector<PointContact> truth;
  for (const Eigen::Vector2d& centre :
       {Eigen::Vector2d(-12, 60), {-11, 60}, {-12, 60}, {-12, 61}, {-12, 59}}) {
    ASSERT_TRUE(sliding.Next({centre}, &solver).has_value());
    truth.push_back(sliding.contact().contacts[0]);
    rows.push_back(CleanReadings(solver));
    rows.back().object_mm = centre;
  }
  EXPECT_GT(truth[1].friction, 0.29);
  EXPECT_LT(truth[2].friction, -0.29);
  for (const FrameMethod method :
       {FrameMethod::kFast, FrameMethod::kCeresReduced}) {
    FrameEstimator estimator(finger, scene, {}, method);
    HistoryFilter history(finger, scene);
    std::vector<Measurements> filtered = rows;
    for (Measurements& row : filtered) history.Remove(&row);
    std::vector<FrameEstimate> block(rows.size());
    estimator.EstimateBlock(filtered.data(), rows.size(), block.data());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_NEAR(filtered[i].friction, truth[i].friction, 1e-3) << i;
      EXPECT_NEAR(block[i].contact[0].normal_N / truth[i].normal_N, 1, 2e-3)
          << i;
      EXPECT_NEAR(block[i].contact[0].arc_mm, truth[i].arc_mm, 0.1) << i;
      EXPECT_NEAR(estimator.Next(filtered[i]).contact[0].normal_N,
                  estimator.Estimate(filtered[i]).contact[0].normal_N, 1e-5);
    }
    const FrameEstimate blind = estimator.Estimate(rows[2]);
    EXPECT_GT(std::abs(blind.contact[0].normal_N / truth[2].normal_N - 1),
              0.01);
  }
}

TEST(FrameEstimatorTest, ASaturatedGaugeIsLeftOut) {
  Finger finger = PaperFinger();
  EquilibriumSolver solver(finger, {});
  ASSERT_TRUE(solver.Solve({{70, 3, 0}}));
  Measurements readings = CleanReadings(solver);
  const double seen = readings.gauges_V[0];
  finger.gauges[0].max_V = std::abs(seen) / 2;
  finger.gauges[0].min_V = -std::abs(seen) / 2;
  readings.gauges_V[0] = std::copysign(std::abs(seen) / 2, seen);
  const FrameEstimate estimate =
      FrameEstimator(finger, OneContact(), {}).Estimate(readings);
  EXPECT_NEAR(estimate.contact[0].arc_mm, 70, 1e-6);
  EXPECT_EQ(estimate.dof, 1);
}

TEST(FrameEstimatorTest, AMeasuredCircleTellsPlaceFromForce) {
  // Near the tip the gauges alone know the place to a few mm.
  const Finger finger = PaperFinger();
  Scene scene = OneContact();
  scene.object = {Outline(CircleOutline{15}), std::nullopt};
  EquilibriumSolver solver(finger, {});
  const ObjectPose pose{{-13, 121}, 0};
  const ObjectContact truth =
      SolveObjectContact(*scene.object, pose, 0, &solver);
  ASSERT_EQ(truth.contacts.size(), 1u);
  Measurements readings = CleanReadings(solver);
  const FrameEstimate alone =
      FrameEstimator(finger, scene, {}).Estimate(readings);
  EXPECT_GT(alone.contact[0].arc_std_mm, 1);

  scene.object_std_mm = 0.05;
  FrameEstimator measured(finger, scene, {});
  readings.object_mm = pose.position_mm;
  const FrameEstimate placed = measured.Estimate(readings);
  EXPECT_EQ(placed.status, FrameStatus::kOk);
  EXPECT_EQ(placed.dof, 4);
  EXPECT_NEAR(placed.contact[0].arc_mm, truth.contacts[0].arc_mm, 1e-6);
  EXPECT_NEAR(placed.contact[0].normal_N, truth.contacts[0].normal_N, 1e-6);
  EXPECT_LT(placed.contact[0].arc_std_mm, 0.1);
  EXPECT_LT(placed.contact[0].normal_std_N,
            0.5 * alone.contact[0].normal_std_N);
  // One gauge and one coordinate of the stage remain.
  for (int j = 1; j < 4; ++j) readings.gauges_V[j] = std::nan("");
  readings.object_mm.x() = std::nan("");
  const FrameEstimate least = measured.Estimate(readings);
  EXPECT_EQ(least.dof, 0);
  EXPECT_NEAR(least.contact[0].arc_mm, truth.contacts[0].arc_mm, 1e-5);
  EXPECT_NEAR(least.contact[0].normal_N, truth.contacts[0].normal_N, 1e-5);
}

Finger EightGauges(double noise_V) {
  Finger finger = PaperFinger();
  for (int j = 0; j < 4; ++j) {
    Gauge gauge = finger.gauges[j];
    gauge.beam = Side::kFront;
    finger.gauges.push_back(gauge);
  }
  for (Gauge& gauge : finger.gauges) gauge.noise_V = noise_V;
  return finger;
}

TEST(FrameEstimatorTest, TwoContactsFromACold) {
  const Finger finger = EightGauges(1e-4);
  Scene scene;
  scene.contacts = 2;
  FrameEstimator estimator(finger, scene, {});
  EquilibriumSolver solver(finger, {});
  for (const double first : {25.0, 45.0, 65.0}) {
    for (const double apart : {25.0, 45.0}) {
      for (const double force : {1.0, 5.0}) {
        const PointContact one{first, force, 0}, two{first + apart, 3, 0};
        ASSERT_TRUE(solver.Solve({one, two}));
        const FrameEstimate estimate =
            estimator.Estimate(CleanReadings(solver));
        ASSERT_EQ(estimate.contacts, 2) << first << " " << apart;
        EXPECT_EQ(estimate.status, FrameStatus::kOk) << first << " " << apart;
        EXPECT_NEAR(estimate.contact[0].arc_mm, one.arc_mm, 1e-5);
        EXPECT_NEAR(estimate.contact[1].arc_mm, two.arc_mm, 1e-5);
        EXPECT_NEAR(estimate.contact[0].normal_N, one.normal_N, 1e-6);
        EXPECT_NEAR(estimate.contact[1].normal_N, two.normal_N, 1e-6);
        EXPECT_NEAR((estimate.contact[1].pose - solver.contact_pose(1)).norm(),
                    0, 1e-5);
        EXPECT_EQ(estimate.dof, 4);
      }
    }
  }
  // One of them leaves.
  ASSERT_TRUE(solver.Solve({{60, 3, 0}}));
  const FrameEstimate one = estimator.Estimate(CleanReadings(solver));
  EXPECT_EQ(one.contacts, 1);
  EXPECT_NEAR(one.contact[0].arc_mm, 60, 1e-5);
}

TEST(FrameEstimatorTest, AutoCountsContacts) {
  const Finger finger = EightGauges(1e-4);
  FrameEstimator estimator(finger, Scene(), {});
  EquilibriumSolver solver(finger, {});
  std::mt19937_64 generator(7);
  std::normal_distribution<double> noise(0, 1e-4);
  const std::vector<PointContact> cases[] = {
      {}, {{70, 3, 0}}, {{35, 4, 0}, {85, 2, 0}}};
  for (int count = 0; count < 3; ++count) {
    ASSERT_TRUE(solver.Solve(cases[count]));
    int right = 0;
    for (int i = 0; i < 50; ++i) {
      Measurements readings = CleanReadings(solver);
      for (double& v : readings.gauges_V) v += noise(generator);
      right += estimator.Estimate(readings).contacts == count;
    }
    EXPECT_GE(right, 49) << count;  // p = 0.001 a frame
  }
}

TEST(FrameEstimatorTest, ReportsBothSolutionsThatExplainAFrame) {
  // Two contacts behind four gauges, one past the last rib: another pair has
  // the same angles.
  Finger finger = PaperFinger();
  for (Gauge& gauge : finger.gauges) gauge.noise_V = 1e-4;
  Scene scene;
  scene.contacts = 2;
  EquilibriumSolver solver(finger, {});
  const std::vector<PointContact> truth = {{13.2, 2.92, 0}, {125.4, 4.38, 0}};
  ASSERT_TRUE(solver.Solve(truth));
  const Measurements readings = CleanReadings(solver);
  const FrameEstimate estimate =
      FrameEstimator(finger, scene, {}).Estimate(readings);
  EXPECT_EQ(estimate.status, FrameStatus::kUnobservable);
  ASSERT_TRUE(std::isfinite(estimate.alternative_chi2));
  int right = 0;
  for (const ContactEstimates& found :
       {estimate.contact, estimate.alternative}) {
    right += std::abs(found[0].arc_mm - 13.2) < 1e-3 &&
             std::abs(found[1].arc_mm - 125.4) < 1e-3;
    // Either one is a solution, checked by an equilibrium of its own.
    ASSERT_TRUE(solver.Solve({{found[0].arc_mm, found[0].normal_N, 0},
                              {found[1].arc_mm, found[1].normal_N, 0}}));
    for (int j = 0; j < 4; ++j) {
      EXPECT_NEAR(solver.gauge_angle(j), readings.gauges_V[j], 1e-8);
    }
  }
  EXPECT_EQ(right, 1);
}

TEST(FrameEstimatorTest, ArrivesWhereGaussNewtonCircles) {
  // For a light contact in the last bay, the unexplained noise times the
  // curvature outweighs the information.
  const Finger finger = PaperFinger();
  FrameEstimator estimator(finger, OneContact(), {});
  EquilibriumSolver solver(finger, {});
  std::mt19937_64 generator(8);
  std::normal_distribution<double> noise(0, 3e-4);
  int solved = 0;
  constexpr int kFrames = 200;
  for (int i = 0; i < kFrames; ++i) {
    ASSERT_TRUE(solver.Solve({{118 + 0.08 * i, 2, 0}}));
    Measurements readings = CleanReadings(solver);
    for (double& v : readings.gauges_V) v += noise(generator);
    const FrameEstimate estimate = estimator.Estimate(readings);
    solved += estimate.status != FrameStatus::kNotConverged;
    if (!std::isfinite(estimate.contact[0].arc_mm)) continue;
    // A minimum: it is no worse than the truth.
    double truth = 0;
    for (int j = 0; j < 4; ++j) {
      truth +=
          std::pow((readings.gauges_V[j] - solver.gauge_angle(j)) / 3e-4, 2);
    }
    EXPECT_LE(estimate.chi2, truth + 1e-3);
  }
  EXPECT_EQ(solved, kFrames);
}

TEST(FrameEstimatorTest, TriesNoStartThatCannotWin) {
  // Noise leaves this frame unexplained (p < 0.01). The other start of the
  // table, beyond the last rib, has thirty times the chi2 of the solution.
  // Fits from there creep for over a hundred iterations.
  Finger finger = PaperFinger();
  for (Gauge& gauge : finger.gauges) gauge.noise_V = 1e-4;
  Scene scene = OneContact();
  scene.friction_coefficient = 0.3;
  FrameEstimator estimator(finger, scene, {});
  Measurements readings;
  readings.gauges_V = {-0.00422438844658, 0.00256187741476, 0.00894141205513,
                       0.01463678196146};
  const FrameEstimate estimate = estimator.Estimate(readings);
  EXPECT_NEAR(estimate.contact[0].arc_mm, 98.8, 0.1);
  EXPECT_NEAR(estimate.chi2, 13.9, 0.1);
  EXPECT_LT(estimate.iterations, 10);
}

TEST(FrameEstimatorTest, RefusesWhatItCannotModel) {
  Scene two;
  two.contacts = 3;
  EXPECT_THAT([&] { FrameEstimator(PaperFinger(), two, {}); },
              ThrowsMessage<InputError>(HasSubstr("3 contacts cannot")));
  two.contacts = 2;
  Finger three = PaperFinger();
  three.gauges.pop_back();
  EXPECT_THAT([&] { FrameEstimator(three, two, {}); },
              ThrowsMessage<InputError>(HasSubstr("need at least 4 gauges")));
  Finger bare = PaperFinger();
  bare.gauges.clear();
  EXPECT_THAT([&] { FrameEstimator(bare, Scene(), {}); },
              ThrowsMessage<InputError>(HasSubstr("has no gauges")));
}

}  // namespace
}  // namespace finray
