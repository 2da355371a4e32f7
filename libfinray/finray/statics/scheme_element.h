#ifndef FINRAY_STATICS_SCHEME_ELEMENT_H_
#define FINRAY_STATICS_SCHEME_ELEMENT_H_

#include "finray/statics/discretization.h"
#include "finray/statics/rigid_link_element.h"
#include "finray/statics/taylor_element.h"

namespace finray {

/// Calls `visitor` with an element of the scheme's class; the one place that
/// knows which class carries which scheme out.
template <class Visitor>
auto VisitElement(Scheme scheme, Visitor&& visitor) {
  if (scheme == Scheme::kRigidChain) return visitor(RigidLinkElement());
  return visitor(TaylorElement<16>());
}

}  // namespace finray

#endif  // FINRAY_STATICS_SCHEME_ELEMENT_H_
