#ifndef FINRAY_CONTROL_PI_CONTROLLER_H_
#define FINRAY_CONTROL_PI_CONTROLLER_H_

#include "finray/control/controller.h"

namespace finray {

/// A PI controller on the estimated force, for comparison:
///
///   u_k = u_{k-1} + K_p (e_k - e_{k-1}) + K_i T e_k,    e = F_ref - F.
///
/// Skogestad's rule (SIMC, tau_c = theta) gives its gains for a drive with the
/// lag tau, a spring k (N per unit of the drive) and a dead time theta = delay
/// + T/2:
///
///   K_p = tau / (2 k theta),    K_i = K_p / min(tau, 8 theta).
///
/// A command leads the drive by at most the way that the drive can go within
/// the delay and a period, so the integral does not wind up.
class PiController : public Controller {
 public:
  PiController(double stiffness, const ActuatorSettings& settings,
               bool preview);

  double Next(double time_s, const std::vector<ContactEstimate>& contacts,
              const Trajectory& set_point, const Actuator& drive) override;
  void Skip() override { started_ = false; }
  void Lost() override { started_ = false; }

  double proportional_gain() const { return proportional_; }
  double integral_gain_per_s() const { return integral_; }

 private:
  double proportional_, integral_;
  bool preview_;
  bool started_ = false;  // last_error_N_ is set
  double last_error_N_ = 0;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_PI_CONTROLLER_H_
