#ifndef FINRAY_TESTS_COUNT_ALLOCATIONS_H_
#define FINRAY_TESTS_COUNT_ALLOCATIONS_H_

// Makes malloc of an executable count, where that can be done; it then defines
// FINRAY_COUNTS_ALLOCATIONS. For one source file of an executable.

#include <atomic>
#include <cstdlib>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
#define FINRAY_COUNTS_ALLOCATIONS

namespace {
std::atomic<long> allocations{0};
}

// What operator new, Eigen and the C++ library end up in.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  ++allocations;
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++allocations;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment,
                   std::size_t size) noexcept {
  ++allocations;
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? 12 : 0;  // ENOMEM
}
}
#endif

#endif  // FINRAY_TESTS_COUNT_ALLOCATIONS_H_
