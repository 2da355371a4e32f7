#ifndef FINRAY_PERCEPTION_POLYGON_H_
#define FINRAY_PERCEPTION_POLYGON_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace finray {

/// A closed curve given by points along it, in mm. The last point joins the
/// first.
using Polygon = std::vector<Eigen::Vector2d>;

/// The centroid of the enclosed area.
Eigen::Vector2d CentroidOf(const Polygon& polygon);

/// `count` points at equal arc lengths, starting at the first point.
Polygon EvenlySpaced(const Polygon& polygon, int count);

/// Where the segment from a to b crosses the line through the origin along the
/// unit vector `direction`: the position on that line, which may be negative.
/// Nothing if both ends are on one side of the line.
std::optional<double> Crossing(const Eigen::Vector2d& direction,
                               const Eigen::Vector2d& a,
                               const Eigen::Vector2d& b);

/// Distance from `centre` to the last point where the ray at an angle crosses
/// the curve; nothing if it does not.
std::optional<double> RadiusAt(const Polygon& polygon,
                               const Eigen::Vector2d& centre, double angle_rad);

/// Radial error of an outline in percent, 100 (r - r_true) / r_true, in polar
/// coordinates about the true outline's centroid, at equally spaced angles from
/// 0. The statistics are those of its magnitude.
struct RadialError {
  std::vector<double> percent;  ///< NaN where either outline has no radius

  double Mean() const;
  double Rms() const;
  double Quantile(double share) const;
  double Largest() const { return Quantile(1); }
};

RadialError CompareRadii(const Polygon& outline, const Polygon& truth,
                         int count = 360);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_POLYGON_H_
