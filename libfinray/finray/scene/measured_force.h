#ifndef FINRAY_SCENE_MEASURED_FORCE_H_
#define FINRAY_SCENE_MEASURED_FORCE_H_

#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace finray {

/// What the reference sensor read of the force on the finger in one row. Every
/// tool takes the force of a row, and whether it is zero, from here.
///
/// A sensor of one axis reads the force along its axis, which noise may make
/// slightly negative. Of two axes the magnitude is the length of the vector.
/// The noise of an axis is also the noise of the magnitude of a force well
/// above it.
struct MeasuredForce {
  double magnitude_N = std::numeric_limits<double>::quiet_NaN();
  int axes = 0;  ///< 0: not measured, 1 or 2.

  /// `force_N` is along one axis, `xy_N` on two; NaN where not measured. If
  /// both are there, the two axes count.
  static MeasuredForce Of(double force_N, const Eigen::Vector2d& xy_N) {
    if (xy_N.allFinite()) return {xy_N.norm(), 2};
    if (std::isfinite(force_N)) return {force_N, 1};
    return {};
  }

  bool IsMeasured() const { return axes > 0; }
  /// Returns true if noise of this std on each axis may read so without any
  /// force. The chance that noise reads more is that of one axis beyond
  /// kNoiseStd, p = 0.27 %, with two axes too:
  ///
  ///   (F / std)^2 <= chi2_axes(1 - p);  chi2_1 = 3^2, chi2_2 = -2 ln p.
  bool IsWithinNoise(double std_N) const {
    const double most = axes == 2 ? kNoiseChi2OfTwoAxes : kNoiseStd * kNoiseStd;
    return magnitude_N * magnitude_N <= most * std_N * std_N;
  }
  static constexpr double kNoiseStd = 3;
  static constexpr double kNoiseChi2OfTwoAxes = 11.829158081900795;
};

}  // namespace finray

#endif  // FINRAY_SCENE_MEASURED_FORCE_H_
