#ifndef FINRAY_TESTS_FUZZ_FUZZ_H_
#define FINRAY_TESTS_FUZZ_FUZZ_H_

#include <cstdint>

#include "fuzz/targets.h"

/// What libFuzzer calls with what it makes up.
#define FINRAY_FUZZ_TARGET(run)                                       \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,     \
                                        std::size_t size) {           \
    run(std::string_view(reinterpret_cast<const char*>(data), size)); \
    return 0;                                                         \
  }

#endif  // FINRAY_TESTS_FUZZ_FUZZ_H_
