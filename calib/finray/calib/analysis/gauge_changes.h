#ifndef FINRAY_CALIB_ANALYSIS_GAUGE_CHANGES_H_
#define FINRAY_CALIB_ANALYSIS_GAUGE_CHANGES_H_

#include <map>
#include <string>
#include <vector>

#include "finray/calib/analysis/gauge_plausibility.h"
#include "finray/calib/problem/calibration_log.h"
#include "finray/finger/finger.h"
#include "finray/scene/gauge_faults.h"

namespace finray {

/// Refuses logs in which the device behind a gauge changes from some row on:
/// one finger cannot explain the rows before and after. `frames` are of any
/// logs, in the order of rows, free ones (expected angles 0) too. For each log
/// and each row k, lines V = a + b alpha over the expected angles alpha are
/// fitted to the readings before k and from k on. With S the sum of squares
/// about lines, each with noise_V^2 a reading more, throws InputError with the
/// row if
///  - readings jump: S of one line is kJumpShare^2 times that of both, and both
///    are further apart than all loads of the log move either;
///  - channels are exchanged: two readings fit their own angles before and the
///    other one's after, S of their own angles is kExchangeShare^2 times that,
///    and each fits with less than kLeftOver of its variance left;
///  - a gain changes: S of one line is kGainShare^2 times that of both, which
///    fit as well, and the slopes differ by a factor of kGainChange or more.
/// Says nothing of a gauge with fewer than kLeastFrames readings on one side,
/// or where these frames hardly bend it.
void RefuseGaugeChanges(const std::vector<ExpectedGauges>& frames,
                        const CalibrationLogs& logs, const Finger& finger);
constexpr double kJumpShare = 5, kExchangeShare = 3, kGainShare = 2,
                 kGainChange = 1.5, kLeftOver = 0.1;

/// Throws InputError with the row from which on, or before which, the converter
/// of a gauge has coarser steps: all differences of readings are multiples of a
/// step of more than GaugeFaultFinder::kCoarseStep noise_V there, and not
/// elsewhere.
void RefuseCoarserSteps(const CalibrationLogs& logs, const Finger& finger);

/// The faults of gauges by log, without the rows of a bench. Logs without any
/// are left out.
std::map<int, std::vector<GaugeFault>> FindGaugeFaults(
    const CalibrationLogs& logs, const Finger& finger);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_GAUGE_CHANGES_H_
