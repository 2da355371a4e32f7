#ifndef FINRAY_FINGER_FINGER_H_
#define FINRAY_FINGER_FINGER_H_

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "finray/finger/finger_parameter.h"

namespace finray {

/// The two flexible beams of a finger. The front beam touches the object.
enum class Side { kFront, kBack };

inline const char* SideName(Side side) {
  return side == Side::kFront ? "front" : "back";
}

/// A rib between both beams, rigid or axially elastic, on hinges or bending.
/// Hinges are given by arc length from the base of their beam. A length other
/// than the distance of the hinges in the undeformed finger means prestress.
struct Rib {
  double front_mm = 0;   ///< Hinge on the front beam, l_i.
  double back_mm = 0;    ///< Hinge on the back beam.
  double length_mm = 0;  ///< Unloaded length.
  double axial_stiffness_N = std::numeric_limits<double>::infinity();  ///< EA.
  /// Springs between beam and rib, k_F and k_B. Each turns with the beam
  /// against the rib, a = (theta - theta_0) - (phi - phi_0), and is at rest in
  /// the undeformed finger. Its moment k a acts on the rib, -k a on the beam.
  /// In a rib that bends they are in series with it, and an infinite one clamps
  /// the rib to the beam.
  double front_hinge_N_mm_per_rad = 0, back_hinge_N_mm_per_rad = 0;
  /// EI. A rib with an infinite one does not bend (ladder/rib_law.h).
  double bending_stiffness_N_mm2 = std::numeric_limits<double>::infinity();
  /// So much of a bending rib's length at either end does not bend.
  double front_rigid_mm = 0, back_rigid_mm = 0;

  bool Bends() const { return std::isfinite(bending_stiffness_N_mm2); }
  /// Says that the rib's ends carry moments.
  bool HasMoments() const {
    return Bends() || front_hinge_N_mm_per_rad != 0 ||
           back_hinge_N_mm_per_rad != 0;
  }
};

/// A strain gauge. It reads the bending angle of the piece of beam that it
/// covers, less that of the undeformed finger:
///   V = gain * (angle + curvature * angle^2) + offset,
///   angle = [theta(start + length) - theta(start)] - undeformed.
/// A gauge that is less sensitive when flat, whichever way it bends, has a
/// signal less than its angle,
///   V = gain * (s + curvature * angle^2) + offset,
///   s = angle - share * angle / sqrt(1 + (angle / width)^2),
/// so that the slope is 1 - share at 0 and 1 far beyond the width. A gauge that
/// creeps reads V + share * z after a while (GaugeLag, finger/gauge_lag.h), and
/// one with hysteresis follows V at a distance of up to |gain| hysteresis
/// (Play, finger/gauge_play.h); all functions below are without both.
struct Gauge {
  Side beam = Side::kBack;
  double start_mm = 0;   ///< p_j, arc length from the base of its beam.
  double length_mm = 0;  ///< w_j.
  double gain_V_per_rad = 1;
  double offset_V = 0;
  double noise_V = 3e-4;         ///< Standard deviation of one reading.
  double curvature_per_rad = 0;  ///< 0: the gauge is linear.
  double creep_share = 0;        ///< 0: the gauge does not creep.
  double creep_time_constant_s = 30;
  double flat_share = 0;  ///< 0: as sensitive when flat as when bent.
  double flat_width_rad = 0.03;
  double hysteresis_rad = 0;  ///< Half the width of the loop; 0: none.
  /// The range of the electronics: a reading at or beyond either limit is
  /// saturated.
  double min_V = -std::numeric_limits<double>::infinity();
  double max_V = std::numeric_limits<double>::infinity();

