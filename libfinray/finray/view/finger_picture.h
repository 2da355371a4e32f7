#ifndef FINRAY_VIEW_FINGER_PICTURE_H_
#define FINRAY_VIEW_FINGER_PICTURE_H_

#include <string>
#include <vector>

#include "finray/finger/point_contact.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// The points of a finger that a page draws: on each beam some evenly spaced
/// ones and the hinges of all ribs, from base to tip.
class PictureNodes {
 public:
  explicit PictureNodes(const Finger& finger);

  /// x and y in mm of all nodes in the solver's state after a solve: those of
  /// the front beam from base to tip, then those of the back beam.
  std::vector<double> Places(const EquilibriumSolver& solver,
                             const std::vector<PointContact>& contacts) const;
  /// The same for the undeformed finger.
  std::vector<double> Undeformed() const;
  std::size_t size() const { return arcs_mm_[0].size() + arcs_mm_[1].size(); }

  /// The finger as a JSON object: name, front and back (arc lengths of the
  /// nodes), ribs (pairs of nodes), gauges (beam, start, end), surface_mm,
  /// undeformed.
  std::string Json() const;

 private:
  Finger finger_;
  std::vector<double> arcs_mm_[2];
};

/// The deformed finger under one contact, on a grid of arc lengths, normal
/// forces and frictions, so that a page can draw any frame by interpolating
/// between the solutions around it.
struct ShapeTable {
  /// `frictions` has one value, or several that are evenly spaced.
  std::vector<double> arcs_mm, forces_N, frictions;
  /// By force, then by friction, then by arc length: the displacement of each
  /// node in mm, as PictureNodes::Places; NaN where the finger has no
  /// equilibrium.
  std::vector<std::vector<double>> moves_mm;
  /// The largest distance of an interpolated node from the solved one, over the
  /// middles of all cells.
  double largest_error_mm = 0;
};

/// Solves the finger under contacts up to `most_force_N`. Where the frictions
/// differ, the table has some between the least and the largest.
ShapeTable MakeShapeTable(const Finger& finger,
                          const Discretization& discretization,
                          const PictureNodes& nodes, double least_friction,
                          double most_friction, double most_force_N);

/// Displacements of nodes as base64 of 16-bit codes (PackCodes), with their
/// range: {low, high, codes}.
std::string MovesJson(const std::vector<std::vector<double>>& moves_mm);
std::string ShapeTableJson(const ShapeTable& table);

}  // namespace finray

#endif  // FINRAY_VIEW_FINGER_PICTURE_H_
