#ifndef FINRAY_CONTROL_CONTROLLER_H_
#define FINRAY_CONTROL_CONTROLLER_H_

#include <vector>

#include "finray/control/actuator.h"
#include "finray/control/observation.h"
#include "finray/control/trajectory.h"

namespace finray {

/// Regulates a contact force by a drive's position, a command a period.
class Controller {
 public:
  virtual ~Controller() = default;

  /// The command at a period's beginning from what all fingers see, `drive`
  /// being the controller's own copy of the drive with all commands so far,
  /// advanced to `time_s`.
  virtual double Next(double time_s, const std::vector<SeenContact>& contacts,
                      const Trajectory& set_point, const Actuator& drive) = 0;

  /// A period in which nothing could be seen, or the command was not followed
  /// as somebody else drives.
  virtual void Skip() = 0;
  /// The contact is lost: what was known of it is of no use.
  virtual void Lost() = 0;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_CONTROLLER_H_
