#include "finray/calib/leave_one_log_out.h"

#include <gtest/gtest.h>

#include <cmath>

#include "calib/calibrated.h"

namespace finray {
namespace {

// Five logs of 210 frames; gauge 2 of the third has moved by `step_V`.
LeaveOneLogOut FiveLogs(double step_V) {
  const TempFolder folder;
  std::vector<std::string> logs;
  for (unsigned i = 0; i < 5; ++i) {
    FrameTable log =
        FrameTable::Read(StandardLog(folder, HiddenFinger(), 60 + i));
    if (i == 2) {
      for (double& volts : log.MutableNumbers("gauge_2_V")) volts += step_V;
    }
    logs.push_back(folder.Path("log_" + std::to_string(i) + ".csv"));
    log.Write(logs.back());
  }
  Calibrated calibrated(StandardPlan(), logs);
  return LeaveLogsOut(*calibrated.problem, calibrated.found, {}, 2);
}

TEST(LeaveOneLogOutTest, EqualLogsSpreadAsTheStdSays) {
  const LeaveOneLogOut found = FiveLogs(0);
  EXPECT_EQ(found.groups, 5);
  EXPECT_TRUE(found.all_converged);
  ASSERT_EQ(found.rows.size(), 15u);
  EXPECT_EQ(found.Worst(), nullptr);
  double squares = 0;
  for (const auto& row : found.rows) squares += row.ratio() * row.ratio() / 15;
  // 4 degrees of freedom, and parameters that go together.
  EXPECT_GT(squares, 0.4);
  EXPECT_LT(squares, 2);
}

TEST(LeaveOneLogOutTest, ALogThatDiffersIsSeen) {
  const LeaveOneLogOut found = FiveLogs(0.01);
  ASSERT_NE(found.Worst(), nullptr);
  // The jackknife spread of a step d in one of five equal logs: d / 5.
  const auto& offset = found.rows[7];
  EXPECT_NEAR(offset.spread, 0.002, 0.0006);
  EXPECT_GT(offset.ratio(), 4);
}

TEST(LeaveOneLogOutTest, OneLogIsNotLeftOut) {
  const TempFolder folder;
  Calibrated calibrated(StandardPlan(),
                        {StandardLog(folder, HiddenFinger(), 70)});
  EXPECT_EQ(LeaveLogsOut(*calibrated.problem, calibrated.found, {}, 1).groups,
            0);
}

}  // namespace
}  // namespace finray
