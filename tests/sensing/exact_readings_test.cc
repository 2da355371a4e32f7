// Exact readings check the search: an `ok` frame is the contact that was
// simulated, also on fingers that are upright or crowded with ribs. On fewer
// fingers than exact_readings_study.

#include "studies/exact_readings.h"

#include <gtest/gtest.h>

namespace finray {
namespace {

TEST(ExactReadingsTest, OkFramesOfHardFingersAreRight) {
  Scene scene;
  scene.contacts = 1;
  ExactTally tally;
  for (const unsigned seed : {3, 10, 19, 54, 1105, 1109, 1143}) {
    GaugedFingers fingers(seed);
    const Finger finger = fingers.Draw();
    ExactReadings readings(finger, scene);
    for (int i = 0; i < 100; ++i) {
      const PointContact contact = fingers.DrawContact(finger);
      EXPECT_TRUE(readings.Add(contact, &tally))
          << "seed " << seed << ", " << contact.arc_mm << " mm, "
          << contact.normal_N << " N, found "
          << readings.estimate().contact[0].arc_mm << " mm";
    }
  }
  EXPECT_GT(tally.ok, 200);
  EXPECT_EQ(tally.wrong, 0);
}

}  // namespace
}  // namespace finray
