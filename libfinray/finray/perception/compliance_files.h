#ifndef FINRAY_PERCEPTION_COMPLIANCE_FILES_H_
#define FINRAY_PERCEPTION_COMPLIANCE_FILES_H_

#include <string>
#include <vector>

#include "finray/io/frame_table.h"
#include "finray/perception/compliance.h"

namespace finray {

/// object, trial, row, displacement_mm, displacement_std_mm, force_N,
/// force_std_N, direction, slides; one row a point.
FrameTable PointTable(const Compliance& found);

/// object, trials, stiffness_N_per_mm, std_N_per_mm, calibration_std_N_per_mm,
/// probability_stiffer_than_next; from stiff to soft.
FrameTable StiffnessTable(const Compliance& found);

/// Force laws as drawn: object, trial, displacement_mm, force_N, friction_N.
FrameTable LawTable(const Compliance& found);

/// compliance.yaml.
std::string ComplianceYaml(const Compliance& found,
                           const std::vector<std::string>& inputs);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_COMPLIANCE_FILES_H_
