#include "finray/statics/shape.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "finray/io/nan.h"
#include "finray/ladder/scheme_element.h"

namespace finray {

Shape::Shape(const EquilibriumSolver& solver,
             const std::vector<PointContact>& contacts, int sides) {
  if (solver.status() != SolveStatus::kSolved) {
    throw std::logic_error("the shape of a finger without equilibrium");
  }
  const Finger& finger = solver.model().finger();
  lift_mm_ = {finger.front_surface_mm, -finger.back_surface_mm};
  const auto spans = solver.Spans(contacts);
  for (int side = 0; side < sides; ++side) {
    pieces_[side].reserve(spans[side].size());
    for (const BeamSpan& span : spans[side]) {
      VisitElement(solver.scheme(), [&](auto element) {
        using Element = decltype(element);
        element.Solve(span.start, span.stiffness_N_mm2,
                      span.axial_flexibility_per_N, span.length_mm);
        double coefficients[Element::kDegree + 1][4];
        element.DenseOutput(coefficients);
        coefficients[0][0] = span.x_mm;
        coefficients[0][1] = span.y_mm;
        degree_ = Element::kDegree;
        pieces_[side].push_back({span.arc_mm, span.start.force_x_N,
                                 span.start.force_y_N, coefficients_.size()});
        coefficients_.insert(coefficients_.end(), std::begin(coefficients[0]),
                             std::end(coefficients[Element::kDegree]));
      });
    }
  }
}

Section Shape::At(Side side, double arc_mm) const {
  const auto& pieces = pieces_[LadderModel::Index(side)];
  if (pieces.empty()) return {kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};
  auto after = std::upper_bound(
      pieces.begin(), pieces.end(), arc_mm,
      [](double arc, const Piece& piece) { return arc < piece.arc_mm; });
  if (after != pieces.begin()) --after;
  const double offset = arc_mm - after->arc_mm;
  const double* first = coefficients_.data() + after->first_coefficient;
  double value[4] = {0, 0, 0, 0};
  for (int i = degree_; i >= 0; --i) {
    for (int k = 0; k < 4; ++k) value[k] = value[k] * offset + first[4 * i + k];
  }
  return {value[0], value[1],         value[2],
          value[3], after->force_x_N, after->force_y_N};
}

Section Shape::SurfaceAt(Side side, double arc_mm) const {
  Section at = At(side, arc_mm);
  const double lift = lift_mm_[LadderModel::Index(side)];
  if (lift == 0) return at;
  at.x_mm -= lift * std::sin(at.theta_rad);
  at.y_mm += lift * std::cos(at.theta_rad);
  return at;
}

}  // namespace finray
