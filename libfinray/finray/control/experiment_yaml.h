#ifndef FINRAY_CONTROL_EXPERIMENT_YAML_H_
#define FINRAY_CONTROL_EXPERIMENT_YAML_H_

#include <string>

#include "finray/control/experiment.h"
#include "finray/io/yaml_emitter.h"

namespace finray {

/// Reads an experiment YAML (docs/reference/formats.md) for `finger`. Throws
/// InputError at the place of a key that is unknown, missing or impossible.
Experiment ReadExperiment(const std::string& path, const Finger& finger);

/// Writes the settings in force, with all defaults, as a mapping with the keys
/// of that YAML.
void EmitSettings(Experiment experiment, YamlEmitter* yaml);

}  // namespace finray

#endif  // FINRAY_CONTROL_EXPERIMENT_YAML_H_
