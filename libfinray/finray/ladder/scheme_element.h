#ifndef FINRAY_LADDER_SCHEME_ELEMENT_H_
#define FINRAY_LADDER_SCHEME_ELEMENT_H_

#include "finray/finger/discretization.h"
#include "finray/ladder/rigid_link_element.h"
#include "finray/ladder/taylor_element.h"

namespace finray {

/// Calls `visitor` with an element of the scheme's class. The element allows
/// for stretching, which costs time: this is for drawing and for new meshes,
/// not for solving.
template <class Visitor>
auto VisitElement(Scheme scheme, Visitor&& visitor) {
  switch (scheme) {
    case Scheme::kRigidChain:
      return visitor(RigidLinkElement<double>());
    case Scheme::kTaylor4:
      return visitor(TaylorElement<4, double, true>());
    case Scheme::kTaylor8:
      return visitor(TaylorElement<8, double, true>());
    case Scheme::kTaylor12:
      return visitor(TaylorElement<12, double, true>());
    case Scheme::kTaylor:
      break;
  }
  return visitor(TaylorElement<16, double, true>());
}

}  // namespace finray

#endif  // FINRAY_LADDER_SCHEME_ELEMENT_H_
