#include "app.h"

DEFINE_bool(dump_config, false, "print the configuration and stop");

bool finray::DumpConfigFlag(const Finger& finger, const Scene& scene,
                            const Discretization& discretization) {
  if (FLAGS_dump_config) DumpConfig(finger, scene, discretization);
  return FLAGS_dump_config;
}
