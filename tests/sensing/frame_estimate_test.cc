#include "finray/sensing/frame_estimate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "finray/scene/simulation.h"
#include "test_finger.h"

namespace finray {
namespace {

// The reference force of a simulated frame of two contacts.
TEST(FrameEstimateTest, IsWhatASensorUnderTheFingerMeasures) {
  Scene scene;
  scene.friction_coefficient = 0.3;
  FrameTable frames(1);
  const double arc[] = {40, 110}, normal[] = {3, 2};
  for (int c = 0; c < 2; ++c) {
    const std::string index = std::to_string(c + 1);
    frames.MutableNumbers("contact_" + index + "_mm")[0] = arc[c];
    frames.MutableNumbers("normal_" + index + "_N")[0] = normal[c];
  }
  Simulate(PaperFinger(), scene, {}, &frames);
  FrameEstimate estimate;
  estimate.contacts = 2;
  for (int c = 0; c < 2; ++c) {
    estimate.contact[c].arc_mm = arc[c];
    estimate.contact[c].normal_N = normal[c];
    estimate.contact[c].pose.z() =
        frames.Numbers("contact_" + std::to_string(c + 1) + "_angle_rad")[0];
  }
  const double force = EstimatedForce(estimate, 0.3);
  EXPECT_NEAR(force, frames.Numbers("force_N")[0], 1e-12);
  EXPECT_LT(force, 5 * std::hypot(1, 0.3) - 1e-3);  // they are not parallel

  estimate.contacts = 1;
  EXPECT_NEAR(EstimatedForce(estimate, 0.3), 3 * std::hypot(1, 0.3), 1e-14);
  EXPECT_TRUE(std::isnan(EstimatedForce(FrameEstimate(), 0.3)));
}

// Two contacts on their bounds leave a chi2 although there is no freedom left.
TEST(FrameEstimateTest, AChi2WithoutFreedomIsUnexplained) {
  FrameEstimate estimate;
  estimate.contacts = 2;
  estimate.dof = 0;
  estimate.chi2 = 1e-9;
  EXPECT_FALSE(estimate.IsUnexplained());
  estimate.chi2 = 2e6;
  EXPECT_TRUE(estimate.IsUnexplained());
  EXPECT_EQ(estimate.noise_scale(), 1);
  estimate.dof = 2;
  estimate.chi2 = 5;
  EXPECT_FALSE(estimate.IsUnexplained());
}

}  // namespace
}  // namespace finray
