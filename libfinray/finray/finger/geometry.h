#ifndef FINRAY_FINGER_GEOMETRY_H_
#define FINRAY_FINGER_GEOMETRY_H_

#include <Eigen/Core>
#include <cmath>

#include "finray/finger/finger.h"

namespace finray {

/// A degree in rad.
inline constexpr double kDegree = M_PI / 180;

// Undeformed geometry in frame S: origin at the base of the front beam, +y
// along it, +x towards the back beam. All lengths in mm, angles in rad from +x.

/// Arc length of a beam from base to tip: l_0 in front, l_0 / sin(phi_0)
/// behind.
double BeamLength(const Finger& finger, Side side);

/// Position of a beam's base: (0, 0) in front, (-l_0 / tan(phi_0), 0) behind.
Eigen::Vector2d BeamBase(const Finger& finger, Side side);

/// Tangent angle of the undeformed beam: pi/2 in front, phi_0 behind.
double BeamAngle(const Finger& finger, Side side);

/// Point of the undeformed beam at the given arc length from its base.
Eigen::Vector2d UndeformedPoint(const Finger& finger, Side side, double arc_mm);

/// What a beam is made of; see Finger.
double BendingStiffness(const Finger& finger, Side side);
double AxialStiffness(const Finger& finger, Side side);
const std::vector<StiffnessPiece>& Pieces(const Finger& finger, Side side);

/// Arc length at which a rib that leaves the undeformed front beam at front_mm
/// in direction (cos, sin)(angle) meets the straight line of the back beam;
/// NaN if it never does, as it runs along that line or away from it. The result
/// may lie outside the beam.
double RibBackArc(const Finger& finger, double front_mm, double angle_rad);

/// Distance of a rib's hinges in the undeformed finger (d_{k,0} of (7)).
double NominalRibLength(const Finger& finger, const Rib& rib);

/// The force that bends a finger by about its own length, sqrt(EI_front
/// EI_back) / l_0^2 in N: the natural unit of its loads (0.64 N for the
/// paper's).
double ForceUnit(const Finger& finger);

}  // namespace finray

#endif  // FINRAY_FINGER_GEOMETRY_H_
