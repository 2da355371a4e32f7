#include "finray/perception/radial_error.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

std::vector<double> Magnitudes(const std::vector<double>& percent) {
  std::vector<double> magnitudes;
  for (const double error : percent) {
    if (std::isfinite(error)) magnitudes.push_back(std::abs(error));
  }
  return magnitudes;
}

}  // namespace

double RadialError::Mean() const {
  const std::vector<double> errors = Magnitudes(percent);
  double sum = 0;
  for (const double error : errors) sum += error;
  return sum / static_cast<double>(errors.size());
}

double RadialError::Rms() const {
  const std::vector<double> errors = Magnitudes(percent);
  double sum = 0;
  for (const double error : errors) sum += error * error;
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

double RadialError::Quantile(double share) const {
  std::vector<double> errors = Magnitudes(percent);
  if (errors.empty()) return std::nan("");
  std::sort(errors.begin(), errors.end());
  const double at = share * static_cast<double>(errors.size() - 1);
  return errors[static_cast<std::size_t>(std::lround(at))];
}

RadialError CompareRadii(const Polygon& outline, const Polygon& truth,
                         int count) {
  const Eigen::Vector2d centre = CentroidOf(truth);
  RadialError error;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * i / count;
    const auto found = RadiusAt(outline, centre, angle);
    const auto actual = RadiusAt(truth, centre, angle);
    error.percent.push_back(found && actual && *actual > 0
                                ? 100 * (*found - *actual) / *actual
                                : std::nan(""));
  }
  return error;
}

}  // namespace finray
