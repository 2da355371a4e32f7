#include "finray/calib/analysis/leave_one_log_out.h"

#include <gtest/gtest.h>

#include <cmath>

#include "calib/calibrated.h"
#include "calib/log_rows.h"

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
  return LeaveLogsOut(calibrated.problem.get(), calibrated.solution,
                      calibrated.found);
}

TEST(LeaveOneLogOutTest, EqualLogsSpreadAsTheStdSays) {
  const LeaveOneLogOut found = FiveLogs(0);
  EXPECT_EQ(found.groups, 5);
  EXPECT_TRUE(found.all_converged);
  ASSERT_EQ(found.rows.size(), 15u);
  EXPECT_EQ(found.Worst(), nullptr);
  double squares = 0;
  for (const auto& row : found.rows) squares += row.ratio() * row.ratio() / 15;
  // The largest of five normal numbers squared is 2.6 on average; parameters go
  // together.
  EXPECT_GT(squares, 1);
  EXPECT_LT(squares, 5);
}

TEST(LeaveOneLogOutTest, ALogThatDiffersIsSeen) {
  const LeaveOneLogOut found = FiveLogs(0.01);
  ASSERT_NE(found.Worst(), nullptr);
  // A step d in one of five equal logs moves the mean by d / 5, and leaving it
  // out has a std of s / 2: spread = 2 d / 5.
  const auto& offset = found.rows[7];
  EXPECT_NEAR(offset.spread, 0.004, 0.0012);
  EXPECT_GT(offset.ratio(), 6);
}

// One log dealt out 24 : 1; gauge 2 of the small one has moved by `step_V`.
LeaveOneLogOut Unequal(unsigned seed, double step_V) {
  const TempFolder folder;
  const FrameTable whole =
      FrameTable::Read(StandardLog(folder, HiddenFinger(), seed));
  const std::vector<std::string> logs = {folder.Path("large.csv"),
                                         folder.Path("small.csv")};
  for (const bool small : {false, true}) {
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < whole.rows(); ++i) {
      if ((i % 25 == 12) == small) rows.push_back(i);
    }
    FrameTable part(rows.size());
    for (const char* name : {"gauge_1_V", "gauge_2_V", "gauge_3_V", "gauge_4_V",
                             "force_N", "object_x_mm", "object_y_mm"}) {
      for (std::size_t i = 0; i < rows.size(); ++i) {
        part.MutableNumbers(name)[i] = whole.Numbers(name)[rows[i]];
      }
    }
    if (small) {
      for (double& volts : part.MutableNumbers("gauge_2_V")) volts += step_V;
    }
    part.Write(logs[small]);
  }
  Calibrated calibrated(StandardPlan(), logs);
  return LeaveLogsOut(calibrated.problem.get(), calibrated.solution,
                      calibrated.found);
}

// What a small log alone says is far from what all say, and may be.
TEST(LeaveOneLogOutTest, UnequalLogsThatAgree) {
  for (unsigned seed = 80; seed < 84; ++seed) {
    const LeaveOneLogOut found = Unequal(seed, 0);
    EXPECT_EQ(found.groups, 2);
    ASSERT_GT(found.rows.size(), 8u);
    EXPECT_EQ(found.Worst(), nullptr);
    for (const auto& row : found.rows) EXPECT_LT(row.ratio(), 3.5);
  }
}

TEST(LeaveOneLogOutTest, ASmallLogThatDiffersIsSeen) {
  EXPECT_NE(Unequal(80, 0.01).Worst(), nullptr);
}

// Gains of 18 to 25 V/rad are ten std off a prior of 1 +- 2 V/rad. The logs
// agree all the same: one has the lower half of the finger, one the upper.
TEST(LeaveOneLogOutTest, AContradictedPriorIsNoDisagreement) {
  Finger amplified = HiddenFinger();
  Finger start = Nominal();
  for (std::size_t j = 0; j < amplified.gauges.size(); ++j) {
    for (double* number :
         {&amplified.gauges[j].gain_V_per_rad, &amplified.gauges[j].offset_V,
          &amplified.gauges[j].noise_V, &start.gauges[j].noise_V}) {
      *number *= 10;
    }
  }
  int disagree = 0;
  for (unsigned seed = 90; seed < 96; ++seed) {
    const TempFolder folder;
    const FrameTable whole =
        FrameTable::Read(StandardLog(folder, amplified, seed));
    const auto keep = [](double from, double to) {
      return [=](const FrameTable& all, std::size_t row) {
        const double y = all.Numbers("object_y_mm")[row];
        return row % 5 == 0 && y >= from && y < to;
      };
    };
    RowsWhere(whole, keep(0, 60)).Write(folder.Path("low.csv"));
    RowsWhere(whole, keep(60, 200)).Write(folder.Path("high.csv"));
    Calibrated calibrated(StandardPlan(),
                          {folder.Path("low.csv"), folder.Path("high.csv")},
                          start);
    disagree += LeaveLogsOut(calibrated.problem.get(), calibrated.solution,
                             calibrated.found)
                    .Worst() != nullptr;
  }
  EXPECT_EQ(disagree, 0);
}

// Leaving the other out would leave nothing to fit.
TEST(LeaveOneLogOutTest, ALogWithNothingToFitIsNoLog) {
  const TempFolder folder;
  const std::string log = StandardLog(folder, HiddenFinger(), 70);
  FrameTable blind = FrameTable::Read(log);
  for (const char* name :
       {"gauge_1_V", "gauge_2_V", "gauge_3_V", "gauge_4_V", "force_N"}) {
    blind.MutableNumbers(name).assign(blind.rows(), NAN);
  }
  blind.Write(folder.Path("blind.csv"));
  Calibrated calibrated(StandardPlan(), {log, folder.Path("blind.csv")});
  EXPECT_EQ(LeaveLogsOut(calibrated.problem.get(), calibrated.solution,
                         calibrated.found)
                .groups,
            0);
}

TEST(LeaveOneLogOutTest, OneLogIsNotLeftOut) {
  const TempFolder folder;
  Calibrated calibrated(StandardPlan(),
                        {StandardLog(folder, HiddenFinger(), 70)});
  EXPECT_EQ(LeaveLogsOut(calibrated.problem.get(), calibrated.solution,
                         calibrated.found)
                .groups,
            0);
}

}  // namespace
}  // namespace finray
