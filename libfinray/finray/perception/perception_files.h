#ifndef FINRAY_PERCEPTION_PERCEPTION_FILES_H_
#define FINRAY_PERCEPTION_PERCEPTION_FILES_H_

#include <optional>
#include <string>
#include <vector>

#include "finray/perception/compliance.h"
#include "finray/perception/polygon.h"
#include "finray/perception/reconstruction.h"

namespace finray {

/// points.csv, one row a point: object, trial, row, displacement_mm,
/// displacement_std_mm, force_N, force_std_N, direction, slides, left_out.
std::string PointCsv(const Compliance& found);

/// stiffness.csv, from stiff to soft: object, trials, stiffness_N_per_mm,
/// std_N_per_mm, calibration_std_N_per_mm, probability_stiffer_than_next.
std::string StiffnessCsv(const Compliance& found);

/// laws.csv, the fitted laws for a plot: object, trial, displacement_mm,
/// force_N, friction_N.
std::string LawCsv(const Compliance& found);

/// compliance.yaml.
std::string ComplianceYaml(const Compliance& found,
                           const std::vector<std::string>& inputs);

/// outline.csv, one row a point: angle_deg, x_mm, y_mm, radius_mm, std_mm,
/// supported; with an `error` also true_radius_mm and radial_error_percent,
/// which are seen from the true centroid.
std::string OutlineCsv(const Reconstruction& found,
                       const std::optional<RadialError>& error);

/// touches.csv, one row a usable touch: row, point_x_mm, point_y_mm,
/// normal_deg, normal_N, normal_std_mm, along_std_mm (across and along the
/// beam), distance_std (NaN along an edge).
std::string TouchCsv(const Reconstruction& found);

/// beams.csv, the pieces of beam within `reach_mm` of each contact: row, x_mm,
/// y_mm.
std::string BeamCsv(const Reconstruction& found, double reach_mm);

/// reconstruction.yaml. `envelope` is the outline of the paper's method;
/// Without a true outline there is neither
/// `error` nor `envelope_error`.
std::string ReconstructionYaml(const Reconstruction& found,
                               const FourierDescriptors& descriptors,
                               const FourierDescriptors& envelope,
                               const std::optional<RadialError>& error,
                               const std::optional<RadialError>& envelope_error,
                               const std::vector<std::string>& inputs);

/// Reads a closed outline from a CSV with the columns x_mm and y_mm, in order
/// around it. Throws InputError for fewer than three points and for a cell that
/// is not a number.
Polygon ReadOutline(const std::string& path);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_PERCEPTION_FILES_H_
