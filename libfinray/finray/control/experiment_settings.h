#ifndef FINRAY_CONTROL_EXPERIMENT_SETTINGS_H_
#define FINRAY_CONTROL_EXPERIMENT_SETTINGS_H_

#include "finray/control/experiment.h"
#include "finray/io/yaml_emitter.h"

namespace finray {

/// What is in force in an experiment, with all defaults, as a mapping with the
/// keys of its YAML.
void EmitSettings(const Experiment& experiment, YamlEmitter* yaml);

}  // namespace finray

#endif  // FINRAY_CONTROL_EXPERIMENT_SETTINGS_H_
