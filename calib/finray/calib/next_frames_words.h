#ifndef FINRAY_CALIB_NEXT_FRAMES_WORDS_H_
#define FINRAY_CALIB_NEXT_FRAMES_WORDS_H_

#include <string>

#include "finray/calib/next_frames.h"

namespace finray {

/// E.g. "20 frames at 98 mm with 6 N would shrink the std of front stiffness
/// from 12 % to 4 %".
std::string DescribeNextFrames(CalibrationProblem& problem,
                               const FrameAdvice& advice);

/// "force_N", "object_x_mm, object_y_mm", ...: the columns of a family.
const char* ColumnsOf(ResidualFamily family);

}  // namespace finray

#endif  // FINRAY_CALIB_NEXT_FRAMES_WORDS_H_
