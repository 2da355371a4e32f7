#ifndef FINRAY_CALIB_PROBLEM_RESIDUAL_FAMILY_H_
#define FINRAY_CALIB_PROBLEM_RESIDUAL_FAMILY_H_

#include <cstdint>

namespace finray {

/// What a residual measures, for statistics.
enum class ResidualFamily : std::int8_t {
  kGauge,
  kForce,
  kObject,
  kContact,
  kPin,
  kTip,
  kBench
};
constexpr int kResidualFamilies = 7;

/// E.g. "gauge".
constexpr const char* ResidualFamilyName(ResidualFamily family) {
  constexpr const char* kNames[] = {"gauge", "force", "object", "contact",
                                    "pin",   "tip",   "bench"};
  return kNames[static_cast<int>(family)];
}

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_RESIDUAL_FAMILY_H_
