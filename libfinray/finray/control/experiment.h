#ifndef FINRAY_CONTROL_EXPERIMENT_H_
#define FINRAY_CONTROL_EXPERIMENT_H_

#include <optional>
#include <string>
#include <vector>

#include "finray/control/actuator.h"
#include "finray/control/contact_watch.h"
#include "finray/control/mechanism.h"
#include "finray/control/model_error.h"
#include "finray/control/object_filter.h"
#include "finray/control/trajectory.h"
#include "finray/scene/scene.h"

namespace finray {

/// Where the object is before the loop starts.
struct ObjectStart {
  double y_mm = 0;
  double angle_rad = 0;
  double gap_mm = 1;  ///< to the undeformed front beam
};

enum class ControllerKind {
  kModel,  ///< ModelController
  kPi,     ///< PiController
  kNone,   ///< The drive stays at its start: sensing only.
};

struct ControllerSettings {
  ControllerKind kind = ControllerKind::kModel;
  std::string name;      ///< of its log and its summary
  bool preview = false;  ///< Does it know the set-point beforehand?
  ObjectPrior prior;     ///< of the model controller
  /// The height of a contact that the PI is tuned for.
  double tuned_at_mm = 0;
};

/// Gauges that read nothing for some time.
struct GaugeLoss {
  double from_s, to_s;
  std::vector<int> gauges;  ///< from 0; of the first finger
};

/// What a paper reports of the same experiment, to stand beside ours.
struct PaperFigure {
  int figure = 0;
  double rms_N = 0, max_N = 0;
};

/// A force-control experiment, all of it.
struct Experiment {
  std::string name;
  std::optional<PaperFigure> paper;
  Scene scene;  ///< with the object
  ObjectStart start;
  Trajectory motion;  ///< of the object towards the finger, mm; nobody knows it
  Mechanism mechanism;
  ActuatorSettings actuation;  ///< as the controllers believe it
  double true_delay_s = 0.13;
  bool drive_is_measured = true;  ///< as by a stage's encoder, without error
  double delay_std_s = 0;         ///< of an error of the true delay, drawn anew
  Trajectory set_point;           ///< N
  std::vector<ControllerSettings> controllers;
  Safety safety;
  ModelError model_error;
  std::optional<GaugeLoss> gauge_loss;
  double zero_s = 0.5;  ///< at the start, for zeroing the gauges; 0: not
  double duration_s = 20;
  double measure_from_s = 4;
  double settled_after_s = 1;  ///< of a step of the set-point
  int draws = 10;
};

}  // namespace finray

#endif  // FINRAY_CONTROL_EXPERIMENT_H_
