#ifndef FINRAY_FINGER_FINGER_YAML_H_
#define FINRAY_FINGER_FINGER_YAML_H_

#include <string>

#include "finray/finger/finger.h"
#include "finray/io/yaml_map.h"

namespace finray {

/// Reads a finger YAML, schema_version 1 (docs/reference/formats.md). Throws
/// InputError (file:line:column) if it describes no finger that can be built:
/// unknown keys, missing or non-positive dimensions, pieces that do not fill
/// their beam, a rib that misses the back beam, ribs that cross, a gauge off
/// its beam, a `calibration` of another finger.
Finger ReadFinger(const std::string& path);
Finger ReadFinger(const YamlMap& yaml);

/// The YAML text of a finger. ReadFinger returns the same doubles from it, with
/// stiffness ratios relative to the first piece of a beam. The lines of
/// `comment` stand at the top, each after a '#'.
std::string FingerToYaml(const Finger& finger, const std::string& comment = "");

}  // namespace finray

#endif  // FINRAY_FINGER_FINGER_YAML_H_
