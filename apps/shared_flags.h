#ifndef FINRAY_APPS_SHARED_FLAGS_H_
#define FINRAY_APPS_SHARED_FLAGS_H_

#include "app.h"

// Flags that several executables have. A source file of its own defines each
// group, so that an executable has the flags only if it calls the function.

DECLARE_string(scheme);
DECLARE_int32(resolution);

namespace finray {

/// Returns the discretization of --scheme and --resolution.
Discretization DiscretizationFlags();

/// With --dump_config, prints the configuration and returns true.
bool DumpConfigFlag(const Finger& finger, const Scene& scene,
                    const Discretization& discretization);

}  // namespace finray

#endif  // FINRAY_APPS_SHARED_FLAGS_H_
