#include "finray/control/control_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "finray/control/run_experiment.h"
#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {
namespace {

// A step from 3 to 5 N at 80 mm, with noisy gauges and the model error of a
// calibrated finger.
Experiment StepExperiment() {
  Experiment experiment;
  experiment.scene.most_contacts = 1;
  experiment.scene.object = RigidObject{Outline(CircleOutline{15}), {}};
  experiment.start = {80, 0, 1};
  experiment.actuation = {1.0 / 30, 0.13, 0.03, 50};
  experiment.set_point = Trajectory{{3, 5}, 4};
  experiment.model_error = {1, 0.3, 5e-4, 0.03};
  experiment.duration_s = 8;
  experiment.measure_from_s = 3;
  return experiment;
}

ControllerSettings Pi() {
  ControllerSettings settings;
  settings.kind = ControllerKind::kPi;
  settings.tuned_at_mm = 70;
  return settings;
}

double LargestForce(const LoopRun& run) {
  double largest = 0;
  for (const LoopRow& row : run.rows) largest = std::max(largest, row.force_N);
  return largest;
}

// Both controllers go from no contact to the wanted force. The error that
// remains is the estimator's: 1 % of EI is 0.05 N.
TEST(ControlLoopTest, ApproachesTouchesAndRegulates) {
  const Experiment experiment = StepExperiment();
  for (const ControllerSettings& controller : {ControllerSettings(), Pi()}) {
    const LoopRun run = RunLoop(PaperFinger(), experiment, controller, {}, 1);
    ASSERT_EQ(run.failure, "");
    ASSERT_EQ(run.rows.size(), 241u);
    EXPECT_EQ(run.rows[0].mode, LoopMode::kZero);
    EXPECT_EQ(run.rows[16].mode, LoopMode::kApproach);
    EXPECT_EQ(run.rows[0].force_N, 0);
    EXPECT_EQ(run.rows.back().mode, LoopMode::kControl);
    const ControlStatistics s = StatisticsOf(run, experiment, true);
    EXPECT_LT(s.settled.rms(), 0.15);
    EXPECT_EQ(s.stopped_runs, 0u);
  }
}

// With a perfect model and without noise only the limits of the loop remain.
TEST(ControlLoopTest, NoModelErrorNoError) {
  Experiment experiment = StepExperiment();
  experiment.model_error = {};
  Finger finger = PaperFinger();
  for (Gauge& gauge : finger.gauges) gauge.noise_V = 1e-7;
  const LoopRun run = RunLoop(finger, experiment, ControllerSettings(), {}, 1);
  const ControlStatistics s = StatisticsOf(run, experiment, true);
  EXPECT_LT(s.settled.most, 0.001);
  EXPECT_LT(s.estimate.most, 1e-4);
}

TEST(ControlLoopTest, EqualSeedsGiveEqualRuns) {
  Experiment experiment = StepExperiment();
  experiment.duration_s = 2;
  const auto last = [&](std::uint64_t seed) {
    return RunLoop(PaperFinger(), experiment, {}, {}, seed).rows.back();
  };
  EXPECT_EQ(last(4).force_N, last(4).force_N);
  EXPECT_NE(last(4).force_N, last(5).force_N);
}

// One motor drives two different fingers.
TEST(ControlLoopTest, TwoFingersGrasp) {
  Experiment experiment = StepExperiment();
  experiment.mechanism =
      Mechanism(FourBar{{10, -75}, {10, -15}, {50, -75}, {50, -15}});
  experiment.actuation.speed_limit = 0.8;
  experiment.safety.approach_speed = 0.07;
  experiment.set_point = Trajectory{{4, 6}, 4};
  const LoopRun run = RunLoop(PaperFinger(), experiment, {}, {}, 2);
  ASSERT_EQ(run.failure, "");
  ASSERT_EQ(run.rows.back().fingers.size(), 2u);
  EXPECT_EQ(run.rows.back().mode, LoopMode::kControl);
  EXPECT_LT(StatisticsOf(run, experiment, true).settled.rms(), 0.15);
}

// When gauges drop out, the drive stays. If they do not return, the drive goes
// back to its start and the force to 0.
TEST(ControlLoopTest, HoldsAndStopsWithoutGauges) {
  for (const ControllerSettings& controller : {ControllerSettings(), Pi()}) {
    Experiment experiment = StepExperiment();
    experiment.gauge_loss = GaugeLoss{3, 99, {0, 1, 2}};
    const LoopRun run = RunLoop(PaperFinger(), experiment, controller, {}, 1);
    ASSERT_EQ(run.failure, "");
    EXPECT_EQ(run.rows[89].mode, LoopMode::kControl);
    for (int k = 90; k < 104; ++k) {
      EXPECT_EQ(run.rows[k].mode, LoopMode::kHold) << k;
      EXPECT_EQ(run.rows[k].command, run.rows[89].command);
    }
    EXPECT_EQ(run.rows[106].mode, LoopMode::kStopped);
    EXPECT_EQ(run.rows.back().mode, LoopMode::kStopped);
    EXPECT_EQ(run.rows.back().force_N, 0);
    EXPECT_NEAR(run.rows.back().drive, 0, 1e-3);
  }
}

// The gauges return within hold_s, and the loop goes on.
TEST(ControlLoopTest, GoesOnAfterAShortLoss) {
  Experiment experiment = StepExperiment();
  experiment.gauge_loss = GaugeLoss{3, 3.3, {0, 1, 2}};
  const LoopRun run = RunLoop(PaperFinger(), experiment, {}, {}, 1);
  EXPECT_EQ(run.rows[95].mode, LoopMode::kHold);
  EXPECT_EQ(run.rows.back().mode, LoopMode::kControl);
  EXPECT_LT(StatisticsOf(run, experiment, true).settled.rms(), 0.15);
}

// Above the last rib the gauges hardly determine a contact, and the finger is
// so stiff that it gains newtons during the delay. The loop must not push a
// contact that it cannot see.
TEST(ControlLoopTest, DoesNotPushWhatItCannotSee) {
  Experiment experiment = StepExperiment();
  experiment.start.y_mm = 128;
  experiment.safety.approach_speed = 1;
  experiment.duration_s = 10;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const LoopRun run = RunLoop(PaperFinger(), experiment, {}, {}, seed);
    for (const LoopRow& row : run.rows) {
      if (row.mode == LoopMode::kControl) {
        EXPECT_EQ(row.estimates[0].status, FrameStatus::kOk);
        EXPECT_LE(row.estimates[0].contact[0].normal_std_N,
                  experiment.safety.force_std_limit_N);
      }
    }
    EXPECT_LT(LargestForce(run), 4) << seed;
  }
}

