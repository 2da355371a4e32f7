#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "finray/io/error.h"
#include "finray/perception/reconstruction.h"
#include "perception/touch_fixture.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

Touches Usable(const std::vector<Touch>& touches) {
  Touches all;
  all.usable = touches;
  all.rows[FrameStatus::kOk] = touches.size();
  return all;
}

TEST(TouchCoverageTest, RefusesTooFewTouches) {
  Touches few = Usable(ExactTouches(Outline(CircleOutline{10}), 7));
  few.rows[FrameStatus::kUnobservable] = 3;
  EXPECT_THAT([&] { CheckSpread(few, "a.csv"); },
              ThrowsMessage<InputError>(
                  HasSubstr("a.csv: too few touches: 7 usable in 10 rows (7 "
                            "ok, 3 unobservable)")));
  EXPECT_NO_THROW(
      CheckSpread(Usable(ExactTouches(Outline(CircleOutline{10}), 8)), ""));
}

TEST(TouchCoverageTest, RefusesTouchesFromOneSide) {
  std::vector<Touch> side;
  for (int i = 0; i < 20; ++i) {
    side.push_back(ExactTouch(Outline(CircleOutline{10}), 0.2 * i - 1.9));
  }
  EXPECT_THAT([&] { CheckSpread(Usable(side), "a.csv"); },
              ThrowsMessage<SpreadError>(HasSubstr(
                  "none has a normal between 109 and -109 deg of the object's "
                  "frame, a gap of 142 deg")));
}

// No touch lies within 60 deg of a circle. That part is open, except for R / 20
// at each end.
TEST(TouchCoverageTest, SaysWhereNoTouchLies) {
  const Outline circle(CircleOutline{20});
  const ConvexCurve curve(NormalGrid(90), {20, 0},
                          Eigen::VectorXd::Constant(90, 20));
  std::vector<Touch> touches;
  for (int i = 0; i <= 30; ++i) {
    touches.push_back(ExactTouch(circle, M_PI / 3 + i * M_PI / 18));
  }
  const TouchCoverage coverage(curve, touches);
  ASSERT_EQ(coverage.Gaps().size(), 1u);
  EXPECT_NEAR(coverage.Gaps()[0].length_mm, 20 * (M_PI / 3 - 0.1), 0.1);
  EXPECT_NEAR(coverage.SupportedShare(), 1 - (M_PI / 3 - 0.1) / (2 * M_PI),
              1e-3);
  EXPECT_FALSE(coverage.Supports(M_PI / 6));
  EXPECT_TRUE(coverage.Supports(M_PI / 3 - 0.04));
  EXPECT_TRUE(coverage.Supports(M_PI));
}

}  // namespace
}  // namespace finray
