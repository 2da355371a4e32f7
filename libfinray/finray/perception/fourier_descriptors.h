#ifndef FINRAY_PERCEPTION_FOURIER_DESCRIPTORS_H_
#define FINRAY_PERCEPTION_FOURIER_DESCRIPTORS_H_

#include <complex>
#include <vector>

#include "finray/perception/polygon.h"

namespace finray {

/// A closed curve as a complex function of its arc length t from 0 to 1, (19)
/// of the paper:
///
///   x + i y = f(t) = sum_k c_k exp(2 pi i k t),   k = -K .. K,
///   c_k = sum_n exp(-2 pi i k t_n) r(n) / N,
///
/// 2 K + 1 complex numbers (19 there), c_-K first. c_0 is the centre, c_1 a
/// circle, c_-1 makes it an ellipse.
class FourierDescriptors {
 public:
  /// Of a curve sampled at N = 1024 equal arc lengths. `count` is odd.
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

#endif  // FINRAY_PERCEPTION_FOURIER_DESCRIPTORS_H_
