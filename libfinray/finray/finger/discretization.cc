#include "finray/finger/discretization.h"

#include "finray/io/error.h"
#include "finray/io/message_text.h"

namespace finray {
namespace {

// Time is linear in the elements. With that many the rigid links are exact to
// 1e-4 of the angles, and the series are exact with a tenth of them.
constexpr int kMostElements = 2000;

}  // namespace

int EffectiveResolution(const Discretization& discretization) {
  constexpr int kDefaults[] = {200, 100, 48, 24, 12};  // by scheme
  return discretization.resolution > 0
             ? discretization.resolution
             : kDefaults[static_cast<int>(discretization.scheme)];
}

const std::vector<std::string>& SchemeNames() {
  static const std::vector<std::string> names = {
      "rigid_chain", "taylor4", "taylor8", "taylor12", "taylor"};
  return names;
}

std::string SchemeName(Scheme scheme) {
  return SchemeNames()[static_cast<int>(scheme)];
}

Discretization ParseDiscretization(const std::string& scheme, int resolution) {
  if (resolution < 0 || resolution > kMostElements) {
    throw InputError("--resolution: " + std::to_string(resolution) +
                     " is not a number of elements from 1 to " +
                     std::to_string(kMostElements) +
                     " (0: the scheme's default)");
  }
  for (std::size_t i = 0; i < SchemeNames().size(); ++i) {
    if (SchemeNames()[i] == scheme) {
      return {static_cast<Scheme>(i), resolution};
    }
  }
  throw InputError("--scheme: unknown scheme '" + scheme + "'" +
                   DidYouMean(scheme, SchemeNames()) +
                   "; known: " + Joined(SchemeNames(), " "));
}

}  // namespace finray
