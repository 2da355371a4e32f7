#include "finray/perception/touch_coverage.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/io/error.h"

namespace finray {
namespace {

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
    const double distance =
        (curve.At(curve.NormalAngleAt(arc)) - touch.point_mm).norm();
    if (distance >= least) continue;
    least = distance;
    best = arc;
  }
  return best - std::floor(best / perimeter) * perimeter;
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
    open_.push_back({contacts[i] + kBesideContact * radius,
                     next - kBesideContact * radius});
  }
}

bool TouchCoverage::Supports(double normal_angle_rad) const {
  const double perimeter = curve_.perimeter_mm();
  return std::none_of(open_.begin(), open_.end(), [&](const Stretch& open) {
    const double from = curve_.ArcAt(normal_angle_rad) - open.from_mm;
    return from - std::floor(from / perimeter) * perimeter <
           open.to_mm - open.from_mm;
  });
}

std::vector<TouchCoverage::Gap> TouchCoverage::Gaps() const {
  std::vector<Gap> gaps;
  for (const Stretch& open : open_) {
    gaps.push_back({curve_.At(curve_.NormalAngleAt(open.from_mm)),
                    curve_.At(curve_.NormalAngleAt(open.to_mm)),
                    open.to_mm - open.from_mm});
  }
  return gaps;
}

double TouchCoverage::SupportedShare() const {
  double open = 0;
  for (const Stretch& stretch : open_) open += stretch.to_mm - stretch.from_mm;
  return 1 - open / curve_.perimeter_mm();
}

}  // namespace finray
