#ifndef FINRAY_CALIB_ANALYSIS_NEXT_FRAMES_WORDS_H_
#define FINRAY_CALIB_ANALYSIS_NEXT_FRAMES_WORDS_H_

#include <string>

#include "finray/calib/analysis/next_frames.h"

namespace finray {

/// Says the advice in words, e.g. "20 frames at 98 mm with 6 N would shrink the
/// std of front stiffness from 12 % to 4 %".
std::string DescribeNextFrames(CalibrationProblem& problem,
                               const FrameAdvice& advice);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_NEXT_FRAMES_WORDS_H_
