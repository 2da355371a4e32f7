// The finger that finray_design starts from: a finger YAML, the outline of a
// strip finger in DXF, or dimensions.

#ifndef FINRAY_APPS_DESIGN_START_H_
#define FINRAY_APPS_DESIGN_START_H_

#include <exception>
#include <vector>

#include "finray/calib/design/finger_check.h"
#include "finray/finger/finger.h"

namespace finray {

// The reader of drawings says by itself what is wrong with one.
class DrawingFailed : public std::exception {};

struct Start {
  Finger finger;
  std::vector<WrittenPlate> plates;  // for warnings
};

// From --finger, --dxf or --front_length_mm. Throws UsageError, InputError or
// DrawingFailed.
Start StartFinger();

}  // namespace finray

#endif  // FINRAY_APPS_DESIGN_START_H_
