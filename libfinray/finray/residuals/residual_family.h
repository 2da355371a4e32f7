#ifndef FINRAY_RESIDUALS_RESIDUAL_FAMILY_H_
#define FINRAY_RESIDUALS_RESIDUAL_FAMILY_H_

#include <cstdint>

namespace finray {

/// The kind of measurement behind a residual, for statistics.
enum class ResidualFamily : std::int8_t {
  kGauge,
  kForce,
  kObject,
  kContact,
  kPin,
  kTip,
  kBench,
  kEquilibrium,  ///< Equilibrium in the weighted form; no measurement.
};
/// Number of families that are measurements.
constexpr int kResidualFamilies = 7;

/// Returns the family's name, e.g. "gauge".
constexpr const char* ResidualFamilyName(ResidualFamily family) {
  constexpr const char* kNames[] = {"gauge", "force", "object", "contact",
                                    "pin",   "tip",   "bench",  "equilibrium"};
  return kNames[static_cast<int>(family)];
}

}  // namespace finray

#endif  // FINRAY_RESIDUALS_RESIDUAL_FAMILY_H_
