#ifndef FINRAY_CALIB_ANALYSIS_PREDICTED_FRAMES_H_
#define FINRAY_CALIB_ANALYSIS_PREDICTED_FRAMES_H_

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "finray/calib/problem/calibration_problem.h"
#include "finray/calib/solve/contact_store.h"
#include "finray/calib/solve/linearization.h"

namespace finray {

/// A frame that nobody has recorded, as the calibrated finger predicts it, with
/// all measurements that a log may have.
struct PredictedFrame {
  bool free;
  double contact_mm, normal_N;  ///< NaN and 0 if free.
  /// Where the stage has the circle, as the logs count its places. NaN without
  /// a circle.
  Eigen::Vector2d object_mm;
  /// The derivatives are by the free parameters, in the given units.
  LinearizedFrame at;
};

/// Fills in what all sensors read of a finger under these contacts, at most one
/// of them: the gauges that work, the magnitude of the force, and where the
/// stage has the circle of the plan. Returns false if the solver's finger
/// cannot carry the contacts.
bool PredictReadings(const std::vector<PointContact>& contacts,
                     const std::vector<bool>& works, const Plan& plan,
                     const StageFrame& stage, EquilibriumSolver* solver,
                     CalibrationFrame* frame);

/// A free frame, and contacts at nine heights under four loads each, up to a
/// load that the logs show the finger to bear. Gauges that never read in the
/// logs do not read here.
struct PredictedFrames {
  std::vector<double> forces_N;
  std::vector<PredictedFrame> frames;
  double gauge_readings = 1;  ///< Each touching one is a mean of so many.
};
PredictedFrames PredictFrames(CalibrationProblem* problem,
                              const Contacts& contacts,
                              const Eigen::VectorXd& unit);

/// The contact that one reading of the gauges alone tells: LinearizedFrame with
/// the rows of the gauges, over the std of one reading.
struct GaugedContact {
  Eigen::Matrix2d noise;  ///< The covariance of (l_c, f_c), (E'E)^-1.
  /// LinearizedFrame::ContactMove
  Eigen::Matrix<double, 2, Eigen::Dynamic> by_parameter;
};
/// Empty with fewer than two gauges. The rows of `at` may be means: one reading
/// of gauge j has the variance of its row and that of `more_noise_V[j]`.
std::optional<GaugedContact> SensedBy(const LinearizedFrame& at,
                                      const std::vector<double>& more_noise_V);
/// Returns that noise, where `rows` has the noise with which rows are fitted
/// that are means of so many readings.
std::vector<double> MoreNoise_V(const Finger& rows, double gauge_readings,
                                const std::vector<double>& reading_noise_V);

/// Predicts the std of a force that the gauges alone sense with the calibrated
/// finger. With SensedBy,
///
///   var f = g C_x g' + noise_ff,   g = by_parameter_f.
///
/// The first part is what errors of the calibration add, the second the noise
/// of the frame. Both are means over the predicted contacts that the gauges
/// sense well: noise leaves the place a std below kSensedPlace of l_0 and the
/// force one below kSensedForce of it.
struct PredictedForce {
  static constexpr double kSensedPlace = 0.02, kSensedForce = 0.05;

  std::vector<std::pair<double, double>> contacts;  ///< Their l_c and f_c.
  /// The mean of g'g: the first part is the trace of weight C_x.
  Eigen::MatrixXd weight;
  double noise_N = 0;  ///< The root of the second part.

  double calibration_N(const Eigen::MatrixXd& covariance) const;
};
PredictedForce PredictForce(const CalibrationProblem& problem,
                            const PredictedFrames& predicted);

}  // namespace finray

#endif  // FINRAY_CALIB_ANALYSIS_PREDICTED_FRAMES_H_
