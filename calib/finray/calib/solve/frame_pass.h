#ifndef FINRAY_CALIB_SOLVE_FRAME_PASS_H_
#define FINRAY_CALIB_SOLVE_FRAME_PASS_H_

#include <functional>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/contact_store.h"
#include "finray/calib/solve/linearization.h"

namespace finray {

/// A function that a pass over frames calls for each of them. The pass
/// evaluates frames in parallel, on the threads of the problem, and visits them
/// one after the other in their order. Only a few frames are in memory at a
/// time. Results do not depend on the number of threads.
using FrameVisitor = std::function<void(int frame, const LinearizedFrame&)>;

/// Linearises the frames at the present values and contacts. Throws
/// std::runtime_error if the model cannot be evaluated at one of them.
void LinearizeFrames(const std::vector<int>& frames,
                     CalibrationProblem* problem, ContactStore* contacts,
                     const FrameVisitor& visit);

/// Moves each contact to where it explains its frame best with the present
/// parameters, and linearises the frames there. A frame that cannot be
/// evaluated is visited without rows.
void FitContacts(const std::vector<int>& frames, CalibrationProblem* problem,
                 ContactStore* contacts, const FrameVisitor& visit);

/// Visits each frame with its contact where it explains most measurements of
/// the frame, by Cauchy's loss at 1 std. A wrong measurement may have drawn a
/// contact away, so the store forgets the contacts of these frames and keeps a
/// new guess.
void FitContactsRobustly(const std::vector<int>& frames,
                         CalibrationProblem* problem, ContactStore* contacts,
                         const FrameVisitor& visit);

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_FRAME_PASS_H_
