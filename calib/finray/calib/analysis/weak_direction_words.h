#ifndef FINRAY_CALIB_ANALYSIS_WEAK_DIRECTION_WORDS_H_
#define FINRAY_CALIB_ANALYSIS_WEAK_DIRECTION_WORDS_H_

namespace finray {

class CalibrationProblem;
struct WeakDirection;

/// The words of the direction that AddCommonGain looks for.
constexpr char kGainsAgainstStiffness[] =
    "all gauge gains scale together against front and back stiffness";

/// Says in words which parameters move together along a weak direction.
void DescribeWeakDirection(CalibrationProblem& problem,
                           WeakDirection* direction);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_WEAK_DIRECTION_WORDS_H_
