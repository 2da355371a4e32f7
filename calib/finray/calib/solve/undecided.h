#ifndef FINRAY_CALIB_SOLVE_UNDECIDED_H_
#define FINRAY_CALIB_SOLVE_UNDECIDED_H_

#include <vector>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/contact_store.h"

namespace finray {

/// Decides for those of the frames that are undecided whether they touch, with
/// the present parameters. Each is fitted both ways. The frame touches if chi2
/// of its gauges and its force is then smaller by more than kTouchChi2, the 0.1
/// % point for the two unknowns of a contact. The depth to which the object
/// reaches does not count for a free finger: ribs of other than nominal length
/// move the unloaded beam by tenths of a millimetre. No Part of the problem may
/// be in use meanwhile.
void DecideContacts(const std::vector<int>& frames, CalibrationProblem* problem,
                    ContactStore* contacts);
constexpr double kTouchChi2 = 13.8;

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_UNDECIDED_H_
