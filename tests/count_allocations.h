#ifndef FINRAY_TESTS_COUNT_ALLOCATIONS_H_
#define FINRAY_TESTS_COUNT_ALLOCATIONS_H_

#include <atomic>

// Calls of malloc and its like by an executable that is linked with
// count_allocations.cc, where they can be counted.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
#define FINRAY_COUNTS_ALLOCATIONS
#endif

namespace finray {
extern std::atomic<long> allocations;
}

#endif  // FINRAY_TESTS_COUNT_ALLOCATIONS_H_
