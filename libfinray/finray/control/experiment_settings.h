#ifndef FINRAY_CONTROL_EXPERIMENT_SETTINGS_H_
#define FINRAY_CONTROL_EXPERIMENT_SETTINGS_H_

#include <yaml-cpp/yaml.h>

#include "finray/control/experiment.h"

namespace finray {

/// What is in force in an experiment, with all defaults, as a mapping with the
/// keys of its YAML.
void EmitSettings(const Experiment& experiment, YAML::Emitter* yaml);

}  // namespace finray

#endif  // FINRAY_CONTROL_EXPERIMENT_SETTINGS_H_
