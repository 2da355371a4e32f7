#ifndef FINRAY_IO_USABLE_CORES_H_
#define FINRAY_IO_USABLE_CORES_H_

#include <sched.h>

#include <string>

#include "finray/io/error.h"

namespace finray {

/// More threads than cores serve tests only; far more exhaust the system.
constexpr int kMostThreads = 1024;

/// Returns the number of cores that this process may use.
inline int UsableCores() {
  cpu_set_t set;
  return sched_getaffinity(0, sizeof(set), &set) == 0 ? CPU_COUNT(&set) : 1;
}

/// Returns the number of threads that a user asks for; for 0 as many as cores.
/// Throws InputError below 0 and above kMostThreads. `name` is that of the
/// option in the message.
inline int ThreadsFor(const char* name, int asked) {
  if (asked < 0 || asked > kMostThreads) {
    throw InputError(std::string(name) + ": expected 0 (all cores) to " +
                     std::to_string(kMostThreads) + ", found " +
                     std::to_string(asked));
  }
  return asked > 0 ? asked : UsableCores();
}

}  // namespace finray

#endif  // FINRAY_IO_USABLE_CORES_H_
