// Is an `ok` frame right if its readings are exact? Fingers over all that a lab
// may build (studies/exact_readings.h), many of them upright or crowded with
// ribs.
//
//   build/test/tests/exact_readings_study [fingers] [first seed]

#include <cstdio>
#include <cstdlib>

#include "studies/exact_readings.h"

namespace finray {
namespace {

constexpr int kFrames = 100;  // of each finger

struct Group {
  const char* name;
  ExactTally tally;
};

void Run(unsigned seed, std::optional<int> contacts, Group* groups) {
  GaugedFingers fingers(seed);
  const Finger finger = fingers.Draw();
  Scene scene;
  scene.contacts = contacts;
  scene.most_contacts = 1;
  ExactReadings readings(finger, scene);
  const double angle_deg = finger.back_angle_rad / kDegree;
  const std::size_t ribs = finger.ribs.size();
  Group& group = groups[(angle_deg > 93) + 2 * (ribs > 12)];
  for (int i = 0; i < kFrames; ++i) {
    const PointContact contact = fingers.DrawContact(finger);
    if (readings.Add(contact, &group.tally)) continue;
    const FrameEstimate& estimate = readings.estimate();
    std::printf(
        "seed %u: %.2f deg, %zu ribs, %zu gauges of %.2g, l_0 %.0f mm: %.3f mm "
        "%.2f units as %.3f +- %.2g mm, %.2f units, chi2 %.3g\n",
        seed, angle_deg, ribs, finger.gauges.size(), finger.gauges[0].noise_V,
        finger.front_length_mm, contact.arc_mm,
        contact.normal_N / ForceUnit(finger), estimate.contact[0].arc_mm,
        estimate.contact[0].arc_std_mm,
        estimate.contact[0].normal_N / ForceUnit(finger), estimate.chi2);
    std::fflush(stdout);
  }
}

void PrintAll(int count, unsigned first, std::optional<int> contacts) {
  Group groups[] = {{"below 93 deg, up to 12 ribs", {}},
                    {"up to 12 ribs", {}},
                    {"below 93 deg, 13 to 38 ribs", {}},
                    {"13 to 38 ribs", {}}};
  for (int i = 0; i < count; ++i) Run(first + i, contacts, groups);
  std::printf(
      "\n| contacts: %s | frames | ok | ok and wrong |\n|---|---|---|---|\n",
      contacts ? "1" : "auto");
  for (const Group& group : groups) {
    std::printf("| %s | %d | %d | %d |\n", group.name, group.tally.frames,
                group.tally.ok, group.tally.wrong);
  }
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 1000;
  const unsigned first = argc > 2 ? std::atoi(argv[2]) : 1;
  finray::PrintAll(count, first, 1);
}
