#ifndef FINRAY_PERCEPTION_PAPER_OUTLINE_H_
#define FINRAY_PERCEPTION_PAPER_OUTLINE_H_

#include <complex>
#include <vector>

#include "finray/perception/polygon.h"
#include "finray/perception/touch.h"

namespace finray {

/// The outline by the paper's method (IV-B): the contour of the blank area that
/// the pieces of beam near the contacts enclose. Rays replace the paper's
/// image: from the mean of the contact points, at `count` equally spaced
/// angles, each goes to its first crossing with any piece. A ray that meets no
/// piece gives no point; the contour is straight there.
Polygon InteriorEnvelope(const std::vector<Touch>& touches, double reach_mm,
                         int count = 1440);

/// A closed curve as a complex function of its arc length t from 0 to 1, (19)
/// of the paper:
///
///   x + i y = f(t) = sum_k c_k exp(2 pi i k t),   k = -K .. K,
///   c_k = sum_n exp(-2 pi i k t_n) r(n) / N.
///
/// There are 2 K + 1 complex coefficients in mm, c_-K first (19 in the paper).
/// c_0 is the centre and c_1 a circle; c_-1 turns the circle into an ellipse.
class FourierDescriptors {
 public:
  /// Samples the curve at N = 1024 equal arc lengths. `count` = 2 K + 1; throws
  /// std::invalid_argument if it is even, below 3 or not below N.
  FourierDescriptors(const Polygon& polygon, int count);

  const std::vector<std::complex<double>>& coefficients() const {
    return coefficients_;
  }
  Eigen::Vector2d At(double t) const;
  Polygon Sampled(int count) const;

 private:
  std::vector<std::complex<double>> coefficients_;
};

}  // namespace finray

#endif  // FINRAY_PERCEPTION_PAPER_OUTLINE_H_
