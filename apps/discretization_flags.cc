#include "app.h"

DEFINE_string(scheme, "taylor",
              "rigid_chain, taylor4, taylor8, taylor12 or taylor");
DEFINE_int32(resolution, 0, "elements over both beams; 0: default");

finray::Discretization finray::DiscretizationFlags() {
  try {
    return ParseDiscretization(FLAGS_scheme, FLAGS_resolution);
  } catch (const InputError& error) {
    throw UsageError(error.what());
  }
}
