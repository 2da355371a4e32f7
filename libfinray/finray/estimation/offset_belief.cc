#include "finray/estimation/offset_belief.h"

#include <cmath>

namespace finray {
namespace {

// In std of the noise. A touch that moves the gauges by less does not last:
// noise makes one frame in a thousand such a touch.
constexpr double kFelt = 8;

}  // namespace

void OffsetBelief::Wander(double to_s, double walk_V2_per_s) {
  variance_V2.array() += walk_V2_per_s * std::abs(to_s - time_s);
  time_s = to_s;
}

void OffsetBelief::Absorb(const Finger& finger, const Eigen::VectorXd& angles,
                          const Measurements& row) {
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    const Gauge& gauge = finger.gauges[j];
    if (!gauge.IsMeasured(row.gauges_V[j])) continue;
    double& mean = mean_V[j];
    double& variance = variance_V2[j];
    const double weight =
        variance / (variance + std::pow(row.GaugeStd_V(j, gauge.noise_V), 2));
    mean += weight * (row.gauges_V[j] - gauge.BendingVolts(angles[j]) - mean);
    variance *= 1 - weight;
  }
}

void MoveToOffsetsOf(const Finger& finger, const OffsetBelief& belief,
                     const Measurements& row, Measurements* moved) {
  *moved = row;
  moved->history_std_V.resize(row.gauges_V.size());
  for (std::size_t j = 0; j < row.gauges_V.size(); ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    // A reading at the rail stays none, wherever it is moved.
    if (!finger.gauges[j].IsMeasured(row.gauges_V[j])) {
      moved->gauges_V[j] = Measurements::kNotMeasured;
    }
    moved->gauges_V[j] += finger.gauges[j].offset_V - belief.mean_V[i];
    moved->history_std_V[j] =
        std::hypot(row.history_std_V.empty() ? 0 : row.history_std_V[j],
                   std::sqrt(belief.variance_V2[i]));
  }
}

void ReadBesideFree(const Finger& finger, const Eigen::VectorXd& angles,
                    const Measurements& row, Eigen::VectorXd* beside_V) {
  beside_V->resize(angles.size());
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    const Gauge& gauge = finger.gauges[j];
    const double volts = row.gauges_V[j];
    (*beside_V)[j] = gauge.IsMeasured(volts)
                         ? volts - gauge.BendingVolts(angles[j])
                         : Measurements::kNotMeasured;
  }
}

void HeldTouch::Hold(const Eigen::VectorXd& beside_V, double time_s) {
  if (!lasts_) held_V_ = beside_V;
  const double share = -std::expm1(-std::abs(time_s - time_s_) / kMemory_s);
  for (Eigen::Index j = 0; lasts_ && j < beside_V.size(); ++j) {
    if (std::isnan(beside_V[j])) continue;
    held_V_[j] = std::isnan(held_V_[j])
                     ? beside_V[j]
                     : held_V_[j] + share * (beside_V[j] - held_V_[j]);
  }
  lasts_ = true;
  time_s_ = time_s;
}

bool HeldTouch::Lasts(const Finger& finger, const Eigen::VectorXd& beside_V,
                      const Eigen::VectorXd& offsets_V) const {
  if (!lasts_) return false;
  double along = 0, held = 0;
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    if (std::isnan(beside_V[i]) || std::isnan(held_V_[i])) continue;
    const double weight = std::pow(finger.gauges[j].noise_V, -2);
    const double then_V = held_V_[i] - offsets_V[i];
    along += weight * (beside_V[i] - offsets_V[i]) * then_V;
    held += weight * then_V * then_V;
  }
  return held > kFelt * kFelt &&
         along >= kReleased * held - kSure * std::sqrt(held);
}

}  // namespace finray
