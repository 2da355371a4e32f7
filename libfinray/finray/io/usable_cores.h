#ifndef FINRAY_IO_USABLE_CORES_H_
#define FINRAY_IO_USABLE_CORES_H_

#include <sched.h>

namespace finray {

/// Returns the number of cores that this process may use.
inline int UsableCores() {
  cpu_set_t set;
  return sched_getaffinity(0, sizeof(set), &set) == 0 ? CPU_COUNT(&set) : 1;
}

}  // namespace finray

#endif  // FINRAY_IO_USABLE_CORES_H_
