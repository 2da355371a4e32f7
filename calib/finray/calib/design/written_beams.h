#ifndef FINRAY_CALIB_DESIGN_WRITTEN_BEAMS_H_
#define FINRAY_CALIB_DESIGN_WRITTEN_BEAMS_H_

#include <string>
#include <vector>

#include "finray/finger/finger.h"

namespace finray {

/// A rectangular plate as a user gives it. A Finger keeps only its bending
/// stiffness E w t^3 / 12.
struct WrittenPlate {
  Side side;
  std::string name;  ///< "path:line:column: front beam", for messages.
  double width_mm, thickness_mm, youngs_modulus_GPa;
};

/// Returns the plates of a finger YAML that ReadFinger has accepted, pieces
/// included. A beam with a bending stiffness has none.
std::vector<WrittenPlate> ReadPlates(const std::string& path);

}  // namespace finray

#endif  // FINRAY_CALIB_DESIGN_WRITTEN_BEAMS_H_
