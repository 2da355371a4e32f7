#ifndef FINRAY_ESTIMATION_ZEROED_FINGER_H_
#define FINRAY_ESTIMATION_ZEROED_FINGER_H_

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/scene/gauge_standstill.h"
#include "finray/scene/measurements.h"

namespace finray {

/// What tells free rows from rows in which something touches.
struct ZeroCheck {
  double friction = 0;  ///< Of the contact that rows are tried with.
  bool touch_allowed = false;
  /// The log that has the free rows, to see whether a gauge ever moves.
  const std::vector<Measurements>* log = nullptr;
};

/// A finger whose gauges were zeroed.
struct ZeroedFinger {
  Finger finger;
  std::size_t rows = 0;           ///< The number of readings.
  std::vector<double> change_V;   ///< New offset less the old one, by gauge.
  std::vector<double> std_V;      ///< Of the mean reading, by gauge.
  std::vector<double> scatter_V;  ///< Std of one reading, by gauge.
  std::size_t fewest = 0;         ///< Readings of the gauge with the fewest.
};

/// Sets the offsets by n readings of the free finger,
///
///   offset_j = mean V_j - g_j(x),   g_j = gain_j angle_j(x),
///
/// where angle_j is that of the unloaded finger: ribs of other than nominal
/// length bend it. All other numbers stay, and so does the covariance C_x of
/// the other calibrated parameters x. The new offsets forget the old ones:
///
///   cov(offset) = diag(s_j^2 / n) + G C_x G',  cov(offset, x) = -G C_x,
///
/// with G = dg/dx and s_j the scatter of the readings, no less than noise_V. A
/// gauge with hysteresis has (gain w)^2 / 3 more: nobody knows how it came to
/// rest. A
/// finger without a calibration stays without.
///
/// Throws InputError with `source` if there are fewer than kLeastZeroRows rows
/// with readings of a gauge, if a gauge varies by more than kSteady times its
/// noise or does not move, if the finger has no equilibrium, or if something
/// touches it: with the old offsets the mean readings, of two gauges or more,
/// are those of one contact and not those of the free finger. With chi2 in
/// units of the noise of one reading that is so if the contact lowers it by
/// FrameEstimator::kSignificance and its force is no less than LeastForce_N,
/// and it explains the means (p >= FrameEstimate::kUnexplained) or leaves less
/// than kTouchLeaves of the root of chi2, which offsets that move by themselves
/// rarely do. A gauge does not move if kFewZeroRows or more readings scatter by
/// no more than kStill times its noise, and in the log it varies by no more
/// than GaugeStandstill::kNoiseRange times it. Coarse steps of a converter may
/// do that too, so it may if it reads what a finger with an offset that is not
/// zero says, both within kNear times its noise. touch_allowed leaves out the
/// looks for touches and for such gauges.
ZeroedFinger ZeroGauges(const Finger& finger,
                        const Discretization& discretization,
                        const std::vector<Measurements>& free_rows,
                        const std::string& source, const ZeroCheck& check = {});
/// Returns gain times angle of each gauge of the unloaded finger. Throws
/// InputError if it has no equilibrium.
Eigen::VectorXd FreeVolts(const Finger& finger,
                          const Discretization& discretization);
constexpr std::size_t kLeastZeroRows = 3;
constexpr std::size_t kFewZeroRows = 10;  ///< With fewer a caller warns.
/// A caller warns of gauges that pass although they do not move.
constexpr double kStill = GaugeStandstill::kNoNoise;
constexpr double kNear = 3;
constexpr double kTouchLeaves = 0.05;
constexpr double kSteady = 5;

}  // namespace finray

#endif  // FINRAY_ESTIMATION_ZEROED_FINGER_H_
