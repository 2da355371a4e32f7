#ifndef FINRAY_FINGER_MESH_H_
#define FINRAY_FINGER_MESH_H_

#include <vector>

#include "finray/finger/finger.h"

namespace finray {

/// The place of a point of a beam in its mesh.
struct MeshPoint {
  int element;
  double offset_mm;  ///< from the start of the element.
};

/// The elements of one beam. Every rib hinge and every end of a stiffness piece
/// is a node. A contact is not, so the mesh does not move with it.
struct BeamMesh {
  std::vector<double> nodes_mm;  ///< Element boundaries, base (0) to tip.
  std::vector<int> rib_node;     ///< Index into nodes_mm of each rib's hinge.
  std::vector<double> stiffness_ratio;  ///< EI of each element over the beam's.
  /// The nodes that bound bays: base, hinges, piece ends and tip, in order.
  std::vector<int> bay_node;

  int elements() const { return static_cast<int>(nodes_mm.size()) - 1; }
  /// The element that holds an arc length. A node belongs to the element that
  /// starts there, the tip to the last one.
  MeshPoint Locate(double arc_mm) const;
};

/// Divides one beam into bays at its ribs and stiffness pieces, and each bay
/// into equal elements, at least one. Both beams together have about
/// `resolution` elements.
BeamMesh MakeBeamMesh(const Finger& finger, Side side, int resolution);

/// The mesh with given nodes, which must include those of the ribs and pieces.
BeamMesh MakeBeamMesh(const Finger& finger, Side side,
                      std::vector<double> nodes_mm);

/// Moves the nodes of a mesh of the same ribs and pieces to the finger's hinges
/// and tip. Inner nodes keep their shares of their bays. False, and the mesh
/// stays, if a hinge would leave its place between piece ends and other hinges.
bool MoveNodes(const Finger& finger, Side side, BeamMesh* mesh);

}  // namespace finray

#endif  // FINRAY_FINGER_MESH_H_
