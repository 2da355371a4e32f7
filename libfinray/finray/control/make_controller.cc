#include "finray/control/make_controller.h"

#include "finray/control/model_controller.h"
#include "finray/control/pi_controller.h"
#include "finray/io/error.h"

namespace finray {

std::unique_ptr<Controller> MakeController(
    const Finger& finger, const Experiment& experiment,
    const ControllerSettings& settings, const Discretization& discretization) {
  if (settings.kind == ControllerKind::kNone) return nullptr;
  const Mechanism& mechanism = experiment.mechanism;
  std::vector<PushModel> models;
  for (int i = 0; i < mechanism.fingers(); ++i) {
    models.emplace_back(finger, experiment.scene.circle_radius_mm().value_or(0),
                        experiment.scene.friction_coefficient, discretization);
  }
  if (settings.kind == ControllerKind::kModel) {
    return std::make_unique<ModelController>(
        std::move(models), mechanism, settings.prior,
        experiment.actuation.period_s, settings.preview);
  }
  const double y_mm = settings.tuned_at_mm;
  const auto push =
      models.front().At(MakePose<double>(0, Eigen::Vector2d::Zero()), y_mm,
                        experiment.set_point.Middle(), y_mm);
  if (!push) {
    throw InputError("the finger's model has no contact of " +
                     std::to_string(experiment.set_point.Middle()) +
                     " N at the height that the PI is tuned for");
  }
  return std::make_unique<PiController>(
      push->stiffness_N_per_mm * mechanism.ApproachPerDrive(0, y_mm),
      experiment.actuation, settings.preview);
}

}  // namespace finray
