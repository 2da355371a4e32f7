#ifndef FINRAY_PERCEPTION_TOUCH_COVERAGE_H_
#define FINRAY_PERCEPTION_TOUCH_COVERAGE_H_

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "finray/perception/convex_curve.h"
#include "finray/perception/touch.h"

namespace finray {

/// The touches leave too much of the object open; what() says how much.
class SpreadError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

constexpr std::size_t kLeastTouches = 8;
/// Widest gap between neighbouring normals. At 180 deg an outline could close
/// in any way.
constexpr double kWidestGap_rad = M_PI / 2;
/// In units of the mean radius, perimeter / (2 pi): where neighbouring contact
/// points are farther apart along the outline than kWidestSpacing, the outline
/// between them is not supported, except within kBesideContact of each.
constexpr double kWidestSpacing = 0.5;
constexpr double kBesideContact = 0.05;

/// Throws InputError for fewer than kLeastTouches usable touches and
/// SpreadError for normals with a gap wider than kWidestGap_rad.
void CheckSpread(const Touches& touches, const std::string& path);

/// Which part of an outline the touches support. Elsewhere they only say that a
/// convex outline passes between the chord and the beams. It may be a straight
/// edge or the opening of a dent: a finger bends around both alike.
class TouchCoverage {
 public:
  TouchCoverage(const ConvexCurve& curve, const std::vector<Touch>& touches);

  bool Supports(double normal_angle_rad) const;
  /// The supported share of the outline's length.
  double SupportedShare() const;
  /// Stretches without support, counter-clockwise.
  struct Gap {
    Eigen::Vector2d from_mm, to_mm;
    double length_mm;
  };
  std::vector<Gap> Gaps() const;

 private:
  struct Stretch {
    double from_mm, to_mm;  // arc lengths; to_mm may exceed the perimeter
  };

  const ConvexCurve& curve_;
  std::vector<Stretch> open_;
};

}  // namespace finray

#endif  // FINRAY_PERCEPTION_TOUCH_COVERAGE_H_
