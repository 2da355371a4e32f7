#ifndef FINRAY_RECONSTRUCTION_H_
#define FINRAY_RECONSTRUCTION_H_

#include <cstddef>
#include <string>

#include "finray/export.h"
#include "finray/finger.h"
#include "finray/scene.h"
#include "finray/simulator.h"
#include "finray/table.h"

namespace finray::v1 {

/// An object's outline from touches, as finray_reconstruct finds it.
struct Reconstruction {
  /// outline.csv: angle_deg, x_mm, y_mm, radius_mm, std_mm, supported.
  Table outline;
  /// touches.csv: row, point_x_mm, point_y_mm, normal_deg, normal_N, ...
  Table touches;
  double centroid_x_mm = 0, centroid_y_mm = 0;
  double perimeter_mm = 0;
  double noise_scale = 0;  ///< Scatter of the touches over their std.
  /// The share of the outline's length that touches support.
  double supported_share = 0;
  std::size_t usable_touches = 0, rows = 0;
};

/// Reconstructs the outline from a table with `gauge_<j>_V`, object_x_mm,
/// object_y_mm and object_angle_deg, a row a touch. `stage_std_mm` is the std
/// of the object's place. Throws InputError, and GateError if the touches leave
/// too much of the object open.
FINRAY_API Reconstruction Reconstruct(
    const Finger& finger, const Table& touches, const Scene& scene = Scene(),
    double stage_std_mm = 0.02, const Discretization& discretization = {});

}  // namespace finray::v1

#endif  // FINRAY_RECONSTRUCTION_H_
