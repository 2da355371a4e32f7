// Estimates the contact in every frame of a log and writes the result.
// usage: estimate FINGER.yaml LOG.csv RESULT.csv

#include <cstdio>

#include "finray/finray.h"

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: estimate FINGER.yaml LOG.csv RESULT.csv\n");
    return 1;
  }
  try {
    const finray::Table log = finray::Table::Read(argv[2]);
    const finray::Estimator estimator(finray::Finger::Read(argv[1]));
    const finray::Estimation found = estimator.Estimate(log);
    found.Merged(log).Write(argv[3]);
    const finray::EstimationSummary& of = found.summary;
    std::printf("frames %zu, ok %zu, no_contact %zu, unobservable %zu\n",
                of.frames, of.ok, of.no_contact, of.unobservable);
    for (const finray::Warning& warning : found.warnings) {
      std::fprintf(stderr, "warning: %s; %s\n", warning.text.c_str(),
                   warning.remedy.c_str());
    }
  } catch (const finray::Error& error) {
    std::fprintf(stderr, "estimate: %s\n", error.what());
    return error.exit_code();
  }
}
