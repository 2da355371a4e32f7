// Calibrates a finger from logs and writes finger.yaml and calibration.yaml.
// usage: calibrate FINGER.yaml PLAN.yaml OUT_DIR LOG.csv...

#include <cstdio>

#include "finray/finray.h"

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr,
                 "usage: calibrate FINGER.yaml PLAN.yaml OUT_DIR LOG.csv...\n");
    return 1;
  }
  try {
    const finray::Calibration found = finray::Calibration::Run(
        finray::Finger::Read(argv[1]), finray::Plan::Read(argv[2]),
        std::vector<std::string>(argv + 4, argv + argc));
    for (const finray::CalibratedParameter& p : found.parameters()) {
      std::printf("%-28s %12.6g +- %-10.2g %s\n", p.name.c_str(), p.value,
                  p.std, p.status.c_str());
    }
    for (const finray::Warning& warning : found.warnings()) {
      std::fprintf(stderr, "warning: %s; %s\n", warning.text.c_str(),
                   warning.remedy.c_str());
    }
    found.Write(argv[3], /*report=*/false);
    std::printf("verdict: %s\n", found.verdict().c_str());
    return found.verdict() == "good" ? 0 : 4;
  } catch (const finray::Error& error) {
    std::fprintf(stderr, "calibrate: %s\n", error.what());
    return error.exit_code();
  }
}
