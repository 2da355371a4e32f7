// Prints what the gauges of a finger read under one contact.
// usage: forward FINGER.yaml CONTACT_MM NORMAL_N

#include <cstdio>
#include <cstdlib>

#include "finray/finray.h"

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: forward FINGER.yaml CONTACT_MM NORMAL_N\n");
    return 1;
  }
  try {
    const finray::Finger finger = finray::Finger::Read(argv[1]);
    finray::Table load(1);
    load.Set("contact_1_mm", {std::atof(argv[2])});
    load.Set("normal_1_N", {std::atof(argv[3])});
    const finray::Simulation found = finray::Simulator(finger).Simulate(load);
    std::printf("%s\n", found.frames.TextAt("status")[0].c_str());
    for (int j = 1; j <= finger.gauges(); ++j) {
      const std::string column = "gauge_" + std::to_string(j) + "_V";
      std::printf("%s %.6f\n", column.c_str(), found.frames.At(column)[0]);
    }
  } catch (const finray::Error& error) {
    std::fprintf(stderr, "forward: %s\n", error.what());
    return error.exit_code();
  }
}
