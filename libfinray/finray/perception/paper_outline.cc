#include "finray/perception/paper_outline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace finray {
namespace {

using Eigen::Vector2d;

constexpr int kSamples = 1024;

std::complex<double> Wave(int k, double t) {
  return std::polar(1.0, 2 * M_PI * k * t);
}

}  // namespace

Polygon InteriorEnvelope(const std::vector<Touch>& touches, double reach_mm,
                         int count) {
  Vector2d centre(0, 0);
  std::vector<std::vector<Vector2d>> pieces;
  for (const Touch& touch : touches) {
    centre += touch.point_mm / static_cast<double>(touches.size());
    pieces.push_back(touch.BeamNear(reach_mm));
  }
  Polygon contour;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * i / count;
    const Vector2d ray(std::cos(angle), std::sin(angle));
    double first = std::numeric_limits<double>::infinity();
    for (const auto& piece : pieces) {
      for (std::size_t k = 0; k + 1 < piece.size(); ++k) {
        const auto at = Crossing(ray, piece[k] - centre, piece[k + 1] - centre);
        if (at && *at > 0) first = std::min(first, *at);
      }
    }
    if (std::isfinite(first)) contour.push_back(centre + first * ray);
  }
  return contour;
}

FourierDescriptors::FourierDescriptors(const Polygon& polygon, int count)
    : coefficients_(static_cast<std::size_t>(count)) {
  if (count < 3 || count % 2 == 0 || count >= kSamples) {
    throw std::invalid_argument("expected an odd number of descriptors");
  }
  const Polygon points = EvenlySpaced(polygon, kSamples);
  for (int k = 0; k < count; ++k) {
    std::complex<double>& c = coefficients_[static_cast<std::size_t>(k)];
    for (int n = 0; n < kSamples; ++n) {
      const Vector2d& r = points[static_cast<std::size_t>(n)];
      c += Wave(-(k - count / 2), static_cast<double>(n) / kSamples) *
           std::complex<double>(r.x(), r.y());
    }
    c /= kSamples;
  }
}

Vector2d FourierDescriptors::At(double t) const {
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
