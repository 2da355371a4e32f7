#ifndef FINRAY_STATICS_DISCRETIZATION_H_
#define FINRAY_STATICS_DISCRETIZATION_H_

#include <string>
#include <vector>

namespace finray {

/// How the beam equation is integrated (docs/statics.md has the measured
/// trade).
enum class Scheme {
  kRigidChain,  ///< The paper's rigid links, order 2 (RigidLinkElement).
  kTaylor,      ///< Taylor series of order 16 (TaylorElement).
};

/// Scheme and number of elements over both beams together; no bay has less than
/// one element. A resolution of 0 stands for the scheme's default.
struct Discretization {
  Scheme scheme = Scheme::kTaylor;
  int resolution = 0;
};

/// The number of elements that a discretization asks for: its resolution, or
/// the scheme's default (24 for taylor, 200 for rigid_chain).
int EffectiveResolution(const Discretization& discretization);

/// "rigid_chain", "taylor": the values of --scheme.
const std::vector<std::string>& SchemeNames();
std::string SchemeName(Scheme scheme);

/// From the values of --scheme and --resolution. Throws InputError naming the
/// nearest scheme, or for a resolution below 0 or above 100 000.
Discretization ParseDiscretization(const std::string& scheme, int resolution);

}  // namespace finray

#endif  // FINRAY_STATICS_DISCRETIZATION_H_
