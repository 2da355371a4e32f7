// Contact from four gauges, frame by frame.

#include <cstdio>

#include "finray/finger/finger_yaml.h"
#include "finray/sensing/live_estimator.h"

int main(int argc, char** argv) {
  if (argc != 2) return 1;
  finray::Scene scene;
  scene.contacts = 1;
  finray::LiveEstimator estimator(finray::ReadFinger(argv[1]), scene);
  finray::FrameReadings readings;
  readings.gauges_V.resize(4);
  double* volts = readings.gauges_V.data();
  // Instead of your sensor: four volts a line.
  while (std::scanf("%lf %lf %lf %lf", volts, volts + 1, volts + 2,
                    volts + 3) == 4) {
    const finray::FrameEstimate& estimate = estimator.Next(readings);
    const finray::ContactEstimate& contact = estimate.contact[0];
    std::printf("%s %.2f mm %.3f N\n", finray::StatusName(estimate.status),
                contact.arc_mm, contact.normal_N);
    std::fflush(stdout);
  }
}
