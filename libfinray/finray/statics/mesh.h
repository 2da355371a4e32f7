#ifndef FINRAY_STATICS_MESH_H_
#define FINRAY_STATICS_MESH_H_

#include <vector>

#include "finray/finger/finger.h"
#include "finray/statics/discretization.h"

namespace finray {

/// Where a point of a beam lies in its mesh.
struct MeshPoint {
  int element;
  double offset_mm;  ///< from the start of the element.
};

/// The elements of one beam. Every rib hinge is a node; nothing else is, so
/// that the mesh does not move with a contact.
struct BeamMesh {
  std::vector<double> nodes_mm;  ///< element boundaries, base (0) to tip.
  std::vector<int> rib_node;     ///< index into nodes_mm of each rib's hinge.

  int elements() const { return static_cast<int>(nodes_mm.size()) - 1; }
  /// The element that holds an arc length; its end only at the tip.
  MeshPoint Locate(double arc_mm) const;
};

/// Divides one beam into bays at the ribs and each bay into equal elements.
BeamMesh MakeBeamMesh(const Finger& finger, Side side,
                      const Discretization& discretization);

}  // namespace finray

#endif  // FINRAY_STATICS_MESH_H_
