#ifndef FINRAY_CALIB_ANALYSIS_CANDIDATE_EFFECTS_H_
#define FINRAY_CALIB_ANALYSIS_CANDIDATE_EFFECTS_H_

#include <vector>

#include "finray/calib/problem/calibration_log.h"
#include "finray/calib/problem/plan.h"
#include "finray/finger/finger.h"

namespace finray {

/// A family that a plan may leave out although the world has it.
struct CandidateEffect {
  ParameterFamily family;
  /// What such a finger, bench or sensor is usually off by, in the unit of the
  /// key of its prior in a plan.
  double prior_std;
  const char* words;  ///< What residuals look like if it is there.
};

/// All families, in the order of ParameterFamily. That of the front beam stands
/// for both where they share a key (FrontFamilyOf).
const std::vector<CandidateEffect>& AllCandidateEffects();
/// Returns the one of a family. Throws std::out_of_range if there is none.
const CandidateEffect& CandidateOf(ParameterFamily family);

/// Returns those that the plan does not free and whose columns the logs have.
std::vector<CandidateEffect> CandidatesFor(const Finger& finger,
                                           const Plan& plan,
                                           const CalibrationLogs& logs);

/// Returns the plan with a family free, with the prior of the candidate.
Plan Freed(const Plan& plan, const CandidateEffect& effect);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_CANDIDATE_EFFECTS_H_