// No contact is seen, because the gauges cannot reach the limit of the std.
TEST(ControlLoopTest, StopsAboveTheStdLimit) {
  Experiment experiment = StepExperiment();
  experiment.safety.force_std_limit_N = 0.01;
  const LoopRun run = RunLoop(PaperFinger(), experiment, {}, {}, 1);
  EXPECT_EQ(run.rows.back().mode, LoopMode::kStopped);
  EXPECT_LT(LargestForce(run), 3);
  for (const LoopRow& row : run.rows) EXPECT_NE(row.mode, LoopMode::kControl);
}

// The stage is slower than assumed; measuring the drive makes up for it.
TEST(ControlLoopTest, WrongDelay) {
  Experiment experiment = StepExperiment();
  experiment.true_delay_s = 0.2;
  const LoopRun run = RunLoop(PaperFinger(), experiment, {}, {}, 1);
  EXPECT_LT(StatisticsOf(run, experiment, true).settled.rms(), 0.15);
}

TEST(ControlLoopTest, WithoutAControllerTheDriveStays) {
  Experiment experiment = StepExperiment();
  experiment.start.gap_mm = 5;
  experiment.motion = Trajectory::Wave(0, 9, 8);
  ControllerSettings none;
  none.kind = ControllerKind::kNone;
  const LoopRun run = RunLoop(PaperFinger(), experiment, none, {}, 1);
  for (const LoopRow& row : run.rows) EXPECT_EQ(row.drive, 0);
  EXPECT_GT(LargestForce(run), 3);
  const ControlStatistics s = StatisticsOf(run, experiment, false);
  EXPECT_EQ(s.control.count, 0u);
  EXPECT_LT(s.estimate.rms(), 0.1);
}

Measurements Readings(const Finger& finger,
                      const std::vector<PointContact>& contacts) {
  EquilibriumSolver solver(finger, {});
  EXPECT_TRUE(solver.Solve(contacts));
  Measurements readings;
  for (int j = 0; j < static_cast<int>(finger.gauges.size()); ++j) {
    readings.gauges_V.push_back(finger.gauges[j].Volts(solver.gauge_angle(j)));
  }
  return readings;
}

// The finger is bent by its ribs and has offsets that the model does not know.
TEST(GaugeZeroTest, TakesUnknownOffsetsOff) {
  Finger model = PaperFinger();
  model.ribs[2].length_mm += 0.3;
  model.gauges[1].offset_V = 0.2;
  Finger truth = model;
  truth.gauges[0].offset_V += 0.01;
  truth.gauges[3].offset_V -= 0.02;
  GaugeZero zero(model, {});
  Measurements loaded = Readings(truth, {{80, 4}});
  zero.Apply(&loaded);
  EXPECT_EQ(loaded.gauges_V, Readings(truth, {{80, 4}}).gauges_V);
  // Two noisy readings of the free finger, whose mean is right.
  Measurements free = Readings(truth, {});
  for (const double noise : {0.001, -0.001}) {
    Measurements noisy = free;
    for (double& volts : noisy.gauges_V) volts += noise;
    zero.Add(noisy);
  }
  zero.Apply(&loaded);
  const Measurements expected = Readings(model, {{80, 4}});
  for (int j = 0; j < 4; ++j) {
    EXPECT_NEAR(loaded.gauges_V[j], expected.gauges_V[j], 1e-12) << j;
  }
}

}  // namespace
}  // namespace finray
