#include "finray/perception/polygon.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "finray/chain/se2.h"

namespace finray {
namespace {

using Eigen::Vector2d;

std::vector<double> Magnitudes(const std::vector<double>& percent) {
  std::vector<double> magnitudes;
  for (const double error : percent) {
    if (std::isfinite(error)) magnitudes.push_back(std::abs(error));
  }
  return magnitudes;
}

constexpr int kSamples = 1024;

std::complex<double> Wave(int k, double t) {
  return std::polar(1.0, 2 * M_PI * k * t);
}

}  // namespace

Vector2d CentroidOf(const Polygon& polygon) {
  // Relative to the first point: a distant origin would cost digits.
  Vector2d moment(0, 0);
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vector2d a = polygon[i] - polygon[0], b = polygon[i + 1] - polygon[0];
    moment += Cross(a, b) * (a + b) / 3;
    twice += Cross(a, b);
  }
  return polygon[0] + moment / twice;
}

Polygon EvenlySpaced(const Polygon& polygon, int count) {
  const std::size_t n = polygon.size();
  std::vector<double> arc(1, 0);
  for (std::size_t i = 0; i < n; ++i) {
    arc.push_back(arc.back() + (polygon[(i + 1) % n] - polygon[i]).norm());
  }
  Polygon even;
  std::size_t edge = 0;
  for (int k = 0; k < count; ++k) {
    const double at = arc.back() * k / count;
    while (edge + 1 < n && arc[edge + 1] <= at) ++edge;
    const double length = arc[edge + 1] - arc[edge];
    const double share = length > 0 ? (at - arc[edge]) / length : 0;
    even.push_back((1 - share) * polygon[edge] +
                   share * polygon[(edge + 1) % n]);
  }
  return even;
}

std::optional<double> Crossing(const Vector2d& direction, const Vector2d& a,
                               const Vector2d& b) {
  const double above_a = Cross(direction, a), above_b = Cross(direction, b);
  if ((above_a > 0) == (above_b > 0)) return std::nullopt;
  const double share = above_a / (above_a - above_b);
  return direction.dot((1 - share) * a + share * b);
}

std::optional<double> RadiusAt(const Polygon& polygon, const Vector2d& centre,
                               double angle_rad) {
  const Vector2d ray(std::cos(angle_rad), std::sin(angle_rad));
  std::optional<double> radius;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto at = Crossing(ray, polygon[i] - centre,
                             polygon[(i + 1) % polygon.size()] - centre);
    if (at && *at > radius.value_or(0)) radius = at;
  }
  return radius;
}

double RadialError::Mean() const {
  const std::vector<double> errors = Magnitudes(percent);
  return std::accumulate(errors.begin(), errors.end(), 0.0) /
         static_cast<double>(errors.size());
}

double RadialError::Rms() const {
  const std::vector<double> errors = Magnitudes(percent);
  return std::sqrt(
      std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0) /
      static_cast<double>(errors.size()));
}

double RadialError::Quantile(double share) const {
  std::vector<double> errors = Magnitudes(percent);
  if (errors.empty()) return std::nan("");
  std::sort(errors.begin(), errors.end());
  const double at = share * static_cast<double>(errors.size() - 1);
  return errors[static_cast<std::size_t>(std::lround(at))];
}

RadialError CompareRadii(const Polygon& outline, const Polygon& truth) {
  constexpr int kAngles = 360;
  const Vector2d centre = CentroidOf(truth);
  RadialError error;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = 2 * M_PI * i / kAngles;
    const auto found = RadiusAt(outline, centre, angle);
    const auto actual = RadiusAt(truth, centre, angle);
    error.true_radius_mm.push_back(actual.value_or(std::nan("")));
    error.percent.push_back(found && actual && *actual > 0
                                ? 100 * (*found - *actual) / *actual
                                : std::nan(""));
  }
  return error;
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
