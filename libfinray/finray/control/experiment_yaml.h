#ifndef FINRAY_CONTROL_EXPERIMENT_YAML_H_
#define FINRAY_CONTROL_EXPERIMENT_YAML_H_

#include <string>

#include "finray/control/experiment.h"

namespace finray {

/// Reads an experiment YAML (docs/reference/formats.md). `finger` is the one
/// that it is for. Throws InputError at the place of what is unknown, missing
/// or impossible.
Experiment ReadExperiment(const std::string& path, const Finger& finger);

}  // namespace finray

#endif  // FINRAY_CONTROL_EXPERIMENT_YAML_H_
