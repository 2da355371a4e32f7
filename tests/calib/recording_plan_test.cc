#include "finray/calib/design/recording_plan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "calib/standard_log.h"
#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "finray/scene/simulation.h"
#include "temp_file.h"

namespace finray {
namespace {

// Priors of a lab that has drawn its finger.
Plan LabPlan() {
  Plan plan = StandardPlan();
  const double priors[] = {15, 15, 20, 0.05, 0.3};
  for (int i = 0; i < 5; ++i) plan.families[i].prior_std = priors[i];
  return plan;
}

const RecordingLimits kLimits{{-30, 0}, {15, 150}, 8};
const RecordingTarget kTarget{28, 98, 3, 0.7, 0.08, 0.95};

RecordingPlan PlanOf(const Finger& finger, std::uint64_t seed,
                     const RecordingLimits& limits = kLimits) {
  const Plan plan = LabPlan();
  return PlanRecording(FromDrawing(finger, plan, {}), plan, limits, kTarget,
                       seed, 100, {});
}

TEST(RecordingPlanTest, RowsAreWithinLimitsAndAsExpected) {
  const RecordingPlan plan = PlanOf(PaperFinger(), 1);
  ASSERT_TRUE(plan.suffices);
  ASSERT_GE(plan.rows.size(), 30u);  // two for each free parameter
  EXPECT_FALSE(plan.rows.front().touches);
  EXPECT_FALSE(plan.rows.back().touches);
  FrameTable frames(plan.rows.size());
  for (std::size_t i = 0; i < plan.rows.size(); ++i) {
    const RecordingRow& row = plan.rows[i];
    EXPECT_TRUE((row.object_mm.array() >= kLimits.from_mm.array()).all());
    EXPECT_TRUE((row.object_mm.array() <= kLimits.to_mm.array()).all());
    EXPECT_LE(row.force_N, kLimits.force_max_N);
    EXPECT_LE(row.force_low_N, row.force_N);
    EXPECT_GE(row.force_high_N, row.force_N);
    frames.MutableNumbers("object_x_mm")[i] = row.object_mm.x();
    frames.MutableNumbers("object_y_mm")[i] = row.object_mm.y();
  }
  // The simulation of the stage's places has these forces and volts.
  ASSERT_EQ(Simulate(PaperFinger(), LabPlan().scene, {}, &frames).not_converged,
            0);
  for (std::size_t i = 0; i < plan.rows.size(); ++i) {
    EXPECT_NEAR(frames.Numbers("force_N")[i], plan.rows[i].force_N, 1e-6);
    EXPECT_NEAR(frames.Numbers("gauge_3_V")[i], plan.rows[i].gauges_V[2], 1e-8);
  }
}

TEST(RecordingPlanTest, TheSeedMakesTheOrder) {
  const RecordingPlan one = PlanOf(PaperFinger(), 1),
                      same = PlanOf(PaperFinger(), 1),
                      other = PlanOf(PaperFinger(), 2);
  ASSERT_EQ(one.rows.size(), same.rows.size());
  int rising = 0;
  for (std::size_t i = 0; i < one.rows.size(); ++i) {
    EXPECT_EQ(one.rows[i].object_mm, same.rows[i].object_mm);
    if (i > 0) {
      rising += one.rows[i].object_mm.y() > one.rows[i - 1].object_mm.y();
    }
  }
  EXPECT_NE(one.rows[1].object_mm, other.rows[1].object_mm);
  EXPECT_GT(rising, 8);
  EXPECT_LT(rising, static_cast<int>(one.rows.size()) - 8);
}

TEST(RecordingPlanTest, ImpossibleTasksAreRefused) {
  RecordingLimits limits = kLimits;
  limits.from_mm.x() = -16;  // R = 15: it cannot leave the finger by 5 mm
  EXPECT_THROW(PlanOf(PaperFinger(), 1, limits), InputError);
  limits = {{-300, 0}, {-100, 150}, 8};  // another origin: it reaches nothing
  EXPECT_THROW(PlanOf(PaperFinger(), 1, limits), InputError);
  Plan plan = LabPlan();
  plan.scene.object.reset();
  EXPECT_THROW(PlanRecording(FromDrawing(PaperFinger(), plan, {}), plan,
                             kLimits, kTarget, 1, 50, {}),
               InputError);
}

TEST(RecordingPlanTest, NoiseMayBeAboveTheTarget) {
  const Plan plan = LabPlan();
  RecordingTarget target = kTarget;
  target.place_mm = 0.2;
  const RecordingPlan recording = PlanRecording(
      FromDrawing(PaperFinger(), plan, {}), plan, kLimits, target, 1, 40, {});
  EXPECT_FALSE(recording.suffices);
  EXPECT_GT(recording.noise_mm, 0.2);
}

// A log of 210 rows is enough; of the first rows of it more are needed, but
// fewer than of nothing.
TEST(RecordingPlanTest, GoesOnFromALog) {
  const TempFolder folder;
  const std::string path = StandardLog(folder, HiddenFinger(), 3);
  Plan plan = LabPlan();
  plan.families[static_cast<int>(ParameterFamily::kGaugeGain)].prior_std = 200;
  const KnownFinger known = FromLogs(Nominal(), plan, {path}, {}, 2);
  EXPECT_NEAR(
      known.finger.front_stiffness_N_mm2 / HiddenFinger().front_stiffness_N_mm2,
      1, 0.03);
  RecordingTarget target = kTarget;
  target.place_mm = 0.9;
  target.force_N = 0.1;
  const RecordingPlan rest =
      PlanRecording(known, plan, kLimits, target, 1, 60, {});
  EXPECT_TRUE(rest.suffices);
  EXPECT_TRUE(rest.rows.empty());
  EXPECT_GE(rest.met_before, 0.95);
}

// Fingers drawn from a drawing spread by its priors.
TEST(DrawFromTest, SpreadsByThePriors) {
  const Plan plan = LabPlan();
  const KnownFinger known = FromDrawing(PaperFinger(), plan, {});
  double stiffness = 0, gain = 0, rib = 0;
  constexpr int kDraws = 200;
  for (unsigned k = 0; k < kDraws; ++k) {
    const Finger drawn = DrawFrom(known, plan, k, {}).finger;
    stiffness += std::pow(std::log(drawn.front_stiffness_N_mm2 / 12500), 2);
    gain += std::pow(drawn.gauges[1].gain_V_per_rad - 1, 2);
    rib +=
        std::pow(drawn.ribs[3].length_mm - PaperFinger().ribs[3].length_mm, 2);
  }
  EXPECT_NEAR(std::sqrt(stiffness / kDraws), 0.15, 0.02);
  EXPECT_NEAR(std::sqrt(gain / kDraws), 0.2, 0.03);
  EXPECT_NEAR(std::sqrt(rib / kDraws), 0.3, 0.04);
}

TEST(StageFrameTest, FromSIsTheInverse) {
  const StageFrame stage{{3, -7}, 25, 0.02};
  const Eigen::Vector2d place(12, 34);
  EXPECT_LT((stage.FromS(stage.InS(place)) - place).norm(), 1e-12);
}

}  // namespace
}  // namespace finray
