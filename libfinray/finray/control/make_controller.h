#ifndef FINRAY_CONTROL_MAKE_CONTROLLER_H_
#define FINRAY_CONTROL_MAKE_CONTROLLER_H_

#include <memory>

#include "finray/control/controller.h"
#include "finray/control/experiment.h"

namespace finray {

/// The controller that the settings ask for; none for kNone. All that it knows
/// of the world is the finger's model, the mechanism, the actuation, the radius
/// of a circle in the scene (for other shapes a point) and friction.
///
/// The PI's stiffness is that of the model at the height that it is tuned for,
/// under the middle force of the set-point, by drive. Throws InputError if the
/// model has no such contact.
std::unique_ptr<Controller> MakeController(
    const Finger& finger, const Experiment& experiment,
    const ControllerSettings& settings, const Discretization& discretization);

}  // namespace finray

#endif  // FINRAY_CONTROL_MAKE_CONTROLLER_H_
