#include "finray/perception/reconstruction.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/io/error.h"

namespace finray {
namespace {

constexpr int kOutlinePoints = 360;

using Eigen::Vector2d;

std::string StatusCounts(const Touches& touches) {
  std::string text;
  for (const auto& [status, count] : touches.rows) {
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " +
            StatusName(status);
  }
  return text;
}

// The angle in whole degrees from -180 to 180.
std::string Degrees(double angle_rad) {
  return std::to_string(
      std::lround(std::remainder(angle_rad, 2 * M_PI) * 180 / M_PI));
}

// The arc length where the outline is nearest to the contact point. On a
// straight edge the normal does not say where that is.
double NearestArc(const ConvexCurve& curve, const Touch& touch) {
  constexpr int kSteps = 200;
  const double perimeter = curve.perimeter_mm();
  const double about = curve.ArcAt(touch.normal_angle_rad);
  double best = about;
  double least = std::numeric_limits<double>::infinity();
  for (int i = -kSteps; i <= kSteps; ++i) {
    const double arc = about + 0.25 * perimeter * i / kSteps;
    const double distance = (curve.AtArc(arc) - touch.point_mm).norm();
    if (distance >= least) continue;
    least = distance;
    best = arc;
  }
  return best - std::floor(best / perimeter) * perimeter;
}

// The curve at equal arc lengths.
Polygon Sampled(const ConvexCurve& curve) {
  constexpr int kPoints = 2880;
  Polygon polygon;
  for (int i = 0; i < kPoints; ++i) {
    polygon.push_back(curve.AtArc(curve.perimeter_mm() * i / kPoints));
  }
  return polygon;
}

// The normal angle where a ray from inside leaves the curve. It is found by
// bisection, because the direction to a point turns with its arc length.
double NormalAngleOfRay(const ConvexCurve& curve, const Vector2d& centre,
                        double angle_rad) {
  const auto ahead = [&](double arc) {
    const Vector2d r = curve.AtArc(arc) - centre;
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

// Widens the std of each radius by the error of the finger's calibration.
void AddCalibrationError(const FrameTable& table, const Finger& finger,
                         const Scene& scene,
                         const Discretization& discretization,
                         double stage_std_mm, Reconstruction* found) {
  std::vector<double> variance(found->outline.size(), 0);
  for (const FingerVariation& varied :
       FingerVariations(finger, scene.friction())) {
    Scene moved_scene = scene;
    moved_scene.friction_coefficient += varied.friction;
    const Touches touches =
        SenseTouches(table, varied.finger, moved_scene, discretization);
    if (touches.usable.size() < kLeastTouches) continue;
    const Polygon moved =
        Sampled(RefitOutline(touches.usable, found->fit, stage_std_mm));
    for (std::size_t i = 0; i < variance.size(); ++i) {
      const OutlinePoint& point = found->outline[i];
      const auto radius = RadiusAt(moved, found->centroid_mm, point.angle_rad);
      if (!radius) continue;
      variance[i] += (*radius - point.radius_mm) * (*radius - point.radius_mm);
    }
  }
  for (std::size_t i = 0; i < variance.size(); ++i) {
    double& std_mm = found->outline[i].std_mm;
    std_mm = std::hypot(std_mm, std::sqrt(variance[i]));
  }
}

}  // namespace

void CheckSpread(const Touches& touches, const std::string& path) {
  const std::size_t count = touches.usable.size();
  if (count < kLeastTouches) {
    throw InputError(
        path + ": too few touches: " + std::to_string(count) + " usable in " +
        std::to_string(touches.all_rows()) + " rows (" + StatusCounts(touches) +
        "); an outline needs at least " + std::to_string(kLeastTouches));
  }
  std::vector<double> normals;
  for (const Touch& touch : touches.usable) {
    normals.push_back(touch.normal_angle_rad);
  }
  const AngleGap gap = WidestGap(normals);
  const double width = gap.to_rad - gap.from_rad;
  if (width <= kWidestGap_rad) return;
  throw SpreadError(
      path + ": badly spread touches: none has a normal between " +
      Degrees(gap.from_rad) + " and " + Degrees(gap.to_rad) +
      " deg of the object's frame, a gap of " +
      std::to_string(std::lround(width * 180 / M_PI)) + " deg; at most " +
      Degrees(kWidestGap_rad) + " deg; turn the object there and touch it");
}

TouchCoverage::TouchCoverage(const ConvexCurve& curve,
                             const std::vector<Touch>& touches)
    : curve_(curve) {
  const double perimeter = curve.perimeter_mm();
  const double radius = perimeter / (2 * M_PI);
  std::vector<double> contacts;
  for (const Touch& touch : touches) {
    contacts.push_back(NearestArc(curve, touch));
  }
  std::sort(contacts.begin(), contacts.end());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const double next =
        i + 1 < contacts.size() ? contacts[i + 1] : contacts[0] + perimeter;
    if (next - contacts[i] <= kWidestSpacing * radius) continue;
    const double from = contacts[i] + kBesideContact * radius;
    const double to = next - kBesideContact * radius;
    gaps_.push_back({from, to - from, curve.AtArc(from), curve.AtArc(to)});
  }
}

bool TouchCoverage::Supports(double normal_angle_rad) const {
  const double perimeter = curve_.perimeter_mm();
  return std::none_of(gaps_.begin(), gaps_.end(), [&](const Gap& gap) {
    const double from = curve_.ArcAt(normal_angle_rad) - gap.from_arc_mm;
    return from - std::floor(from / perimeter) * perimeter < gap.length_mm;
  });
}

double TouchCoverage::SupportedShare() const {
  double open = 0;
  for (const Gap& gap : gaps_) open += gap.length_mm;
  return 1 - open / curve_.perimeter_mm();
}

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
                           double stage_std_mm) {
  Reconstruction result;
  result.touches = SenseTouches(table, finger, scene, discretization);
  CheckSpread(result.touches, table.path());
  result.fit = FitOutline(result.touches.usable, stage_std_mm);
  const ConvexCurve& curve = result.fit.curve;
  result.centroid_mm = CentroidOf(Sampled(curve));
  const TouchCoverage coverage(curve, result.touches.usable);
  result.gaps = coverage.gaps();
  result.supported_share = coverage.SupportedShare();
  for (int i = 0; i < kOutlinePoints; ++i) {
    const double angle = 2 * M_PI * i / kOutlinePoints;
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
  AddCalibrationError(table, finger, scene, discretization, stage_std_mm,
                      &result);
  return result;
}

Polygon InteriorEnvelope(const std::vector<Touch>& touches, double reach_mm) {
  constexpr int kRays = 1440;
  Vector2d centre(0, 0);
  std::vector<std::vector<Vector2d>> pieces;
  for (const Touch& touch : touches) {
    centre += touch.point_mm / static_cast<double>(touches.size());
    pieces.push_back(touch.BeamNear(reach_mm));
  }
  Polygon contour;
  for (int i = 0; i < kRays; ++i) {
    const double angle = 2 * M_PI * i / kRays;
    const Vector2d ray(std::cos(angle), std::sin(angle));
    double first = std::numeric_limits<double>::infinity();
    for (const auto& piece : pieces) {
      for (std::size_t k = 0; k + 1 < piece.size(); ++k) {
        const auto at = Crossing(ray, piece[k] - centre, piece[k + 1] - centre);
        if (at && *at > 0) first = std::min(first, *at);
      }
    }
    if (std::isfinite(first)) contour.push_back(centre + first * ray);
  }
  return contour;
}

}  // namespace finray
