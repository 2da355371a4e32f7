#ifndef FINRAY_CALIB_ANALYSIS_FREE_SCATTER_H_
#define FINRAY_CALIB_ANALYSIS_FREE_SCATTER_H_

#include <cstddef>
#include <vector>

#include "finray/calib/problem/calibration_log.h"
#include "finray/finger/finger.h"
#include "finray/io/warning.h"

namespace finray {

/// The noise of a gauge, measured without a model: s = 1.4826 median |d| /
/// sqrt(2), where d are the differences of successive free readings of a log.
/// Slow drift and a few odd readings do not change it.
struct FreeScatter {
  int gauge = 0;
  double std_V = 0;
  int differences = 0;

  /// Says whether s is beyond doubt above a noise: by half of it, and by
  /// kSignificant std of s, which are about 1.4 s / sqrt(differences) for a
  /// median of differences that share their readings.
  bool IsAbove(double noise_V) const;
  static constexpr double kSignificant = 4;
};

/// Returns the scatter of each gauge with kLeastDifferences or more.
std::vector<FreeScatter> MeasureFreeScatter(const CalibrationLogs& logs,
                                            int gauges);
constexpr std::size_t kLeastDifferences = 5;

/// Warns if a gauge scatters beyond doubt more than its noise_V. All estimates
/// depend on that noise, so this warning comes before all others.
void WarnOfFreeScatter(const std::vector<FreeScatter>& scatter,
                       const Finger& finger, std::vector<Warning>* warnings);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_FREE_SCATTER_H_
