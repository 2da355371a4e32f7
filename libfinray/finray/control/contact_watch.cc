#include "finray/control/contact_watch.h"

#include <cmath>

namespace finray {

const char* LoopModeName(LoopMode mode) {
  switch (mode) {
    case LoopMode::kApproach:
      return "approach";
    case LoopMode::kControl:
      return "control";
    case LoopMode::kHold:
      return "hold";
    case LoopMode::kStopped:
      return "stopped";
  }
  return "";
}

Sight Judge(const FrameEstimate& estimate, double signal,
            const Safety& safety) {
  const ContactEstimate& contact = estimate.contact[0];
  const ContactEstimate& other = estimate.alternative[0];
  if (estimate.status == FrameStatus::kNoContact) return Sight::kFree;
  if (estimate.status == FrameStatus::kOk &&
      contact.normal_std_N <= safety.force_std_limit_N) {
    return Sight::kSeen;
  }
  // NaN, where there is no number, is not below.
  if (signal < 1) return Sight::kLight;
  if (estimate.status != FrameStatus::kUnobservable) return Sight::kBlind;
  const double most = contact.normal_N + 2 * contact.normal_std_N;
  const bool alternative = std::isfinite(other.normal_N);
  const bool light =
      most < safety.touch_N &&
      (!alternative ||
       other.normal_N + 2 * contact.normal_std_N < safety.touch_N);
  return light ? Sight::kLight : Sight::kBlind;
}

ContactWatch::ContactWatch(const Safety& safety, double period_s)
    : safety_(safety), period_s_(period_s) {}

LoopMode ContactWatch::Next(const std::vector<FrameEstimate>& estimates,
                            const std::vector<double>& signals) {
  if (mode_ == LoopMode::kStopped) return mode_;
  std::size_t seen = 0, blind = 0;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    const Sight sight = Judge(estimates[i], signals[i], safety_);
    if (sight == Sight::kSeen) ++seen;
    if (sight == Sight::kBlind) ++blind;
  }
  if (blind > 0) {
    ++blind_;
    mode_ = blind_ * period_s_ > safety_.hold_s ? LoopMode::kStopped
                                                : LoopMode::kHold;
    return mode_;
  }
  blind_ = 0;
  mode_ = seen == estimates.size() ? LoopMode::kControl : LoopMode::kApproach;
  return mode_;
}

}  // namespace finray
