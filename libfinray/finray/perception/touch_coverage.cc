#include "finray/perception/touch_coverage.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

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

int Degrees(double angle_rad) {
  return static_cast<int>(std::lround(angle_rad * 180 / M_PI));
}

}  // namespace

void CheckSpread(const Touches& touches, const std::string& path) {
  const std::size_t count = touches.usable.size();
  if (count < kLeastTouches) {
    throw InputError(path + ": too few touches: " + std::to_string(count) +
                     " usable in " + std::to_string(touches.all_rows()) +
                     " rows (" + StatusCounts(touches) +
                     "); an outline needs at least " +
                     std::to_string(kLeastTouches));
  }
  std::vector<double> normals;
  for (const Touch& touch : touches.usable) {
    normals.push_back(touch.normal_angle_rad);
  }
  std::sort(normals.begin(), normals.end());
  double widest = 0, from = 0, to = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double next =
        i + 1 < count ? normals[i + 1] : normals[0] + 2 * M_PI;
    if (next - normals[i] <= widest) continue;
    widest = next - normals[i];
    from = normals[i];
    to = next;
  }
  if (widest <= kWidestGap_rad) return;
  throw SpreadError(
      path + ": badly spread touches: none has a normal between " +
      std::to_string(Degrees(from)) + " and " +
      std::to_string(Degrees(std::remainder(to, 2 * M_PI))) +
      " deg of the object's frame, a gap of " +
      std::to_string(Degrees(widest)) + " deg; at most " +
      std::to_string(Degrees(kWidestGap_rad)) +
      " deg; turn the object there and touch it");
}

TouchCoverage::TouchCoverage(const ConvexCurve& curve,
                             const std::vector<Touch>& touches)
    : curve_(curve),
      reach_mm_(kSupportReach * curve.perimeter_mm() / (2 * M_PI)) {
  // Where the outline comes nearest to the contact point: on an edge the
  // normal does not tell the place.
  const double perimeter = curve.perimeter_mm();
  for (const Touch& touch : touches) {
    const double about = curve.ArcAt(touch.normal_angle_rad);
    double best = about, least = -1;
    for (int i = -200; i <= 200; ++i) {
      const double arc = about + 0.5 * perimeter * i / 400;
      const double distance =
          (curve.At(curve.NormalAngleAt(arc)) - touch.point_mm).norm();
      if (least >= 0 && distance >= least) continue;
      least = distance;
      best = arc;
    }
    arcs_.push_back(best - std::floor(best / perimeter) * perimeter);
  }
  std::sort(arcs_.begin(), arcs_.end());
}

bool TouchCoverage::Supports(double normal_angle_rad) const {
  const double perimeter = curve_.perimeter_mm();
  const double arc = curve_.ArcAt(normal_angle_rad);
  return std::any_of(arcs_.begin(), arcs_.end(), [&](double contact) {
    return std::abs(std::remainder(arc - contact, perimeter)) <= reach_mm_;
  });
}

std::vector<TouchCoverage::Gap> TouchCoverage::Gaps() const {
  std::vector<Gap> gaps;
  for (std::size_t i = 0; i < arcs_.size(); ++i) {
    const double next = i + 1 < arcs_.size()
                            ? arcs_[i + 1]
                            : arcs_[0] + curve_.perimeter_mm();
    const double from = arcs_[i] + reach_mm_, to = next - reach_mm_;
    if (to <= from) continue;
    gaps.push_back({curve_.At(curve_.NormalAngleAt(from)),
                    curve_.At(curve_.NormalAngleAt(to)), to - from});
  }
  return gaps;
}

double TouchCoverage::SupportedShare() const {
  double open = 0;
  for (const Gap& gap : Gaps()) open += gap.length_mm;
  return 1 - open / curve_.perimeter_mm();
}

}  // namespace finray