  double Volts(double angle_rad) const {
    return BendingVolts(angle_rad) + offset_V;
  }
  /// Volts without the offset.
  double BendingVolts(double angle_rad) const {
    return gain_V_per_rad * Signal(angle_rad);
  }
  /// BendingVolts over the gain.
  double Signal(double angle_rad) const {
    const double curved = angle_rad * (1 + curvature_per_rad * angle_rad);
    if (flat_share == 0) return curved;
    return curved - flat_share * angle_rad / FlatRoot(angle_rad);
  }
  /// d Signal / d flat_share, and by flat_width_rad.
  double SignalByFlatShare(double angle_rad) const {
    return -angle_rad / FlatRoot(angle_rad);
  }
  double SignalByFlatWidth(double angle_rad) const {
    return -flat_share * std::pow(angle_rad / FlatRoot(angle_rad), 3) /
           std::pow(flat_width_rad, 3);
  }
  /// Says that V is not linear in the angle.
  bool IsCurved() const { return curvature_per_rad != 0 || flat_share != 0; }
  /// Half the width of the loop in volts.
  double HysteresisV() const {
    return std::abs(gain_V_per_rad) * hysteresis_rad;
  }
  /// dV/dangle, V per rad.
  double Slope(double angle_rad) const {
    double slope = 1 + 2 * curvature_per_rad * angle_rad;
    if (flat_share != 0) {
      slope -= flat_share * std::pow(FlatRoot(angle_rad), -3);
    }
    return gain_V_per_rad * slope;
  }
  /// The inverse of Volts on the branch through angle 0, where the slope has
  /// the sign of the gain. NaN if `volts` is NaN or beyond the vertex of the
  /// curve.
  double Angle(double volts) const {
    const double linear = (volts - offset_V) / gain_V_per_rad;
    if (flat_share != 0) return FlatAngle(linear);
    return Unbend(linear);
  }
  /// 1 / standard deviation of the angle of one reading there, per rad.
  double AngleWeight(double angle_rad = 0) const {
    return std::abs(Slope(angle_rad)) / noise_V;
  }
  /// False for a missing (NaN) and for a saturated reading.
  bool IsInRange(double volts) const { return volts > min_V && volts < max_V; }
  /// False for a reading that tells no angle: missing, saturated, or beyond the
  /// vertex of the curve.
  bool IsMeasured(double volts) const {
    return IsInRange(volts) && (!IsCurved() || std::isfinite(Angle(volts)));
  }

 private:
  double FlatRoot(double angle_rad) const {
    return std::hypot(1, angle_rad / flat_width_rad);
  }
  // The angle of a signal if the gauge were as sensitive when flat.
  double Unbend(double signal) const {
    if (curvature_per_rad == 0) return signal;
    return 2 * signal / (1 + std::sqrt(1 + 4 * curvature_per_rad * signal));
  }
  double FlatAngle(double signal) const;
};

/// A piece of a beam with its own bending stiffness.
struct StiffnessPiece {
  double end_mm;  ///< The piece reaches from the end of the last one here.
  double stiffness_ratio;  ///< Its EI over the beam's.
};

/// Start here: a Fin-Ray finger (the paper's Fig. 3 and Table I). Two straight
/// beams are clamped at their bases and meet in a rigid tip cap. Ribs join
/// them, listed from base to tip, in the same order on both beams.
struct Finger {
  std::string name;
  double front_length_mm = 0;  ///< l_0.
  double back_angle_rad = 0;   ///< phi_0, direction of the back beam from +x.
  double front_stiffness_N_mm2 = 0;  ///< Bending stiffness EI.
  double back_stiffness_N_mm2 = 0;
  /// Axial stiffness EA. A beam with an infinite one does not stretch.
  double front_axial_stiffness_N = std::numeric_limits<double>::infinity();
  double back_axial_stiffness_N = std::numeric_limits<double>::infinity();
  /// From base to tip; the last piece ends at the tip. None means uniform
  /// stiffness.
  std::vector<StiffnessPiece> front_pieces, back_pieces;
  /// A clamp turns by its compliance times the moment of the beam's base,
  /// theta(0) = theta_0 + compliance M(0). 0: it is rigid.
  double front_clamp_rad_per_N_mm = 0, back_clamp_rad_per_N_mm = 0;
  /// How far the outer surface lies in front of the line that the beam's
  /// equations describe. Contacts act on the surface.
  double front_surface_mm = 0, back_surface_mm = 0;
  std::vector<Rib> ribs;
  std::vector<Gauge> gauges;
  /// How well a calibration knows these numbers, if there was one.
  std::optional<ParameterCovariance> calibration;
};

/// Says that a gauge is less or more sensitive when flat, or that the
/// calibration says how well it is known that it is not.
bool HasFlatGauges(const Finger& finger);

}  // namespace finray

#endif  // FINRAY_FINGER_FINGER_H_
