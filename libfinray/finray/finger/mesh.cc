#include "finray/finger/mesh.h"

#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"

namespace finray {

MeshPoint BeamMesh::Locate(double arc_mm) const {
  const auto after = std::upper_bound(nodes_mm.begin(), nodes_mm.end(), arc_mm);
  const int element = std::clamp(static_cast<int>(after - nodes_mm.begin()) - 1,
                                 0, elements() - 1);
  return {element, arc_mm - nodes_mm[element]};
}

BeamMesh MakeBeamMesh(const Finger& finger, Side side, int resolution) {
  const double longest =
      (BeamLength(finger, Side::kFront) + BeamLength(finger, Side::kBack)) /
      resolution;
  std::vector<double> ends;
  for (const Rib& rib : finger.ribs) {
    ends.push_back(side == Side::kFront ? rib.front_mm : rib.back_mm);
  }
  for (const StiffnessPiece& piece : Pieces(finger, side)) {
    ends.push_back(piece.end_mm);
  }
  // The last piece ends at the tip, up to rounding.
  if (!Pieces(finger, side).empty()) ends.pop_back();
  ends.push_back(BeamLength(finger, side));
  std::sort(ends.begin(), ends.end());

  std::vector<double> nodes_mm = {0};
  for (const double end : ends) {
    const double start = nodes_mm.back();
    if (!(end > start)) continue;
    // A little slack, so that rounding adds no element to a bay that is a whole
    // number of elements long.
    const int count = std::max(
        1, static_cast<int>(std::ceil((end - start) / longest - 1e-9)));
    for (int k = 1; k < count; ++k) {
      nodes_mm.push_back(start + (end - start) * k / count);
    }
    nodes_mm.push_back(end);
  }
  return MakeBeamMesh(finger, side, std::move(nodes_mm));
}

BeamMesh MakeBeamMesh(const Finger& finger, Side side,
                      std::vector<double> nodes_mm) {
  BeamMesh mesh;
  mesh.nodes_mm = std::move(nodes_mm);
  const std::vector<double>& nodes = mesh.nodes_mm;
  for (const Rib& rib : finger.ribs) {
    const double hinge = side == Side::kFront ? rib.front_mm : rib.back_mm;
    const auto at = std::lower_bound(nodes.begin(), nodes.end(), hinge);
    mesh.rib_node.push_back(static_cast<int>(at - nodes.begin()));
  }
  const std::vector<StiffnessPiece>& pieces = Pieces(finger, side);
  std::size_t piece = 0;
  for (int k = 0; k < mesh.elements(); ++k) {
    while (piece + 1 < pieces.size() && pieces[piece].end_mm <= nodes[k]) {
      ++piece;
    }
    mesh.stiffness_ratio.push_back(
        pieces.empty() ? 1.0 : pieces[piece].stiffness_ratio);
  }
  return mesh;
}

}  // namespace finray
