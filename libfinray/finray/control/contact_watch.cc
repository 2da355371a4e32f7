#include "finray/control/contact_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/statics/equilibrium.h"

namespace finray {
namespace {

constexpr double kFrom = 0.2, kTo = 0.8;  // of the front beam's length
constexpr int kPlaces = 25;

}  // namespace

const char* LoopModeName(LoopMode mode) {
  constexpr const char* kNames[] = {"zero", "approach", "control", "hold",
                                    "stopped"};
  return kNames[static_cast<int>(mode)];
}

Sight Judge(const FrameEstimate& estimate, double signal,
            const Safety& safety) {
  const ContactEstimate& contact = estimate.contact[0];
  const ContactEstimate& other = estimate.alternative[0];
  // NaN, an unknown force or signal, is not light.
  const double twice_std = 2 * contact.normal_std_N;
  const bool light = contact.normal_N + twice_std < safety.touch_N &&
                     (!std::isfinite(other.normal_N) ||
                      other.normal_N + twice_std < safety.touch_N);
  return {estimate.status == FrameStatus::kOk &&
              contact.normal_std_N <= safety.force_std_limit_N,
          estimate.status == FrameStatus::kNoContact, signal < 1 || light};
}

ContactWatch::ContactWatch(const Safety& safety, double period_s)
    : safety_(safety), period_s_(period_s) {}

LoopMode ContactWatch::Next(const std::vector<Sight>& sights) {
  if (mode_ == LoopMode::kStopped) return mode_;
  std::size_t seen = 0, blind = 0, light = 0;
  for (const Sight& sight : sights) {
    seen += sight.seen;
    blind += sight.blind();
    light += sight.light;
  }
  const std::size_t all = sights.size();
  blind_ = blind > 0 ? blind_ + 1 : 0;
  seen_ = seen == all ? seen_ + 1 : 0;
  if (blind > 0) {
    mode_ = blind_ * period_s_ > safety_.hold_s ? LoopMode::kStopped
                                                : LoopMode::kHold;
  } else if (seen < all) {
    mode_ = LoopMode::kApproach;
  } else if (mode_ != LoopMode::kControl) {
    mode_ = seen_ >= kSureFrames ? LoopMode::kControl
            : light == all       ? LoopMode::kApproach
                                 : LoopMode::kHold;
  }
  return mode_;
}

TouchSignal::TouchSignal(const Finger& finger, double touch_N,
                         const Discretization& discretization)
    : gauges_(finger.gauges),
      least_rad_(std::numeric_limits<double>::infinity()) {
  EquilibriumSolver solver(finger, discretization);
  for (int i = 0; i < kPlaces; ++i) {
    const double share = kFrom + (kTo - kFrom) * i / (kPlaces - 1);
    if (!solver.Solve({{share * finger.front_length_mm, touch_N}})) continue;
    double largest = 0;
    for (int j = 0; j < static_cast<int>(gauges_.size()); ++j) {
      largest = std::max(largest, std::abs(solver.gauge_angle(j)));
    }
    least_rad_ = std::min(least_rad_, largest);
  }
}

double TouchSignal::Of(const Measurements& readings) const {
  double largest = 0;
  for (std::size_t j = 0; j < gauges_.size(); ++j) {
    const double reading_V = readings.gauges_V[j];
    if (!gauges_[j].IsMeasured(reading_V)) return std::nan("");
    largest = std::max(largest, std::abs(gauges_[j].Angle(reading_V)));
  }
  return largest / least_rad_;
}

}  // namespace finray
