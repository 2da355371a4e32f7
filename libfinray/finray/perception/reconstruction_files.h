#ifndef FINRAY_PERCEPTION_RECONSTRUCTION_FILES_H_
#define FINRAY_PERCEPTION_RECONSTRUCTION_FILES_H_

#include <string>

#include "finray/io/frame_table.h"
#include "finray/perception/paper_outline.h"
#include "finray/perception/polygon.h"
#include "finray/perception/reconstruction.h"

namespace finray {

/// outline.csv, one row a point: angle_deg, x_mm, y_mm, radius_mm, std_mm,
/// supported; with a true outline also true_radius_mm and radial_error_percent,
/// which are seen from the true centroid.
FrameTable OutlineTable(const Reconstruction& found, const Polygon* truth);

/// touches.csv, one row a usable touch: row, point_x_mm, point_y_mm,
/// normal_deg, normal_N, normal_std_mm, distance_std (NaN along an edge).
FrameTable TouchTable(const Reconstruction& found);

/// beams.csv, the pieces of beam within `reach_mm` of each contact: row, x_mm,
/// y_mm.
FrameTable BeamTable(const Reconstruction& found, double reach_mm);

/// reconstruction.yaml. `envelope` is the outline of the paper's method;
/// `error` and `envelope_error` are null without a true outline.
std::string ReconstructionYaml(const Reconstruction& found,
                               const FourierDescriptors& descriptors,
                               const FourierDescriptors& envelope,
                               const RadialError* error,
                               const RadialError* envelope_error,
                               const std::vector<std::string>& inputs);

/// Reads a closed outline from a CSV with the columns x_mm and y_mm, in order
/// around it. Throws InputError for fewer than three points and for a cell that
/// is not a number.
Polygon ReadOutline(const std::string& path);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_RECONSTRUCTION_FILES_H_
