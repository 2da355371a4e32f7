#ifndef FINRAY_FINGER_FINGER_H_
#define FINRAY_FINGER_FINGER_H_

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "finray/finger/parameter_covariance.h"

namespace finray {

/// The two flexible beams of a finger. The front beam touches the object.
enum class Side { kFront, kBack };

inline const char* SideName(Side side) {
  return side == Side::kFront ? "front" : "back";
}

/// A rigid (or axially elastic) rib hinged to both beams.
struct Rib {
  double front_mm =
      0;  ///< Hinge on the front beam, arc length from its base (l_i).
  double back_mm = 0;  ///< Hinge on the back beam, arc length from its base.
  double length_mm =
      0;  ///< Unloaded length; other than nominal means prestress.
  double axial_stiffness_N = std::numeric_limits<double>::infinity();  ///< EA.
};

/// A strain gauge that reads the bending angle of a piece of a beam:
/// V = gain * ([theta(start + length) - theta(start)] - undeformed) + offset.
struct Gauge {
  Side beam = Side::kBack;
  double start_mm = 0;   ///< p_j, arc length from the base of its beam.
  double length_mm = 0;  ///< w_j.
  double gain_V_per_rad = 1;
  double offset_V = 0;
  double noise_V = 3e-4;  ///< Standard deviation of one reading.
  /// What the electronics can tell: a reading at or beyond either is saturated,
  /// and no measurement.
  double min_V = -std::numeric_limits<double>::infinity();
  double max_V = std::numeric_limits<double>::infinity();
};

/// Whether a reading says anything: it is there and not saturated.
inline bool IsMeasured(const Gauge& gauge, double reading_V) {
  return reading_V > gauge.min_V && reading_V < gauge.max_V;
}

/// A piece of a beam whose bending stiffness is not the beam's.
struct StiffnessPiece {
  double end_mm;           ///< It reaches from the last piece's end to here.
  double stiffness_ratio;  ///< Its EI over the beam's.
};

/// A Fin-Ray finger (the paper's Fig. 3 and Table I): two straight beams that
/// start clamped at their bases and meet in a rigid tip cap, and the ribs
/// between them, in the order they are met from base to tip on both beams.
struct Finger {
  std::string name;
  double front_length_mm = 0;  ///< l_0.
  double back_angle_rad = 0;   ///< phi_0, direction of the back beam from +x.
  double front_stiffness_N_mm2 = 0;  ///< Bending stiffness EI.
  double back_stiffness_N_mm2 = 0;
  /// Axial stiffness EA; infinite: the beam does not stretch.
  double front_axial_stiffness_N = std::numeric_limits<double>::infinity();
  double back_axial_stiffness_N = std::numeric_limits<double>::infinity();
  /// Base to tip, the last one ending at the tip; empty: uniform stiffness.
  std::vector<StiffnessPiece> front_pieces, back_pieces;
  std::vector<Rib> ribs;
  std::vector<Gauge> gauges;
  /// How well these numbers are known, if a calibration has told.
  std::optional<ParameterCovariance> calibration;
};

}  // namespace finray

#endif  // FINRAY_FINGER_FINGER_H_
