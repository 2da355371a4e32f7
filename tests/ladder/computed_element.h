#ifndef FINRAY_TESTS_LADDER_COMPUTED_ELEMENT_H_
#define FINRAY_TESTS_LADDER_COMPUTED_ELEMENT_H_

#include "finray/ladder/element.h"

namespace finray {

/// Everything an element can tell, in one call.
template <class Element>
Element ComputedElement(const ElementStart& start, double stiffness,
                        double length, double axial_flexibility = 0) {
  Element element;
  element.SolveAndDifferentiate(start, stiffness, axial_flexibility, length);
  element.DifferentiateByStiffness();
  element.DifferentiateByLength();
  return element;
}

}  // namespace finray

#endif  // FINRAY_TESTS_LADDER_COMPUTED_ELEMENT_H_
