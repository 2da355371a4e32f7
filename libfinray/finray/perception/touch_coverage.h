#ifndef FINRAY_PERCEPTION_TOUCH_COVERAGE_H_
#define FINRAY_PERCEPTION_TOUCH_COVERAGE_H_

#include <stdexcept>
#include <vector>

#include "finray/perception/convex_curve.h"
#include "finray/perception/touch.h"

namespace finray {

/// Touches that leave too much of the object open. what() says how much.
class SpreadError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

constexpr std::size_t kLeastTouches = 8;
/// Between neighbouring normals. An outline closes over a gap of 180 deg in any
/// way.
constexpr double kWidestGap_rad = M_PI / 2;
/// Of the mean radius, perimeter / (2 pi): neighbouring contact points so far
/// apart along the outline leave it without support between them, but for a
/// little beside each.
constexpr double kWidestSpacing = 0.5;
constexpr double kBesideContact = 0.05;

/// Throws InputError for fewer than kLeastTouches usable touches and
/// SpreadError for normals with a gap wider than kWidestGap_rad.
void CheckSpread(const Touches& touches, const std::string& path);

/// Where along an outline touches lie. What they say of the rest is that a
/// convex outline passes between the chord and the beams: a straight edge, or
/// the opening of a dent, which no touch can tell from one, as a finger bends
/// round what it touches.
class TouchCoverage {
 public:
  TouchCoverage(const ConvexCurve& curve, const std::vector<Touch>& touches);

  bool Supports(double normal_angle_rad) const;
  /// The share of the outline, by length, that is supported.
  double SupportedShare() const;
  /// Stretches without support, counter-clockwise.
  struct Gap {
    Eigen::Vector2d from_mm, to_mm;
    double length_mm;
  };
  std::vector<Gap> Gaps() const;

 private:
  struct Stretch {
    double from_mm, to_mm;  // arc lengths; may pass the perimeter
  };

  const ConvexCurve& curve_;
  std::vector<Stretch> open_;
};

}  // namespace finray

#endif  // FINRAY_PERCEPTION_TOUCH_COVERAGE_H_
