#ifndef FINRAY_CALIB_WEAK_DIRECTION_WORDS_H_
#define FINRAY_CALIB_WEAK_DIRECTION_WORDS_H_

namespace finray {

class CalibrationProblem;
struct WeakDirection;

/// Says in words which parameters move together along a weak direction.
void DescribeWeakDirection(CalibrationProblem& problem,
                           WeakDirection* direction);

}  // namespace finray

#endif  // FINRAY_CALIB_WEAK_DIRECTION_WORDS_H_
