#ifndef FINRAY_SCENE_MEASUREMENTS_H_
#define FINRAY_SCENE_MEASUREMENTS_H_

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <vector>

#include "finray/finger/finger.h"
#include "finray/scene/measured_force.h"

namespace finray {

/// A rib's hinge on one of the beams, seen by a camera.
struct SeenPin {
  int rib;
  Side side;
  Eigen::Vector2d at_mm;
};

/// One row of a log: every measurement, NaN where nothing was measured.
/// Positions are in frame S. MeasurementModel (residuals/frame_blocks.h) says
/// which measurements count and with which std.
struct Measurements {
  static constexpr double kNotMeasured =
      std::numeric_limits<double>::quiet_NaN();

  std::vector<double> gauges_V;  ///< One per gauge of the finger, as read.
  /// Of how many readings the gauges and the force of the row are means; 1
  /// where the log does not say. A mean has 1 / sqrt(n) of a reading's noise.
  double gauge_readings = 1, force_readings = 1;
  /// What the rows before leave unknown of each reading beside its noise
  /// (HistoryFilter). Empty: nothing.
  std::vector<double> history_std_V;
  double time_s = kNotMeasured;
  /// Reference sensor: one axis or two. Force() says what they mean.
  double force_N = kNotMeasured;
  Eigen::Vector2d force_xy_N{kNotMeasured, kNotMeasured};
  /// Origin and turn of the object's own frame, measured by a stage or a
  /// camera.
  Eigen::Vector2d object_mm{kNotMeasured, kNotMeasured};
  double object_angle_rad = 0;
  /// Tangential over normal force of the contact, where the object's motion
  /// tells it (SlidingFriction); else the scene's coefficient counts.
  double friction = kNotMeasured;
  double contact_mm = kNotMeasured;  ///< l_c
  double temperature_C = kNotMeasured;
  std::vector<SeenPin> pins;
  Eigen::Vector2d tip_mm{kNotMeasured, kNotMeasured};
  /// Radius of the cylinder around which the gauges were bent on a test bench,
  /// without the finger.
  double cylinder_radius_mm = kNotMeasured;

  /// The std of a mean of so many readings with this noise.
  static double MeanStd(double noise, double readings) {
    return readings == 1 ? noise : noise / std::sqrt(readings);
  }
  /// The std of a gauge's value in this row; `noise_V` is that of one reading.
  double GaugeStd_V(std::size_t gauge, double noise_V) const {
    const double mean_V = MeanStd(noise_V, gauge_readings);
    return history_std_V.empty() ? mean_V
                                 : std::hypot(mean_V, history_std_V[gauge]);
  }
  MeasuredForce Force() const { return MeasuredForce::Of(force_N, force_xy_N); }
  double FrictionOr(double coefficient) const {
    return std::isnan(friction) ? coefficient : friction;
  }
  bool IsBench() const { return !std::isnan(cylinder_radius_mm); }
};

}  // namespace finray

#endif  // FINRAY_SCENE_MEASUREMENTS_H_
