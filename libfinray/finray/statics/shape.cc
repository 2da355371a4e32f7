#include "finray/statics/shape.h"

#include <algorithm>

#include "finray/statics/scheme_element.h"

namespace finray {

Shape::Shape(const EquilibriumSolver& solver,
             const std::vector<PointContact>& contacts)
    : scheme_(solver.scheme()), spans_(solver.Spans(contacts)) {}

Section Shape::At(Side side, double arc_mm) const {
  const auto& spans = spans_[LadderModel::Index(side)];
  auto after = std::upper_bound(
      spans.begin(), spans.end(), arc_mm,
      [](double arc, const BeamSpan& span) { return arc < span.arc_mm; });
  if (after != spans.begin()) --after;
  const BeamSpan& span = *after;
  const BeamPoint point = VisitElement(scheme_, [&](auto element) {
    element.Solve(span.start, span.stiffness_N_mm2,
                  span.axial_flexibility_per_N, span.length_mm);
    return element.PointAt(arc_mm - span.arc_mm);
  });
  return {span.x_mm + point.x_mm, span.y_mm + point.y_mm, point.theta_rad,
          point.moment_N_mm,      span.start.force_x_N,   span.start.force_y_N};
}

std::vector<double> Shape::Stations(Side side) const {
  const auto& spans = spans_[LadderModel::Index(side)];
  std::vector<double> stations;
  for (const BeamSpan& span : spans) stations.push_back(span.arc_mm);
  stations.push_back(spans.back().arc_mm + spans.back().length_mm);
  return stations;
}

}  // namespace finray
