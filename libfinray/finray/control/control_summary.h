#ifndef FINRAY_CONTROL_CONTROL_SUMMARY_H_
#define FINRAY_CONTROL_CONTROL_SUMMARY_H_

#include <string>
#include <vector>

#include "finray/control/run_experiment.h"
#include "finray/io/yaml_emitter.h"

namespace finray {

/// The log of a controller's first draw: "<experiment>.<controller>.csv", of a
/// gripper with ".finger_1", ".finger_2" before ".csv".
std::vector<std::string> ControlLogNames(const Experiment& experiment,
                                         const ControllerSettings& controller);

/// What is in force in an experiment, with all defaults, as a mapping of its
/// YAML's keys.
void EmitSettings(const Experiment& experiment, YamlEmitter* yaml);

/// One experiment of a summary.yaml (docs/reference/formats.md), as a mapping.
void EmitExperiment(const std::string& path, const Experiment& experiment,
                    const std::vector<ControllerResult>& results,
                    YamlEmitter* yaml);

}  // namespace finray

#endif  // FINRAY_CONTROL_CONTROL_SUMMARY_H_
