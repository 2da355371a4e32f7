#include "finray/estimation/offset_belief.h"

#include <gtest/gtest.h>

#include "test_finger.h"

namespace finray {
namespace {

TEST(OffsetBeliefTest, AbsorbsReadingsOfTheFreeFinger) {
  const Finger finger = PaperFinger();
  const auto gauges = static_cast<Eigen::Index>(finger.gauges.size());
  const Eigen::VectorXd angles = Eigen::VectorXd::Zero(gauges);
  OffsetBelief belief = {0, Eigen::VectorXd::Zero(gauges),
                         Eigen::VectorXd::Zero(gauges)};
  belief.Wander(4, 1e-6);
  EXPECT_DOUBLE_EQ(belief.variance_V2[0], 4e-6);
  Measurements row;
  row.gauges_V.assign(finger.gauges.size(), 0.01);
  row.gauges_V[1] = Measurements::kNotMeasured;
  belief.Absorb(finger, angles, row);
  const double noise = std::pow(finger.gauges[0].noise_V, 2);
  EXPECT_NEAR(belief.mean_V[0], 0.01 * 4e-6 / (4e-6 + noise), 1e-12);
  EXPECT_NEAR(belief.variance_V2[0], 1 / (1 / 4e-6 + 1 / noise), 1e-18);
  EXPECT_DOUBLE_EQ(belief.mean_V[1], 0);
  EXPECT_DOUBLE_EQ(belief.variance_V2[1], 4e-6);
}

TEST(HeldTouchTest, LastsUntilReadingsLeaveIt) {
  const Finger finger = PaperFinger();
  const Eigen::VectorXd held = Eigen::VectorXd::Constant(4, 0.05);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(4);
  HeldTouch touch;
  EXPECT_FALSE(touch.Lasts(finger, held, none));
  touch.Hold(held, 0);
  EXPECT_TRUE(touch.Lasts(finger, held, none));
  EXPECT_FALSE(touch.Lasts(finger, 0.1 * held, none));
  Eigen::VectorXd partly = held;
  partly[2] = Measurements::kNotMeasured;
  EXPECT_TRUE(touch.Lasts(finger, partly, none));
  // Offsets that move slowly take it along.
  for (int i = 1; i <= 380; ++i) {
    const Eigen::VectorXd now = (1 - i / 400.) * held;
    EXPECT_TRUE(touch.Lasts(finger, now, none)) << i;
    touch.Hold(now, i);
  }
  touch.End();
  EXPECT_FALSE(touch.Lasts(finger, held, none));
}

}  // namespace
}  // namespace finray
