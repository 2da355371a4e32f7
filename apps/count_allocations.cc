#include "count_allocations.h"

#include <cstdlib>

std::atomic<long> finray::allocations{0}, finray::allocated_bytes{0};

#ifdef FINRAY_COUNTS_ALLOCATIONS
namespace {
void Count(std::size_t bytes) {
  finray::allocations.fetch_add(1, std::memory_order_relaxed);
  finray::allocated_bytes.fetch_add(static_cast<long>(bytes),
                                    std::memory_order_relaxed);
}
}  // namespace

// operator new, Eigen and the C++ library all call these.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept {
  Count(size);
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  Count(count * size);
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  Count(size);
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  Count(size);
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment,
                   std::size_t size) noexcept {
  Count(size);
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? 12 : 0;  // ENOMEM
}
}
#endif
