// The claims of docs/evidence/accuracy.md about cold starts, on fewer frames.

#include <gtest/gtest.h>

#include <optional>
#include <random>

#include "studies/cold_start.h"
#include "test_finger.h"

namespace finray {
namespace {

ColdStartTally GridAndRandom(std::optional<int> contacts) {
  Scene scene;
  scene.contacts = contacts;
  ColdStart start(PaperFinger(), scene);
  ColdStartTally sum;
  for (int i = 0; i <= 50; ++i) {
    for (int j = 0; j <= 30; ++j) {
      sum.Add(start.Run(10 + 2.5 * i, 0.05 * std::pow(200, j / 30.0)));
    }
  }
  std::mt19937_64 generator(4);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 2000; ++i) {
    const double arc = 10 + 125 * uniform(generator);
    sum.Add(start.Run(arc, 0.05 * std::pow(200, uniform(generator))));
  }
  return sum;
}

TEST(FrameEstimatorColdStartTest, FindsEveryContactThatIsKnownToBeThere) {
  const ColdStartTally tally = GridAndRandom(1);
  EXPECT_EQ(tally.frames, 51 * 31 + 2000);
  EXPECT_EQ(tally.right, tally.frames);
}

TEST(FrameEstimatorColdStartTest, AutoFindsItOrSaysThatItHidesInTheNoise) {
  const ColdStartTally tally = GridAndRandom(std::nullopt);
  EXPECT_EQ(tally.right + tally.unobservable + tally.no_contact, tally.frames);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_EQ(tally.sure_and_wrong, 0);
  EXPECT_GT(tally.right, 0.8 * tally.frames);
}

TEST(FrameEstimatorColdStartTest, GaugesOnBothBeams) {
  Scene scene;
  scene.contacts = 1;
  ColdStart start(ReadFinger(FINRAY_SOURCE_DIR
                             "/configs/fingers/paper_140mm_eight_gauges.yaml"),
                  scene);
  ColdStartTally sum;
  // Above, places at either end of the highest gauge read alike.
  for (int i = 0; i <= 44; ++i) {
    for (int j = 0; j <= 20; ++j) {
      sum.Add(start.Run(10 + 2.5 * i, 0.05 * std::pow(200, j / 20.0)));
    }
  }
  EXPECT_EQ(sum.right, sum.frames);
}

}  // namespace
}  // namespace finray
