#include "finray/control/run_experiment.h"

#include <gtest/gtest.h>

#include <cmath>

namespace finray {
namespace {

// Forces that follow the set-point with an offset or a lag.
LoopRun Follow(const Experiment& experiment, double offset_N, double lag_s) {
  LoopRun run;
  for (int k = 0; k <= 300; ++k) {
    LoopRow row;
    row.time_s = k / 30.0;
    row.set_point_N = experiment.set_point.At(row.time_s);
    row.force_N = experiment.set_point.At(row.time_s - lag_s) + offset_N;
    row.seen = {row.force_N + 0.2, 0.1};
    row.sure = k % 2 == 0;
    row.mode = LoopMode::kControl;
    run.rows.push_back(row);
  }
  return run;
}

TEST(ControlStatisticsTest, OffsetAndLag) {
  Experiment experiment;
  experiment.set_point = Trajectory::Wave(4, 2, 3);
  experiment.measure_from_s = 1;
  const ControlStatistics s =
      StatisticsOf(Follow(experiment, 0.3, 0), experiment, true);
  EXPECT_NEAR(s.control.rms(), 0.3, 1e-12);
  EXPECT_NEAR(s.control.mean(), 0.3, 1e-12);
  EXPECT_NEAR(s.estimate.rms(), 0.2, 1e-12);
  EXPECT_EQ(s.periods, 271u);
  EXPECT_EQ(s.control.count, 271u);
  EXPECT_EQ(s.estimate.count, 136u);
  EXPECT_NEAR(LagSeconds(Follow(experiment, 0, 0.13), experiment), 0.13, 1e-9);
}

// The error is 2 N for 0.1 s after each step and 0 otherwise.
TEST(ControlStatisticsTest, SettledIsBehindTheSteps) {
  Experiment experiment;
  experiment.set_point = Trajectory{{4, 6, 4}, 3};
  experiment.measure_from_s = 0;
  experiment.settled_after_s = 0.2;
  const ControlStatistics s =
      StatisticsOf(Follow(experiment, 0, 0.095), experiment, true);
  EXPECT_NEAR(s.control.most, 2, 1e-12);
  EXPECT_NEAR(s.control.squares, 2 * 3 * 4, 1e-9);
  EXPECT_EQ(s.settled.most, 0);
  EXPECT_EQ(s.control.count - s.settled.count, 12u);
}

TEST(ControlStatisticsTest, RunsAddUp) {
  Experiment experiment;
  experiment.set_point = Trajectory{{4}};
  experiment.measure_from_s = 0;
  ControlStatistics all =
      StatisticsOf(Follow(experiment, 0.3, 0), experiment, true);
  all.Add(StatisticsOf(Follow(experiment, -0.4, 0), experiment, true));
  EXPECT_EQ(all.runs, 2u);
  EXPECT_NEAR(all.control.rms(), std::sqrt((0.09 + 0.16) / 2), 1e-12);
  EXPECT_NEAR(all.control.mean(), -0.05, 1e-12);
  EXPECT_NEAR(all.worst_rms_N, 0.4, 1e-12);
  EXPECT_NEAR(all.best_rms_N, 0.3, 1e-12);
}

}  // namespace
}  // namespace finray
