#ifndef FINRAY_PERCEPTION_RECONSTRUCTION_H_
#define FINRAY_PERCEPTION_RECONSTRUCTION_H_

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "finray/perception/contact_sensor.h"
#include "finray/perception/convex_curve.h"
#include "finray/perception/outline_fit.h"
#include "finray/perception/polygon.h"

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
    double from_arc_mm, length_mm;
    Eigen::Vector2d from_mm, to_mm;
  };
  const std::vector<Gap>& gaps() const { return gaps_; }

 private:
  const ConvexCurve& curve_;
  std::vector<Gap> gaps_;
};

/// A point of a reconstructed outline, seen from its centroid.
struct OutlinePoint {
  double angle_rad;
  Eigen::Vector2d position_mm;
  double radius_mm;
  double std_mm;  ///< of the radius
  bool supported;
};

struct Reconstruction {
  Touches touches;
  OutlineFit fit;
  Eigen::Vector2d centroid_mm;
  std::vector<OutlinePoint> outline;  ///< at equally spaced angles from 0
  std::vector<TouchCoverage::Gap> gaps;
  double supported_share;

  Polygon polygon() const;
};

/// Senses the touches of a table, checks that they surround the object and fits
/// the outline. The std of a radius combines three errors:
///  - the noise of gauges and stage, from the fit;
///  - the finger's calibration, by a fit for each of its FingerVariations;
///  - where no touch supports the outline, d / sqrt(3), with d the distance to
///    the nearest beam: a convex outline may lie anywhere up to there.
/// Throws InputError and SpreadError as CheckSpread does.
Reconstruction Reconstruct(const FrameTable& table, const Finger& finger,
                           const Scene& scene,
                           const Discretization& discretization,
                           double stage_std_mm);

/// The outline by the paper's method (IV-B): the contour of the blank area that
/// the pieces of beam near the contacts enclose. Rays replace the paper's
/// image: from the mean of the contact points, at 1440 equally spaced
/// angles, each goes to its first crossing with any piece. A ray that meets no
/// piece gives no point; the contour is straight there.
Polygon InteriorEnvelope(const std::vector<Touch>& touches, double reach_mm);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_RECONSTRUCTION_H_
