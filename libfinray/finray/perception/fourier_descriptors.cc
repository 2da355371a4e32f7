#include "finray/perception/fourier_descriptors.h"

#include <cmath>
#include <stdexcept>

namespace finray {
namespace {

constexpr int kSamples = 1024;

std::complex<double> Wave(int k, double t) {
  return std::polar(1.0, 2 * M_PI * k * t);
}

}  // namespace

FourierDescriptors::FourierDescriptors(const Polygon& polygon, int count)
    : coefficients_(static_cast<std::size_t>(count)) {
  if (count < 3 || count % 2 == 0 || count >= kSamples) {
    throw std::invalid_argument("expected an odd number of descriptors");
  }
  const Polygon points = EvenlySpaced(polygon, kSamples);
  for (int k = 0; k < count; ++k) {
    std::complex<double>& c = coefficients_[static_cast<std::size_t>(k)];
    for (int n = 0; n < kSamples; ++n) {
      const Eigen::Vector2d& r = points[static_cast<std::size_t>(n)];
      c += Wave(-(k - count / 2), static_cast<double>(n) / kSamples) *
           std::complex<double>(r.x(), r.y());
    }
    c /= kSamples;
  }
}

Eigen::Vector2d FourierDescriptors::At(double t) const {
  const int most = static_cast<int>(coefficients_.size()) / 2;
  std::complex<double> value = 0;
  for (int k = -most; k <= most; ++k) {
    value += coefficients_[static_cast<std::size_t>(k + most)] * Wave(k, t);
  }
  return {value.real(), value.imag()};
}

Polygon FourierDescriptors::Sampled(int count) const {
  Polygon polygon;
  for (int i = 0; i < count; ++i) {
    polygon.push_back(At(static_cast<double>(i) / count));
  }
  return polygon;
}

}  // namespace finray
