#include "finray/control/controller.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace finray {
namespace {

// Rows of a log are at k / rate and jumps at k hold_s; where both coincide they
// may differ by rounding.
constexpr double kRounding_s = 1e-9;

std::size_t LevelAt(const Trajectory& steps, double time_s) {
  const double passed =
      std::floor((std::max(time_s, 0.0) + kRounding_s) / steps.hold_s);
  return static_cast<std::size_t>(
      std::min(passed, static_cast<double>(steps.levels.size() - 1)));
}

}  // namespace

double Trajectory::At(double time_s) const {
  time_s = std::max(time_s, 0.0);
  const double sine = std::sin(2 * M_PI * time_s / period_s);
  const double wave =
      triangular ? amplitude * 2 / M_PI * std::asin(sine) : amplitude * sine;
  const std::size_t level = LevelAt(*this, time_s);
  const double since_s =
      std::max(time_s - static_cast<double>(level) * hold_s, 0.0);
  if (level == 0 || !(since_s < ramp_s)) return levels[level] + wave;
  return levels[level - 1] +
         since_s / ramp_s * (levels[level] - levels[level - 1]) + wave;
}

double Trajectory::SinceStep(double time_s) const {
  const std::size_t level = LevelAt(*this, time_s);
  return level == 0 ? std::numeric_limits<double>::infinity()
                    : time_s - static_cast<double>(level) * hold_s;
}

double Trajectory::Middle() const {
  const auto [least, most] = std::minmax_element(levels.begin(), levels.end());
  return 0.5 * (*least + *most);
}

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
