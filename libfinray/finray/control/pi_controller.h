#ifndef FINRAY_CONTROL_PI_CONTROLLER_H_
#define FINRAY_CONTROL_PI_CONTROLLER_H_

#include "finray/control/controller.h"

namespace finray {

/// A plain PI on the estimated force, for comparison,
///
///   u_k = u_{k-1} + K_p (e_k - e_{k-1}) + K_i T e_k,    e = F_ref - F.
///
/// Its gains follow from Skogestad's rule (SIMC, tau_c = theta) for a drive
/// with the lag tau in front of a spring k and a dead time theta = delay + T/2,
///
///   K_p = tau / (2 k theta),    K_i = K_p / min(tau, 8 theta),
///
/// that is K_i = 1 / (2 k theta) if tau <= 8 theta. k is one number in N per
/// unit of the drive. Commands lead the drive by no more than it can go within
/// the delay and a period, so that the integral does not wind up.
class PiController : public Controller {
 public:
  PiController(double stiffness, const ActuatorSettings& settings,
               bool preview);

  double Next(double time_s, const std::vector<SeenContact>& contacts,
              const Trajectory& set_point, const Actuator& drive) override;
  void Skip() override { started_ = false; }
  void Lost() override { started_ = false; }

  double proportional_gain() const { return proportional_; }
  double integral_gain_per_s() const { return integral_; }

 private:
  double proportional_, integral_;
  bool preview_;
  bool started_ = false;  // there is a last error
  double last_error_N_ = 0;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_PI_CONTROLLER_H_
