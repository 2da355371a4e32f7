#ifndef FINRAY_CALIB_REPORT_DOUBTS_H_
#define FINRAY_CALIB_REPORT_DOUBTS_H_

#include <string>
#include <vector>

#include "finray/calib/analysis/identifiability.h"
#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/report/calibration_result.h"

namespace finray {

/// Says why a converged result is not to be trusted as it stands. Empty if
///  - the intervals of forces from the gauges hold: of the held-out frames, or
///    of the cross-validated ones if there are none, the 68 and 95 % intervals
///    contain as many as the stated shares less kFewerPercent, or kFewer std of
///    a binomial number fewer: frames share the errors of the calibration that
///    senses them, so they are not quite independent;
///  - total chi2 is not loud (TotalChi2);
///  - the residuals of gauges and of forces are not too quiet
///    (Identifiability::Noise): noise told too large makes all intervals from
///    gauges too wide, and hides effects from the other tests;
///  - no value is further than kFarFromPrior std of its prior from it;
///  - no value is beyond what a finger or bench can have (ImpossibleBound);
///  - rejected frames are of the same forces, places and rows as the fitted
///    ones: the rank sums of Mann and Whitney differ by less than kRanksApart
///    std;
///  - the score test finds no effect that the plan leaves out;
///  - all of these tests could be made.
/// Too wide intervals are a warning, and so is a std of places that is told too
/// large: it holds errors that rows share, which residuals need not show.
std::vector<std::string> FindDoubts(const CalibrationProblem& problem,
                                    const CalibrationResult& result);
constexpr double kFewer = 3, kFewerPercent = 2.5, kRanksApart = 3.5;
constexpr std::size_t kLeastRejected = 3;
/// Rows on each side of a change, and exceptions as a share of rejected rows.
constexpr int kLeastOfChange = 10;
constexpr double kMostExceptions = 0.1;

/// "gauge residuals are 0.40 of what their std says (chi2/dof 0.16)".
std::string QuietInWords(ResidualFamily family,
                         const Identifiability::Noise& noise);

/// Puts a warning before all others but `free_scatter` if the verdict is not
/// `good`: the likeliest cause first, if chi2 is loud or an effect is
/// significant, then the doubts. Steps of converters are the cause before any
/// effect if noise does not cover them and chi2 is not loud once the std of
/// their gauges has step / sqrt(12) more. An effect is named only if it
/// explains the residuals (JudgeEffects); if none does, the text says so, and
/// in which gauge, and at which loads, places or rows, chi2 is largest.
void WarnOfDoubts(const CalibrationProblem& problem, CalibrationResult* result);

/// Says in words why what --explore has freed is not to be adopted; empty if it
/// is. Where the logs have an effect that finray lacks, others are freed in its
/// place, and these may deceive. That shows where 95 % intervals of unseen
/// forces hold less often with them and the verdict is not good either.
std::string WhyNotAdopted(const CalibrationResult& explored,
                          const CalibrationResult& given);

}  // namespace finray

#endif  // FINRAY_CALIB_REPORT_DOUBTS_H_
