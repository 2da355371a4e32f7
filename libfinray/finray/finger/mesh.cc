#include "finray/finger/mesh.h"

#include <algorithm>
#include <cmath>

#include "finray/finger/geometry.h"

namespace finray {
namespace {

std::vector<int> BayNodes(const Finger& finger, Side side,
                          const BeamMesh& mesh) {
  std::vector<int> bays = mesh.rib_node;
  const std::vector<double>& nodes = mesh.nodes_mm;
  const std::vector<StiffnessPiece>& pieces = Pieces(finger, side);
  for (std::size_t p = 0; p + 1 < pieces.size(); ++p) {
    const auto at =
        std::lower_bound(nodes.begin(), nodes.end(), pieces[p].end_mm);
    bays.push_back(static_cast<int>(at - nodes.begin()));
  }
  bays.push_back(0);
  bays.push_back(mesh.elements());
  std::sort(bays.begin(), bays.end());
  bays.erase(std::unique(bays.begin(), bays.end()), bays.end());
  return bays;
}

}  // namespace

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
    ends.push_back(HingePlace(rib, side));
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
    const auto at =
        std::lower_bound(nodes.begin(), nodes.end(), HingePlace(rib, side));
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
  mesh.bay_node = BayNodes(finger, side, mesh);
  return mesh;
}

bool MoveNodes(const Finger& finger, Side side, BeamMesh* mesh) {
  const std::vector<double>& old = mesh->nodes_mm;
  std::vector<double> nodes = old;
  std::size_t rib = 0;
  int from = 0;
  for (const int node : BayNodes(finger, side, *mesh)) {
    if (node == 0) continue;
    if (rib < finger.ribs.size() && mesh->rib_node[rib] == node) {
      nodes[node] = HingePlace(finger.ribs[rib++], side);
    } else if (node == mesh->elements()) {
      nodes[node] = BeamLength(finger, side);
    }
    // Written so that a NaN fails.
    if (!(nodes[node] > nodes[from])) return false;
    if (nodes[from] != old[from] || nodes[node] != old[node]) {
      const double scale =
          (nodes[node] - nodes[from]) / (old[node] - old[from]);
      for (int k = from + 1; k < node; ++k) {
        nodes[k] = nodes[from] + (old[k] - old[from]) * scale;
      }
    }
    from = node;
  }
  const std::vector<StiffnessPiece>& pieces = Pieces(finger, side);
  for (std::size_t p = 0; p + 1 < pieces.size(); ++p) {
    if (!std::binary_search(nodes.begin(), nodes.end(), pieces[p].end_mm)) {
      return false;
    }
  }
  *mesh = MakeBeamMesh(finger, side, std::move(nodes));
  return true;
}

}  // namespace finray
