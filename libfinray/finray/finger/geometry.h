#ifndef FINRAY_FINGER_GEOMETRY_H_
#define FINRAY_FINGER_GEOMETRY_H_

#include <Eigen/Core>
#include <cmath>

#include "finray/finger/finger.h"

namespace finray {

/// A degree in rad.
inline constexpr double kDegree = M_PI / 180;

// The undeformed geometry in frame S: origin at the base of the front beam, +y
// along it, +x towards the back beam. Lengths in mm, angles in rad from +x.

/// The arc length of a beam from base to tip: l_0 in front, l_0 / sin(phi_0)
/// behind.
double BeamLength(const Finger& finger, Side side);

/// The base of a beam: (0, 0) in front, (-l_0 / tan(phi_0), 0) behind.
Eigen::Vector2d BeamBase(const Finger& finger, Side side);

/// The tangent angle of the undeformed beam: pi/2 in front, phi_0 behind.
double BeamAngle(const Finger& finger, Side side);

/// The point of the undeformed beam at an arc length from its base.
Eigen::Vector2d UndeformedPoint(const Finger& finger, Side side, double arc_mm);

/// EI, EA, pieces, clamp and surface of one beam of a Finger.
double BendingStiffness(const Finger& finger, Side side);
/// The bending stiffness there; at the end of a piece, that of the next one.
double BendingStiffness(const Finger& finger, Side side, double arc_mm);
double AxialStiffness(const Finger& finger, Side side);
double ClampCompliance(const Finger& finger, Side side);
double SurfaceOffset(const Finger& finger, Side side);
/// Whether a beam of the finger stretches, that is has a finite EA.
bool Stretches(const Finger& finger);
const std::vector<StiffnessPiece>& Pieces(const Finger& finger, Side side);

/// The arc length on the back beam where a rib meets it that leaves the
/// undeformed front beam at front_mm in the direction (cos, sin)(angle). It is
/// measured on the straight line of the beam and may lie outside the beam. NaN
/// if the rib runs along that line or away from it.
double RibBackArc(const Finger& finger, double front_mm, double angle_rad);

/// The arc length of a rib's hinge on one beam.
double HingePlace(const Rib& rib, Side side);

/// The first rib that bends; null if none does.
const Rib* FirstBendingRib(const Finger& finger);

/// The distance of a rib's hinges in the undeformed finger, d_{k,0} of (7).
double NominalRibLength(const Finger& finger, const Rib& rib);

/// The natural unit of a finger's loads, sqrt(EI_front EI_back) / l_0^2 in N:
/// this force bends it by about its own length (0.64 N for the paper's finger).
double ForceUnit(const Finger& finger);

}  // namespace finray

#endif  // FINRAY_FINGER_GEOMETRY_H_
