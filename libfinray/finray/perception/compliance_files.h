#ifndef FINRAY_PERCEPTION_COMPLIANCE_FILES_H_
#define FINRAY_PERCEPTION_COMPLIANCE_FILES_H_

#include <string>
#include <vector>

#include "finray/io/frame_table.h"
#include "finray/perception/compliance.h"

namespace finray {

/// points.csv, one row a point: object, trial, row, displacement_mm,
/// displacement_std_mm, force_N, force_std_N, direction, slides, left_out.
FrameTable PointTable(const Compliance& found);

/// stiffness.csv, from stiff to soft: object, trials, stiffness_N_per_mm,
/// std_N_per_mm, calibration_std_N_per_mm, probability_stiffer_than_next.
FrameTable StiffnessTable(const Compliance& found);

/// laws.csv, the fitted laws for a plot: object, trial, displacement_mm,
/// force_N, friction_N.
FrameTable LawTable(const Compliance& found);

/// compliance.yaml.
std::string ComplianceYaml(const Compliance& found,
                           const std::vector<std::string>& inputs);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_COMPLIANCE_FILES_H_
