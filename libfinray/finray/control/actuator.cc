#include "finray/control/actuator.h"

#include <algorithm>
#include <cmath>

namespace finray {

Actuator::Actuator(const ActuatorSettings& settings, double start)
    : settings_(settings),
      position_(start),
      command_(start),
      last_command_(start) {}

void Actuator::Command(double time_s, double position) {
  in_flight_.push_back({time_s + settings_.delay_s, position});
  last_command_ = position;
}

double Actuator::AdvanceTo(double time_s) {
  while (!in_flight_.empty() && in_flight_.front().arrives_s <= time_s) {
    Move(in_flight_.front().arrives_s - time_s_);
    command_ = in_flight_.front().position;
    in_flight_.pop_front();
  }
  Move(time_s - time_s_);
  return position_;
}

double Actuator::PredictAt(double time_s) const {
  return Actuator(*this).AdvanceTo(time_s);
}

double Actuator::CommandFor(double time_s, double position) const {
  const double start = PredictAt(time_s + settings_.delay_s);
  if (!(settings_.time_constant_s > 0)) return position;
  const double share =
      -std::expm1(-settings_.period_s / settings_.time_constant_s);
  return start + (position - start) / share;
}

void Actuator::Move(double seconds) {
  if (!(seconds > 0)) return;
  time_s_ += seconds;
  const double tau = settings_.time_constant_s, limit = settings_.speed_limit;
  // The drive moves at the speed limit until the servo asks for less.
  const double way = command_ - position_;
  const double beyond = std::abs(way) - limit * tau;
  if (beyond > 0) {
    const double ramp_s = std::min(seconds, beyond / limit);
    position_ += std::copysign(limit * ramp_s, way);
    seconds -= ramp_s;
  }
  if (tau > 0) {
    position_ -= (command_ - position_) * std::expm1(-seconds / tau);
  }
}

}  // namespace finray
