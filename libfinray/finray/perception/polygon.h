#ifndef FINRAY_PERCEPTION_POLYGON_H_
#define FINRAY_PERCEPTION_POLYGON_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace finray {

/// A closed curve as the points along it; the last one joins the first.
using Polygon = std::vector<Eigen::Vector2d>;

/// a_x b_y - a_y b_x.
double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b);

/// Of the area, which is taken as above 0 for a counter-clockwise curve.
Eigen::Vector2d CentroidOf(const Polygon& polygon);
double AreaOf(const Polygon& polygon);

/// `count` points at equal arc lengths, from the first one on.
Polygon EvenlySpaced(const Polygon& polygon, int count);

/// Distance from `centre` to where the ray at an angle leaves the curve last;
/// nothing if it misses.
std::optional<double> RadiusAt(const Polygon& polygon,
                               const Eigen::Vector2d& centre, double angle_rad);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_POLYGON_H_
