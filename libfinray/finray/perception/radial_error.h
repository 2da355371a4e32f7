#ifndef FINRAY_PERCEPTION_RADIAL_ERROR_H_
#define FINRAY_PERCEPTION_RADIAL_ERROR_H_

#include <vector>

#include "finray/perception/polygon.h"

namespace finray {

/// Radial error in percent, 100 (r - r_true) / r_true, in polar coordinates
/// about the true outline's centroid, at equally spaced angles from 0.
struct RadialError {
  std::vector<double> percent;  ///< NaN where the outline has no radius.

  double Mean() const;  ///< of its magnitude
  double Rms() const;
  double Quantile(double share) const;  ///< of its magnitude
  double Largest() const { return Quantile(1); }
};

/// At `count` angles.
RadialError CompareRadii(const Polygon& outline, const Polygon& truth,
                         int count = 360);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_RADIAL_ERROR_H_
