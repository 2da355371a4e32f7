// Prints the contact that a finger's gauges sense, frame by frame.

#include <cstdio>

#include "finray/finger/finger_yaml.h"
#include "finray/sensing/frame_estimator.h"

int main(int argc, char** argv) {
  if (argc != 2) return 1;
  const finray::Finger finger = finray::ReadFinger(argv[1]);
  finray::Scene scene;
  scene.contacts = 1;
  finray::FrameEstimator estimator(finger, scene);
  finray::Measurements readings;
  readings.gauges_V.resize(finger.gauges.size());
  while (true) {
    // Replace this by your sensor. It reads the volts of all gauges.
    for (double& volts : readings.gauges_V) {
      if (std::scanf("%lf", &volts) != 1) return 0;
    }
    const finray::FrameEstimate estimate = estimator.Next(readings);
    const finray::ContactEstimate& contact = estimate.contact[0];
    std::printf("%s %.2f mm %.3f N\n", finray::StatusName(estimate.status),
                contact.arc_mm, contact.normal_N);
    std::fflush(stdout);
  }
}
