#include "finray/residuals/linear_signal.h"

#include <gtest/gtest.h>

#include <cmath>

namespace finray {
namespace {

TEST(LinearSignalTest, RunsLinearlyBetweenSamples) {
  LinearSignal signal;
  EXPECT_TRUE(std::isnan(signal.At(0).value));
  signal.Add(1, 10);
  signal.Add(2, std::nan(""));
  signal.Add(3, 14);
  signal.Add(3, 20);
  signal.Add(4, 13);
  EXPECT_EQ(signal.At(0).value, 10);
  EXPECT_EQ(signal.At(0).slope, 0);
  EXPECT_EQ(signal.At(2).value, 12);
  EXPECT_EQ(signal.At(2).slope, 2);
  EXPECT_EQ(signal.At(3).value, 14);
  EXPECT_EQ(signal.At(3).slope, 0.5);
  EXPECT_EQ(signal.At(3.5).value, 13.5);
  EXPECT_EQ(signal.At(4).slope, -0.5);
  EXPECT_EQ(signal.At(9).value, 13);
  EXPECT_EQ(signal.At(9).slope, 0);
}

TEST(LinearSignalTest, AChangeByNoTimeIsNoChange) {
  LinearSignal signal;
  EXPECT_EQ(signal.Change(1, 0.5).value, 0);
  // Of 10, 11 and 12 at one time only the first is kept.
  for (const double force : {10.0, 11.0, 12.0}) signal.Add(1, force);
  signal.Add(2, 14);
  for (const double time_s : {0.0, 1.0, 1.5, 7.0}) {
    EXPECT_EQ(signal.Change(time_s, 0).value, 0);
  }
  EXPECT_EQ(signal.Change(1, 0.5).value, 2);
  EXPECT_EQ(signal.Change(1, 0.5).slope, 4);
  EXPECT_EQ(signal.Change(2, -0.25).value, -1);
  EXPECT_EQ(signal.Change(std::nan(""), 1).value, 0);
}

}  // namespace
}  // namespace finray
