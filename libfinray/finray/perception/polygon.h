#ifndef FINRAY_PERCEPTION_POLYGON_H_
#define FINRAY_PERCEPTION_POLYGON_H_

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <vector>

namespace finray {

/// A closed curve given by points along it, in mm. The last point joins the
/// first.
using Polygon = std::vector<Eigen::Vector2d>;

/// The centroid of the enclosed area.
Eigen::Vector2d CentroidOf(const Polygon& polygon);

/// `count` points at equal arc lengths, starting at the first point.
Polygon EvenlySpaced(const Polygon& polygon, int count);

/// Where the segment from a to b crosses the line through the origin along the
/// unit vector `direction`: the position on that line, which may be negative.
/// Nothing if both ends are on one side of the line.
std::optional<double> Crossing(const Eigen::Vector2d& direction,
                               const Eigen::Vector2d& a,
                               const Eigen::Vector2d& b);

/// Distance from `centre` to the last point where the ray at an angle crosses
/// the curve; nothing if it does not.
std::optional<double> RadiusAt(const Polygon& polygon,
                               const Eigen::Vector2d& centre, double angle_rad);

/// Radial error of an outline in percent, 100 (r - r_true) / r_true, in polar
/// coordinates about the true outline's centroid, at 360 equally spaced angles
/// from 0. The statistics are those of its magnitude.
struct RadialError {
  std::vector<double> percent;  ///< NaN where either outline has no radius
  std::vector<double> true_radius_mm;  ///< NaN where it has none

  double Mean() const;
  double Rms() const;
  double Quantile(double share) const;
  double Largest() const { return Quantile(1); }
};

RadialError CompareRadii(const Polygon& outline, const Polygon& truth);

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

#endif  // FINRAY_PERCEPTION_POLYGON_H_
