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

/// The cost of some frames near the present values of the free parameters x,
/// with the best contacts for each x and without priors:
///
///   cost(x + dx) = cost + g' dx + dx' S dx / 2,
///   S = sum C'C - C'E (E'E)^-1 E'C,   g = sum (C - E (E'E)^-1 E'C)' r,
///
/// frames weighted as by the robust loss. The solver and all analyses need no
/// more; it is gathered in one pass and in memory that a million frames fit
/// into.
struct Linearization {
  // By row; the rows of a frame follow each other.
  std::vector<ResidualInfo> rows;
  std::vector<double> residuals;           ///< in units of their std
  std::vector<double> weighted_residuals;  ///< as the robust loss weights them

  // By frame.
  std::vector<int> frames;
  /// J'r of each: which way it pulls the parameters (free x frames).
  Eigen::MatrixXf pulls;

  double cost = 0;
  Eigen::VectorXd gradient;  ///< g
  /// The parts of S, by log and family.
  std::map<int, std::array<Eigen::MatrixXd, kResidualFamilies>> information;
  /// Sum of the leverages of the contacts, e_i (E'E)^-1 e_i'.
  std::array<double, kResidualFamilies> contact_leverage;

  /// `most_frames`: how many will be added at most.
  explicit Linearization(int parameters = 0, std::size_t most_frames = 0);
  void Add(int frame, int log, const LinearizedFrame& at);
  /// To be called after the last.
  void Finish();

  Eigen::MatrixXd Information() const;  ///< S
  Eigen::MatrixXd InformationOfLog(int log) const;
  Eigen::MatrixXd InformationOfFamily(int family) const;
};

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_LINEARIZATION_H_
