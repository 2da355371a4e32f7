#include "finray/calib/design/contact_accuracy.h"

#include <cmath>
#include <limits>

#include "finray/finger/gauge_play.h"

namespace finray {
ContactAccuracy::ContactAccuracy(const Finger& finger, double friction,
                                 const Discretization& discretization)
    : solver_(finger, discretization),
      systematic_(finger, Scene::OfGauges(friction), discretization) {
  const bool solved = solver_.Solve({});
  for (int j = 0; j < solver_.model().gauges(); ++j) {
    free_rad_.push_back(solved ? solver_.gauge_angle(j) : 0);
  }
}

ContactStd ContactAccuracy::At(const std::vector<PointContact>& contacts) {
  const Finger& finger = solver_.model().finger();
  const auto gauges = static_cast<Eigen::Index>(finger.gauges.size());
  const auto unknowns = 2 * static_cast<Eigen::Index>(contacts.size());
  ContactStd std;
  std.noise = std.total = Eigen::VectorXd::Constant(
      unknowns, std::numeric_limits<double>::infinity());
  solver_.Reset();
  if (gauges < unknowns || !solver_.SolveWithSensitivities(contacts)) {
    return std;
  }
  Eigen::VectorXd weights(gauges);
  Measurements row;
  for (Eigen::Index j = 0; j < gauges; ++j) {
    const Gauge& gauge = finger.gauges[j];
    const double angle = solver_.gauge_angle(static_cast<int>(j));
    const double moved_V = gauge.Volts(angle) - gauge.Volts(free_rad_[j]);
    row.gauges_V.push_back(gauge.Volts(angle));
    row.history_std_V.push_back(PlayStd(gauge.HysteresisV(), moved_V));
    weights[j] =
        gauge.IsMeasured(row.gauges_V.back())
            ? std::abs(gauge.Slope(angle)) /
                  row.GaugeStd_V(static_cast<std::size_t>(j), gauge.noise_V)
            : 0;
  }
  const Eigen::MatrixXd slope =
      weights.asDiagonal() *
      solver_.d_outputs().topLeftCorner(gauges, unknowns);
  const ContactMatrix noise = CovarianceOf(slope.transpose() * slope);
  std.noise = std.total = noise.diagonal().cwiseSqrt();
  if (systematic_.empty() || std::isinf(noise(0, 0))) return std;
  std.total =
      (noise.diagonal() + systematic_.Of(contacts, row).diagonal()).cwiseSqrt();
  return std;
}

std::vector<double> HeightsOf(double from_mm, double to_mm) {
  constexpr double kStep_mm = 2.5;
  const int steps =
      std::max(1, static_cast<int>(std::ceil((to_mm - from_mm) / kStep_mm)));
  std::vector<double> heights;
  for (int i = 0; i <= steps; ++i) {
    heights.push_back(from_mm + (to_mm - from_mm) * i / steps);
  }
  return heights;
}

WorstStd WorstOf(const std::vector<double>& heights_mm, double normal_N,
                 double friction, ContactAccuracy* accuracy) {
  WorstStd worst;
  for (const double height : heights_mm) {
    const ContactStd std = accuracy->At({{height, normal_N, friction}});
    if (std.total[0] > worst.place_mm) {
      worst.place_mm = std.total[0];
      worst.place_at_mm = height;
    }
    if (std.total[1] > worst.force_N) {
      worst.force_N = std.total[1];
      worst.force_at_mm = height;
    }
  }
  return worst;
}

}  // namespace finray
