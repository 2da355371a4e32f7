#include "finray/residuals/frame_set.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <deque>

#include "test_finger.h"

namespace finray {
namespace {

TEST(FrameSetTest, ThreadsDoNotChangeAnything) {
  const Finger finger = PaperFinger();
  SharedParameters shared = SharedParameters::Of(finger);
  std::deque<std::array<double, 2>> contacts;
  for (int i = 0; i < 100; ++i) contacts.push_back({20.0 + i, 0.1 + 0.07 * i});
  std::vector<Eigen::VectorXd> first;
  for (const int threads : {1, 2}) {
    FrameSet frames(finger, {}, EquilibriumForm::kReduced, &shared, threads);
    for (auto& contact : contacts) {
      frames.Add(1, 0, contact.data());
      frames.Add(0, 0, nullptr);
    }
    frames.PrepareForEvaluation(true, true);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      ASSERT_TRUE(frames[i].valid());
      if (threads == 1) {
        first.push_back(frames[i].outputs());
      } else {
        EXPECT_EQ(frames[i].outputs(), first[i]) << i;
      }
    }
  }
}

TEST(FrameSetTest, ImpossibleParametersAreNotValid) {
  const Finger finger = PaperFinger();
  SharedParameters shared = SharedParameters::Of(finger);
  double contact[2] = {50, 1};
  FrameSet frames(finger, {}, EquilibriumForm::kReduced, &shared, 1);
  FrameEvaluation& frame = frames.Add(1, 0, contact);
  const auto valid = [&] {
    frames.PrepareForEvaluation(true, true);
    return frame.valid();
  };
  EXPECT_TRUE(valid());
  contact[0] = std::nan("");
  EXPECT_FALSE(valid());
  contact[0] = 50;
  shared.rib_lengths_mm[0] = -1;
  EXPECT_FALSE(valid());
  shared.rib_lengths_mm[0] = finger.ribs[0].length_mm;
  shared.ln_front_stiffness = 1e6;
  EXPECT_FALSE(valid());
  shared.ln_front_stiffness = std::log(12500.0);
  EXPECT_TRUE(valid());
}

}  // namespace
}  // namespace finray
