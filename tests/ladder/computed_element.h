#ifndef FINRAY_TESTS_LADDER_COMPUTED_ELEMENT_H_
#define FINRAY_TESTS_LADDER_COMPUTED_ELEMENT_H_

#include <array>

#include "finray/ladder/element.h"

namespace finray {

/// An element with all derivatives.
template <class Element>
Element ComputedElement(const ElementStart& start, double stiffness,
                        double length, double axial_flexibility = 0) {
  Element element;
  element.SolveAndDifferentiate(start, stiffness, axial_flexibility, length);
  element.DifferentiateByStiffness();
  element.DifferentiateByLength();
  return element;
}

/// (x, y, theta, M) at an offset from the start of an element, by its dense
/// output.
template <class Element>
std::array<double, 4> PointOf(const Element& element, double offset) {
  double series[Element::kDegree + 1][4];
  element.DenseOutput(series);
  std::array<double, 4> at = {};
  for (int i = Element::kDegree; i >= 0; --i) {
    for (int k = 0; k < 4; ++k) at[k] = at[k] * offset + series[i][k];
  }
  return at;
}

}  // namespace finray

#endif  // FINRAY_TESTS_LADDER_COMPUTED_ELEMENT_H_
