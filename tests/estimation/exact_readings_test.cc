// Exact readings check the search: an `ok` frame is the contact that was
// simulated, also on fingers that are upright or crowded with ribs. On fewer
// fingers than exact_readings_study.

#include "studies/exact_readings.h"

#include <gtest/gtest.h>

#include "test_finger.h"

namespace finray {
namespace {

TEST(ExactReadingsTest, OkFramesOfHardFingersAreRight) {
  Scene scene;
  scene.contacts = 1;
  ExactTally tally;
  for (const unsigned seed :
       {3, 10, 19, 54, 1040, 1086, 1105, 1109, 1123, 1143, 3066}) {
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

// The paper's finger with another back angle, evenly spaced ribs in place of
// its own where `ribs` is not 0, and this noise.
Finger Changed(double angle_deg, int ribs, double noise_V) {
  Finger finger = PaperFinger();
  finger.back_angle_rad = angle_deg * kDegree;
  const double front = finger.front_length_mm;
  const double back = BeamLength(finger, Side::kBack);
  std::vector<double> places_mm;
  for (const Rib& rib : finger.ribs) places_mm.push_back(rib.front_mm);
  if (ribs > 0) places_mm.clear();
  for (int i = 1; i <= ribs; ++i) places_mm.push_back(front * i / (ribs + 1));
  finger.ribs.clear();
  for (const double place_mm : places_mm) {
    Rib rib;
    rib.front_mm = place_mm;
    rib.back_mm = back * place_mm / front;
    rib.length_mm = NominalRibLength(finger, rib);
    finger.ribs.push_back(rib);
  }
  for (Gauge& gauge : finger.gauges) gauge.noise_V = noise_V;
  return finger;
}

void ExpectRight(const Finger& finger, const std::vector<double>& arcs_mm,
                 const std::vector<double>& forces_N, int least_ok) {
  Scene scene;
  scene.contacts = 1;
  ExactTally tally;
  ExactReadings readings(finger, scene);
  for (const double arc_mm : arcs_mm) {
    for (const double force_N : forces_N) {
      EXPECT_TRUE(readings.Add({arc_mm, force_N, 0}, &tally))
          << arc_mm << " mm, " << force_N << " N, found "
          << readings.estimate().contact[0].arc_mm << " mm";
    }
  }
  EXPECT_GE(tally.ok, least_ok);
}

std::vector<double> Steps(double from, double to, double step) {
  std::vector<double> all;
  for (double x = from; x <= to; x += step) all.push_back(x);
  return all;
}

TEST(ExactReadingsTest, UprightFingers) {
  for (const double angle_deg : {90.5, 91.0}) {
    std::vector<double> arcs_mm = Steps(10, 130, 4);
    arcs_mm.push_back(107.07);
    ExpectRight(Changed(angle_deg, 0, 3e-4), arcs_mm, {1, 2, 4, 5.48, 8}, 20);
    ExpectRight(Changed(angle_deg, 0, 3e-6), arcs_mm, {1, 2, 4, 5.48, 8}, 50);
  }
}

TEST(ExactReadingsTest, ManyRibsAndLittleNoise) {
  ExpectRight(Changed(112, 38, 1e-6), Steps(8, 132, 2.5), {0.5, 2, 5.5, 11},
              100);
}

TEST(ExactReadingsTest, SixRibsUnderAHeavyLoad) {
  for (const double noise_V : {1e-6, 3e-4}) {
    ExpectRight(Changed(112, 6, noise_V), Steps(8, 132, 2), {15, 23.5}, 60);
  }
}

}  // namespace
}  // namespace finray
