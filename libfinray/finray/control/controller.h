#ifndef FINRAY_CONTROL_CONTROLLER_H_
#define FINRAY_CONTROL_CONTROLLER_H_

#include <cmath>
#include <vector>

#include "finray/control/drive.h"
#include "finray/estimation/frame_estimate.h"

namespace finray {

/// A prescribed force (N) or position (mm) over time: a level and a wave about
/// it.
struct Trajectory {
  /// Each level is held for `hold_s`, the last one for ever. A step starts when
  /// the previous level ends and takes `ramp_s`, at most hold_s; 0 is a jump.
  std::vector<double> levels = {0};
  double hold_s = 1, ramp_s = 0;
  /// The wave amplitude sin(2 pi t / period). A triangular one has straight
  /// lines between the extrema of that.
  double amplitude = 0, period_s = 1;
  bool triangular = false;

  static Trajectory Wave(double mean, double amplitude, double period_s,
                         bool triangular = false) {
    return {{mean}, 1, 0, amplitude, period_s, triangular};
  }

  /// The value at a time; before 0 it is that at 0.
  double At(double time_s) const;
  /// Time since the last step began; infinite before the first one.
  double SinceStep(double time_s) const;
  /// The middle between the least and the largest value.
  double Middle() const;
};

/// The mean normal force of all fingers and its std, for independent errors.
struct MeanForce {
  double force_N = 0, std_N = 0;
};
inline MeanForce MeanForceOf(const std::vector<ContactEstimate>& contacts) {
  double sum = 0, variance = 0;
  for (const ContactEstimate& contact : contacts) {
    sum += contact.normal_N;
    variance += contact.normal_std_N * contact.normal_std_N;
  }
  const auto n = static_cast<double>(contacts.size());
  return {sum / n, std::sqrt(variance) / n};
}

/// Regulates a contact force through the position of a drive. It gives one
/// command a period.
class Controller {
 public:
  virtual ~Controller() = default;

  /// The command at the start of a period. `contacts` has the estimate of each
  /// finger; `drive` is the controller's own copy of the drive, with all
  /// commands so far and advanced to `time_s`.
  virtual double Next(double time_s,
                      const std::vector<ContactEstimate>& contacts,
                      const Trajectory& set_point, const Actuator& drive) = 0;

  /// A period passes without a command from this controller.
  virtual void Skip() = 0;
  /// The contact is lost, and what was learned about it no longer holds.
  virtual void Lost() = 0;
};

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

#endif  // FINRAY_CONTROL_CONTROLLER_H_
