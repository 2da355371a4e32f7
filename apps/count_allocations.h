#ifndef FINRAY_APPS_COUNT_ALLOCATIONS_H_
#define FINRAY_APPS_COUNT_ALLOCATIONS_H_

#include <atomic>

// Counts calls of malloc and its like, and the bytes they ask for, in an
// executable that is linked with count_allocations.cc. Other C libraries than
// glibc and AddressSanitizer do not allow it.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
#define FINRAY_COUNTS_ALLOCATIONS
#endif

namespace finray {
extern std::atomic<long> allocations, allocated_bytes;
}

#endif  // FINRAY_APPS_COUNT_ALLOCATIONS_H_
