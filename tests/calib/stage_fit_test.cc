#include "finray/calib/analysis/stage_fit.h"

#include <gtest/gtest.h>

#include "calib/standard_log.h"

namespace finray {
namespace {

// The stage alone is fitted: an offset that wanders has no knots then, however
// long the log is.
TEST(StageFitTest, LongLogsAreAlignedWithAPlanThatLetsOffsetsWander) {
  const TempFolder folder;
  FrameTable log = FrameTable::Read(StandardLog(folder, HiddenFinger(), 87));
  for (std::size_t i = 0; i < log.rows(); ++i) {
    log.MutableNumbers("time_s")[i] = 40.0 * static_cast<double>(i);
    log.MutableNumbers("object_x_mm")[i] += 0.4;
  }
  log.Write(folder.Path("long.csv"));
  Plan plan = StandardPlan();
  plan.families[static_cast<int>(ParameterFamily::kObjectOrigin)] = {true, 0.5,
                                                                     false};
  plan.families[static_cast<int>(ParameterFamily::kGaugeDrift)].free = true;
  plan.gauge_walk = GaugeWalk{0.001, 60};
  const Finger finger = HiddenFinger();
  CalibrationLogs logs =
      ReadCalibrationLogs({folder.Path("long.csv")}, finger, plan);
  const std::vector<FittedStage> stages =
      AlignStages(finger, plan, {}, 2, &logs);
  ASSERT_EQ(stages.size(), 1u);
  EXPECT_NEAR(stages[0].origin_mm.x(), -0.4, 5 * stages[0].origin_std_mm.x());
}

}  // namespace
}  // namespace finray
