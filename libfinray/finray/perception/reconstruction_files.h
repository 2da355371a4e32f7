#ifndef FINRAY_PERCEPTION_RECONSTRUCTION_FILES_H_
#define FINRAY_PERCEPTION_RECONSTRUCTION_FILES_H_

#include <string>

#include "finray/io/frame_table.h"
#include "finray/perception/fourier_descriptors.h"
#include "finray/perception/polygon.h"
#include "finray/perception/radial_error.h"
#include "finray/perception/reconstruction.h"

namespace finray {

/// angle_deg, x_mm, y_mm, radius_mm, std_mm, supported, one row a point; with a
/// true outline true_radius_mm, radial_error_percent, of the same angles about
/// the true centroid.
FrameTable OutlineTable(const Reconstruction& found, const Polygon* truth);

/// row, point_x_mm, point_y_mm, normal_deg, normal_N, normal_std_mm,
/// distance_std (NaN along an edge), one row a usable touch.
FrameTable TouchTable(const Reconstruction& found);

/// The pieces of beam within `reach_mm` of each contact: row, x_mm, y_mm.
FrameTable BeamTable(const Reconstruction& found, double reach_mm);

/// reconstruction.yaml. `envelope` is the paper's outline, `error` and
/// `envelope_error` are null without a true outline.
std::string ReconstructionYaml(const Reconstruction& found,
                               const FourierDescriptors& descriptors,
                               const FourierDescriptors& envelope,
                               const RadialError* error,
                               const RadialError* envelope_error,
                               const std::vector<std::string>& inputs);

/// A closed outline from a CSV with x_mm and y_mm, in order around it. Throws
/// InputError for fewer than three points or a cell that is no number.
Polygon ReadOutline(const std::string& path);

}  // namespace finray

#endif  // FINRAY_PERCEPTION_RECONSTRUCTION_FILES_H_
