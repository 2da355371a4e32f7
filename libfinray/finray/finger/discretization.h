#ifndef FINRAY_FINGER_DISCRETIZATION_H_
#define FINRAY_FINGER_DISCRETIZATION_H_

#include <string>
#include <vector>

namespace finray {

/// How the beam equation is integrated. docs/evidence/statics_accuracy.md has
/// the measured trade between accuracy and time.
enum class Scheme {
  kRigidChain,  ///< The paper's rigid links, order 2 (RigidLinkElement).
  kTaylor4,     ///< Taylor series of order 4 (TaylorElement).
  kTaylor8,     ///< ... of order 8.
  kTaylor12,    ///< ... of order 12.
  kTaylor,      ///< ... of order 16, the default.
};

/// The scheme and the number of elements over both beams together; every bay
/// has at least one. A resolution of 0 means the scheme's default. With orders
/// 12 and 16 the default mesh is refined under load until an element's series
/// leaves out less than kRefinedTruncation_rad.
struct Discretization {
  Scheme scheme = Scheme::kTaylor;
  int resolution = 0;

  bool adaptive() const {
    return resolution == 0 &&
           (scheme == Scheme::kTaylor12 || scheme == Scheme::kTaylor);
  }
};

constexpr double kRefinedTruncation_rad = 1e-10;

/// The number of elements that a discretization starts with: its resolution or
/// the scheme's default.
int EffectiveResolution(const Discretization& discretization);

/// The values of --scheme: "rigid_chain", "taylor" and so on.
const std::vector<std::string>& SchemeNames();
std::string SchemeName(Scheme scheme);

/// Reads the values of --scheme and --resolution. Throws InputError for an
/// unknown scheme, with the nearest one, and for a resolution below 0 or above
/// 2000.
Discretization ParseDiscretization(const std::string& scheme, int resolution);

}  // namespace finray

#endif  // FINRAY_FINGER_DISCRETIZATION_H_
