#ifndef FINRAY_FINGER_MESH_H_
#define FINRAY_FINGER_MESH_H_

#include <vector>

#include "finray/finger/finger.h"

namespace finray {

/// Where a point of a beam lies in its mesh.
struct MeshPoint {
  int element;
  double offset_mm;  ///< from the start of the element.
};

/// The elements of one beam. Every rib hinge and every end of a stiffness piece
/// is a node; nothing else is, so that the mesh does not move with a contact.
struct BeamMesh {
  std::vector<double> nodes_mm;  ///< element boundaries, base (0) to tip.
  std::vector<int> rib_node;     ///< index into nodes_mm of each rib's hinge.
  std::vector<double> stiffness_ratio;  ///< EI of each element over the beam's.

  int elements() const { return static_cast<int>(nodes_mm.size()) - 1; }
  /// The element that holds an arc length; its end only at the tip.
  MeshPoint Locate(double arc_mm) const;
};

/// Divides one beam into bays at its ribs and stiffness pieces and each bay
/// into equal elements, `resolution` over both beams together; no bay has less
/// than one.
BeamMesh MakeBeamMesh(const Finger& finger, Side side, int resolution);

}  // namespace finray

#endif  // FINRAY_FINGER_MESH_H_
