// Prints the contact that a finger's gauges sense, frame by frame.

#include <cstdio>

#include "finray/finray.h"

int main(int argc, char** argv) {
  if (argc != 2) return 1;
  const finray::Finger finger = finray::Finger::Read(argv[1]);
  const finray::Scene scene = finray::Scene::FromYaml("most_contacts: 1");
  finray::LiveEstimator estimator(finger, scene);
  finray::Readings readings;
  readings.gauges_V.resize(finger.gauges());
  while (true) {
    // Replace this by your sensor. It reads the volts of all gauges.
    for (double& volts : readings.gauges_V) {
      if (std::scanf("%lf", &volts) != 1) return 0;
    }
    const finray::Frame& frame = estimator.Next(readings);
    const finray::Contact& contact = frame.contact[0];
    std::printf("%s %.2f mm %.3f N\n", finray::StatusName(frame.status),
                contact.arc_mm, contact.normal_N);
    std::fflush(stdout);
  }
}
