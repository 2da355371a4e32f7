#ifndef FINRAY_CONTROL_CONTROLLER_H_
#define FINRAY_CONTROL_CONTROLLER_H_

#include <cmath>
#include <vector>

#include "finray/control/actuator.h"
#include "finray/control/trajectory.h"
#include "finray/sensing/frame_estimate.h"

namespace finray {

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

}  // namespace finray

#endif  // FINRAY_CONTROL_CONTROLLER_H_
