#ifndef FINRAY_STATICS_SCHEME_ELEMENT_H_
#define FINRAY_STATICS_SCHEME_ELEMENT_H_

#include "finray/statics/discretization.h"
#include "finray/statics/rigid_link_element.h"
#include "finray/statics/taylor_element.h"

namespace finray {

/// Calls `visitor` with an element of the scheme's class. It allows for
/// stretching, which costs more: this is for drawing, not for solving.
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

#endif  // FINRAY_STATICS_SCHEME_ELEMENT_H_
