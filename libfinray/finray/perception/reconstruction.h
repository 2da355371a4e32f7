#ifndef FINRAY_PERCEPTION_RECONSTRUCTION_H_
#define FINRAY_PERCEPTION_RECONSTRUCTION_H_

#include <vector>

#include "finray/perception/outline_fit.h"
#include "finray/perception/polygon.h"
#include "finray/perception/touch.h"
#include "finray/perception/touch_coverage.h"

namespace finray {

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
///  the
///    nearest beam: a convex outline may lie anywhere up to there.
/// Throws InputError and SpreadError as CheckSpread does.
Reconstruction Reconstruct(const FrameTable& table, const Finger& finger,
                           const Scene& scene,
                           const Discretization& discretization,
                           const OutlineFitSettings& settings,
                           int points = 360);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_RECONSTRUCTION_H_
