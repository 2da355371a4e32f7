#ifndef FINRAY_CALIB_SOLVE_LINEARIZATION_H_
#define FINRAY_CALIB_SOLVE_LINEARIZATION_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "finray/calib/solve/linearized_frame.h"

namespace finray {

/// One measurement residual and where it belongs.
struct ResidualInfo {
  std::int32_t frame;  ///< index into the logs' frames
  ResidualFamily family;
  std::int16_t gauge;  ///< for kGauge and kBench, else -1
};

/// What all fitted frames say at the present values: all that the analyses
/// need, gathered in one pass and in memory that a million frames fit into.
/// Informations are of the free parameters, frames weighted as by the robust
/// loss and their contacts eliminated.
struct Linearization {
  // By row, those of a frame following each other.
  std::vector<ResidualInfo> rows;
  std::vector<double> residuals;           ///< in units of their std
  std::vector<double> weighted_residuals;  ///< as the robust loss weights them

  // By frame.
  std::vector<int> frames;
  /// J'r of each: which way it pulls the parameters (free x frames).
  Eigen::MatrixXf pulls;

  std::map<int, Eigen::MatrixXd> information_by_log;
  std::array<Eigen::MatrixXd, kResidualFamilies> information_by_family;
  /// Sum of the leverages of the contacts, e_i (E'E)^-1 e_i'.
  std::array<double, kResidualFamilies> contact_leverage;

  /// `most_frames`: how many will be added at most.
  Linearization(int parameters, std::size_t most_frames);
  void Add(int frame, int log, const LinearizedFrame& at);
  /// To be called after the last.
  void Finish();
  Eigen::MatrixXd Information() const;
};

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_LINEARIZATION_H_
