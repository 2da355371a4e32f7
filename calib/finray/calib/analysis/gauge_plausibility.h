#ifndef FINRAY_CALIB_ANALYSIS_GAUGE_PLAUSIBILITY_H_
#define FINRAY_CALIB_ANALYSIS_GAUGE_PLAUSIBILITY_H_

#include <Eigen/Core>
#include <vector>

#include "finray/finger/finger.h"

namespace finray {

/// A frame with contact whose place is known without the gauges, or a free one.
struct ExpectedGauges {
  int log = 0, row = 0;
  std::vector<double> read_V;        ///< NaN where nothing was measured.
  std::vector<double> expected_rad;  ///< Angles of the given finger.
};

/// Refuses gauges whose readings cannot be those of the given finger, before a
/// solver spends minutes on them. Readings and expected angles are compared
/// about their means in each log, because offsets are unknown. With r_jk the
/// correlation of reading j with angle k, and b_j = slope of reading j over
/// angle j, over the given gain, throws InputError if
///  - gauges are swapped: two or more readings fit the angle of another gauge,
///    with a residual that is kSwapped times smaller;
///  - a gauge does not respond: |b_j| <= kDeadShare median |b|;
///  - the unit is wrong: median |b| > kMostGain;
///  - a gauge has the wrong sign: r_jj gain_j / |gain_j| < kWrongSign.
/// Says nothing of a gauge with fewer than kLeastFrames frames, or where the
/// expected angle scatters by less than kLeastBend rad. If all do, readings
/// that scatter by more than kUnexpected noise_V are an error as well: the
/// objects are elsewhere.
void RefuseImplausibleGauges(const std::vector<ExpectedGauges>& frames,
                             const Finger& finger);

/// The mean over the gauges of the share of their readings' variance that the
/// expected angles leave; those that hardly bend are left out. NaN without any.
double UnexplainedShare(const std::vector<ExpectedGauges>& frames,
                        const Finger& finger);
constexpr double kMostGain = 200, kSwapped = 3, kWrongSign = -0.8;
constexpr double kLeastBend = 1e-4, kUnexpected = 20;
constexpr std::size_t kLeastFrames = 10;

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_GAUGE_PLAUSIBILITY_H_
