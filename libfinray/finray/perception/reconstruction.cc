#include "finray/perception/reconstruction.h"

#include <algorithm>
#include <cmath>

#include "finray/perception/finger_variations.h"

namespace finray {
namespace {

using Eigen::Vector2d;

// The curve at equal arc lengths.
Polygon Sampled(const ConvexCurve& curve) {
  constexpr int kPoints = 2880;
  Polygon polygon;
  for (int i = 0; i < kPoints; ++i) {
    polygon.push_back(
        curve.At(curve.NormalAngleAt(curve.perimeter_mm() * i / kPoints)));
  }
  return polygon;
}

// The normal angle where a ray from inside leaves the curve. It is found by
// bisection, because the direction to a point turns with its arc length.
double NormalAngleOfRay(const ConvexCurve& curve, const Vector2d& centre,
                        double angle_rad) {
  const auto ahead = [&](double arc) {
    const Vector2d r = curve.At(curve.NormalAngleAt(arc)) - centre;
    return std::remainder(std::atan2(r.y(), r.x()) - angle_rad, 2 * M_PI);
  };
  // The bracket grows from the point whose normal has that angle.
  const double about = curve.ArcAt(angle_rad), turn = curve.perimeter_mm();
  double low = about, high = about;
  for (const double step : {0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3}) {
    if (ahead(low) > 0) low = about - step * turn;
    if (ahead(high) < 0) high = about + step * turn;
  }
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (ahead(middle) > 0 ? high : low) = middle;
  }
  return curve.NormalAngleAt(0.5 * (low + high));
}

// The distance from a point to the nearest beam along the outline's normal, at
// most kFarthest_mm.
double Clearance(const Vector2d& point, double normal_angle_rad,
                 const std::vector<Touch>& touches) {
  constexpr double kFarthest_mm = 10;
  const Vector2d normal(std::cos(normal_angle_rad), std::sin(normal_angle_rad));
  double least = kFarthest_mm;
  for (const Touch& touch : touches) {
    for (std::size_t i = 0; i + 1 < touch.beam_mm.size(); ++i) {
      const auto height = Crossing(normal, touch.beam_mm[i] - point,
                                   touch.beam_mm[i + 1] - point);
      if (height && *height > -1) {
        least = std::min(least, std::max(*height, 0.0));
      }
    }
  }
  return least;
}

// The variance of each radius from the finger's calibration.
Eigen::VectorXd CalibrationVariance(const FrameTable& table,
                                    const Finger& finger, const Scene& scene,
                                    const Discretization& discretization,
                                    const OutlineFitSettings& settings,
                                    const Reconstruction& found) {
  const auto points = static_cast<Eigen::Index>(found.outline.size());
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(points);
  for (const Finger& varied : FingerVariations(finger)) {
    const Touches touches = SenseTouches(table, varied, scene, discretization);
    if (touches.usable.size() < kLeastTouches) continue;
    const Polygon moved =
        Sampled(RefitOutline(touches.usable, found.fit, settings));
    for (Eigen::Index i = 0; i < points; ++i) {
      const OutlinePoint& point = found.outline[static_cast<std::size_t>(i)];
      const auto radius = RadiusAt(moved, found.centroid_mm, point.angle_rad);
      if (!radius) continue;
      variance[i] += (*radius - point.radius_mm) * (*radius - point.radius_mm);
    }
  }
  return variance;
}

}  // namespace

Polygon Reconstruction::polygon() const {
  Polygon polygon;
  for (const OutlinePoint& point : outline) {
    polygon.push_back(point.position_mm);
  }
  return polygon;
}

Reconstruction Reconstruct(const FrameTable& table, const Finger& finger,
                           const Scene& scene,
                           const Discretization& discretization,
                           const OutlineFitSettings& settings, int points) {
  Reconstruction result;
  result.touches = SenseTouches(table, finger, scene, discretization);
  CheckSpread(result.touches, table.path());
  result.fit = FitOutline(result.touches.usable, settings);
  const ConvexCurve& curve = result.fit.curve;
  result.centroid_mm = CentroidOf(Sampled(curve));
  const TouchCoverage coverage(curve, result.touches.usable);
  result.gaps = coverage.Gaps();
  result.supported_share = coverage.SupportedShare();
  for (int i = 0; i < points; ++i) {
    const double angle = 2 * M_PI * i / points;
    const double normal = NormalAngleOfRay(curve, result.centroid_mm, angle);
    OutlinePoint point;
    point.angle_rad = angle;
    point.position_mm = curve.At(normal);
    point.radius_mm = (point.position_mm - result.centroid_mm).norm();
    point.supported = coverage.Supports(normal);
    double normal_std = result.fit.NormalStd(normal);
    if (!point.supported) {
      // Every place up to the nearest beam is equally likely.
      normal_std = std::hypot(normal_std, Clearance(point.position_mm, normal,
                                                    result.touches.usable) /
                                              std::sqrt(3.0));
    }
    point.std_mm = normal_std / std::cos(normal - angle);
    result.outline.push_back(point);
  }
  const Eigen::VectorXd variance = CalibrationVariance(
      table, finger, scene, discretization, settings, result);
  for (int i = 0; i < points; ++i) {
    OutlinePoint& point = result.outline[static_cast<std::size_t>(i)];
    point.std_mm = std::hypot(point.std_mm, std::sqrt(variance[i]));
  }
  return result;
}

}  // namespace finray
