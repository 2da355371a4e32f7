#ifndef FINRAY_CALIB_ANALYSIS_CANDIDATE_EFFECTS_H_
#define FINRAY_CALIB_ANALYSIS_CANDIDATE_EFFECTS_H_

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "finray/calib/problem/calibration_log.h"
#include "finray/calib/problem/parameters.h"
#include "finray/calib/problem/plan.h"
#include "finray/finger/finger.h"

namespace finray {

/// A family that a plan may leave out although the world has it.
struct CandidateEffect {
  ParameterFamily family;
  /// What such a finger, bench or sensor is usually off by, in the unit of the
  /// key of its prior in a plan.
  double prior_std;
  std::string words;  ///< What residuals look like if it is there.
  /// No finger and no bench has a value below, in the unit of
  /// CalibrationParameter::Value; -infinity: any value is possible.
  double least = -std::numeric_limits<double>::infinity();
  /// Nor one above. What is kFarthest prior_std from the fixed value is not
  /// possible either.
  double most = std::numeric_limits<double>::infinity();
  static constexpr double kFarthest = 20;
  /// It may differ from log to log, or change in one: somebody turns a knob,
  /// sets up the stage anew, tares the sensor.
  bool differs = false;
  bool per_log = false;  ///< Freed for each log by itself.
};

/// All families, in the order of ParameterFamily. That of the front beam stands
/// for both where they share a key (FrontFamilyOf).
const std::vector<CandidateEffect>& AllCandidateEffects();
/// Returns the one of a family. Throws std::out_of_range if there is none.
const CandidateEffect& CandidateOf(ParameterFamily family);

/// Returns the least or the greatest value that a finger or bench has, if the
/// parameter is more than kImpossibleStd std beyond it. `std` is that of the
/// variable.
std::optional<double> ImpossibleBound(const CalibrationParameter& parameter,
                                      double std);
constexpr double kImpossibleStd = 3;

/// Returns those that the plan does not free, whose columns the logs have, and
/// that their times allow (row_times.h).
std::vector<CandidateEffect> CandidatesFor(const Finger& finger,
                                           const Plan& plan,
                                           const CalibrationLogs& logs);

/// Says whether a plan can free the family for each log.
bool CanDifferByLog(ParameterFamily family);

/// Returns the plan with a family free, with the prior of the candidate. One
/// that the plan frees already, for all logs in common, keeps its prior.
Plan Freed(const Plan& plan, const CandidateEffect& effect);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_CANDIDATE_EFFECTS_H_
