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
  const auto& pieces = Pieces(finger, side);

  BeamMesh mesh;
  mesh.nodes_mm.push_back(0);
  std::size_t piece = 0;
  const auto add_bay = [&](double end) {
    const double start = mesh.nodes_mm.back();
    // A hair of slack keeps a bay that is a whole number of elements so.
    const int count = std::max(
        1, static_cast<int>(std::ceil((end - start) / longest - 1e-9)));
    for (int k = 1; k < count; ++k) {
      mesh.nodes_mm.push_back(start + (end - start) * k / count);
    }
    mesh.nodes_mm.push_back(end);
    mesh.stiffness_ratio.resize(
        mesh.nodes_mm.size() - 1,
        piece < pieces.size() ? pieces[piece].stiffness_ratio : 1.0);
  };
  const auto add_to = [&](double end) {
    for (; piece + 1 < pieces.size() && pieces[piece].end_mm <= end; ++piece) {
      if (pieces[piece].end_mm > mesh.nodes_mm.back()) {
        add_bay(pieces[piece].end_mm);
      }
    }
    if (end > mesh.nodes_mm.back()) add_bay(end);
  };
  for (const Rib& rib : finger.ribs) {
    add_to(side == Side::kFront ? rib.front_mm : rib.back_mm);
    mesh.rib_node.push_back(mesh.elements());
  }
  add_to(BeamLength(finger, side));
  return mesh;
}

}  // namespace finray
