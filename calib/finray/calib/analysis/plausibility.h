#ifndef FINRAY_CALIB_ANALYSIS_PLAUSIBILITY_H_
#define FINRAY_CALIB_ANALYSIS_PLAUSIBILITY_H_

#include "finray/calib/problem/calibration_problem.h"

namespace finray {

/// Refuses logs that cannot belong to the given finger, before a solver spends
/// minutes on them. Such logs have wrong units, signs, columns or radii. Throws
/// InputError if, over the frames with contact,
///  - the median force is not between kLeastForce and kMostForce, in EI /
///    l_0^2;
///  - the object hardly moves while forces change: the ratio of their ranges,
///    from the 10th to the 90th percentile, is above kMostStiffness, in EI /
///    l_0^3;
///  - the force falls as the object moves in: their correlation in each log and
///    tenth of the finger's height is below kLeastCorrelation;
///  - a gauge varies in a log, from the 10th to the 90th percentile, by
///    kMostBend or more over its gain, in rad;
///  - a gauge of a log is dead, stuck or clipped (scene/gauge_faults.h);
///  - fewer than half of the objects can touch the finger where they are, and
///    the plan fixes the object's origin;
///  - the median force differs by more than kFactor from the force that these
///    objects need;
///  - a gauge, its amplifier or its converter changes in mid-log
///    (gauge_changes.h);
///  - objects leave more than kLeastUnexplained of the variance of readings,
///  and
///    kMirrorExplains times as much as the same objects mirrored in y;
///  - gauges cannot be those of the finger (gauge_plausibility.h).
void RefuseImplausible(CalibrationProblem* problem);
constexpr double kLeastForce = 1e-3, kMostForce = 400, kFactor = 50,
                 kMostStiffness = 5e3, kLeastCorrelation = -0.5,
                 kMostBend = 100, kLeastUnexplained = 0.2, kMirrorExplains = 4;

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_PLAUSIBILITY_H_
