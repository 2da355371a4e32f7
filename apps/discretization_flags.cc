#include "app.h"

DEFINE_string(scheme, "taylor", "rigid_chain or taylor");
DEFINE_int32(resolution, 0, "elements over both beams; 0: default");

finray::Discretization finray::DiscretizationFlags() {
  return ParseDiscretization(FLAGS_scheme, FLAGS_resolution);
}
