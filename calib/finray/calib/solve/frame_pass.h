#ifndef FINRAY_CALIB_SOLVE_FRAME_PASS_H_
#define FINRAY_CALIB_SOLVE_FRAME_PASS_H_

#include <functional>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/contact_store.h"
#include "finray/calib/solve/linearized_frame.h"

namespace finray {

/// One pass over frames: they are evaluated in parallel on the problem's
/// threads and visited one after the other, in their order. Few frames are in
/// memory at a time, and results do not depend on the number of threads.
using FrameVisitor = std::function<void(int frame, const LinearizedFrame&)>;

/// Linearises the frames at the present values and contacts. Throws
/// std::runtime_error if the model cannot be evaluated at one.
void LinearizeFrames(const std::vector<int>& frames,
                     CalibrationProblem* problem, ContactStore* contacts,
                     const FrameVisitor& visit);

/// Puts each contact to where it explains its frame best, the parameters being
/// what they are. A frame that cannot be evaluated is visited without rows.
void FitContacts(const std::vector<int>& frames, CalibrationProblem* problem,
                 ContactStore* contacts, const FrameVisitor& visit);

/// Visits each frame with its contact where it explains most of the frame, by
/// Cauchy's loss at 1 std. The store forgets what it had, which a wrong
/// measurement may have drawn there, and keeps a new guess.
void FitContactsRobustly(const std::vector<int>& frames,
                         CalibrationProblem* problem, ContactStore* contacts,
                         const FrameVisitor& visit);

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_FRAME_PASS_H_
