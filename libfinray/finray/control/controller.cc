#include "finray/control/controller.h"

#include <algorithm>

namespace finray {

PiController::PiController(double stiffness, const ActuatorSettings& settings,
                           bool preview)
    : preview_(preview) {
  const double tau = settings.time_constant_s;
  const double theta = settings.delay_s + settings.period_s / 2;
  const double per_tau = 1 / (2 * stiffness * theta);  // K_p / tau
  proportional_ = per_tau * tau;
  integral_ = tau <= 8 * theta ? per_tau : proportional_ / (8 * theta);
}

double PiController::Next(double time_s,
                          const std::vector<ContactEstimate>& contacts,
                          const Trajectory& set_point, const Actuator& drive) {
  const ActuatorSettings& settings = drive.settings();
  const double lead = settings.delay_s + settings.period_s;
  const double wanted = set_point.At(preview_ ? time_s + lead : time_s);
  const double error = wanted - MeanForceOf(contacts).force_N;
  const double change = started_ ? error - last_error_N_ : 0;
  started_ = true;
  last_error_N_ = error;
  const double reach = settings.speed_limit * lead +
                       settings.speed_limit * settings.time_constant_s;
  const double now = drive.PredictAt(time_s);
  return std::clamp(drive.last_command() + proportional_ * change +
                        integral_ * settings.period_s * error,
                    now - reach, now + reach);
}

}  // namespace finray
