#ifndef FINRAY_CONTROL_EXPERIMENT_H_
#define FINRAY_CONTROL_EXPERIMENT_H_

#include <optional>
#include <string>
#include <vector>

#include "finray/control/contact_watch.h"
#include "finray/control/controller.h"
#include "finray/control/drive.h"
#include "finray/control/model_controller.h"
#include "finray/control/plant.h"
#include "finray/io/yaml_emitter.h"
#include "finray/scene/scene.h"

namespace finray {

enum class ControllerKind {
  kModel,  ///< ModelController
  kPi,     ///< PiController
  kNone,   ///< none: the drive stays at its start
};

struct ControllerSettings {
  ControllerKind kind = ControllerKind::kModel;
  std::string name;      ///< in its log and in the summary
  bool preview = false;  ///< It knows the set-point in advance.
  ObjectPrior prior;     ///< for the model controller
  /// The height of the contact for which the PI is tuned.
  double tuned_at_mm = 0;
};

/// Gauges of the first finger that read nothing for some time.
struct GaugeLoss {
  double from_s, to_s;
  std::vector<int> gauges;  ///< from 0
};

/// What the paper reports for the same experiment.
struct PaperFigure {
  int figure = 0;
  double rms_N = 0, max_N = 0;
};

/// A force-control experiment.
struct Experiment {
  std::string name;
  std::optional<PaperFigure> paper;
  Scene scene;  ///< with the object
  ObjectStart start;
  /// Of the object towards the finger, mm. No controller knows it.
  Trajectory motion;
  Mechanism mechanism;
  ActuatorSettings actuation;  ///< as the controllers assume it
  double true_delay_s = 0.13;
  bool drive_is_measured = true;  ///< without error, as by a stage's encoder
  double delay_std_s = 0;         ///< of the true delay, over the draws
  Trajectory set_point;           ///< N
  std::vector<ControllerSettings> controllers;
  Safety safety;
  ModelError model_error;
  std::optional<GaugeLoss> gauge_loss;
  double zero_s = 0.5;  ///< time to zero the gauges in; 0: they are not zeroed
  double duration_s = 20;
  double measure_from_s = 4;
  double settled_after_s = 1;  ///< after a step of the set-point
  int draws = 10;
  static constexpr int kMostDraws = 10'000;  ///< an hour of CPU
};

/// Reads an experiment YAML (docs/reference/formats.md) for `finger`. Throws
/// InputError at the place of a key that is unknown, missing or impossible.
Experiment ReadExperiment(const std::string& path, const Finger& finger);

/// Writes the settings in force, with all defaults, as a mapping with the keys
/// of that YAML.
void EmitSettings(Experiment experiment, YamlEmitter* yaml);

}  // namespace finray

#endif  // FINRAY_CONTROL_EXPERIMENT_H_
