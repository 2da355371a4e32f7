#ifndef FINRAY_FINGER_PARAMETER_COVARIANCE_YAML_H_
#define FINRAY_FINGER_PARAMETER_COVARIANCE_YAML_H_

#include <string>

#include "finray/finger/finger.h"
#include "finray/io/yaml_map.h"

namespace finray {

// The `calibration` block of a finger YAML (docs/reference/formats.md):
//
//   parameters: [front_stiffness_N_mm2, gauge_1_gain_V_per_rad]
//   std: [95.5, 0.004]
//   correlations: [[1], [0.2, 1]]      # lower triangle; left out: all 0
//   discrepancy:                       # may be left out
//     load_N: 1
//     places: [{place_mm: 70, std_rad: [2e-4], correlations: [[1]]}]

/// Reads the block for a finger whose ribs and gauges are known. Throws
/// InputError for a parameter that the finger does not have or that appears
/// twice, a wrong number of numbers, and numbers that are no covariance.
ParameterCovariance ReadParameterCovariance(const YamlMap& yaml,
                                            const Finger& finger);

/// The text of the block, which begins with `calibration:`. It reads back as
/// the same doubles.
std::string ParameterCovarianceToYaml(const ParameterCovariance& covariance);

}  // namespace finray

#endif  // FINRAY_FINGER_PARAMETER_COVARIANCE_YAML_H_
