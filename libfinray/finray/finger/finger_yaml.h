#ifndef FINRAY_FINGER_FINGER_YAML_H_
#define FINRAY_FINGER_FINGER_YAML_H_

#include <string>

#include "finray/finger/finger.h"

namespace finray {

/// Reads a finger description (schema_version 1). Throws InputError naming
/// file, line and column for anything that is not a buildable finger: unknown
/// keys, missing or non-positive dimensions, pieces that do not fill their
/// beam, a rib that misses the back beam, ribs that cross, a gauge off its
/// beam, a `calibration` that is none of this finger.
Finger ReadFinger(const std::string& path);

/// The YAML text of a finger; ReadFinger returns the same doubles, with
/// stiffness ratios relative to the first piece of a beam. `comment` (may span
/// lines) is written at the top behind '#'.
std::string FingerToYaml(const Finger& finger, const std::string& comment = "");

}  // namespace finray

#endif  // FINRAY_FINGER_FINGER_YAML_H_
