#ifndef FINRAY_CALIB_SOLVE_LINEARIZATION_H_
#define FINRAY_CALIB_SOLVE_LINEARIZATION_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "finray/fit/linearized_frame.h"
#include "finray/residuals/residual_family.h"

namespace finray {

/// Says where a residual of a measurement belongs.
struct ResidualInfo {
  std::int32_t frame;  ///< Index into the frames of the logs.
  ResidualFamily family;
  std::int16_t gauge;  ///< The gauge of kGauge and kBench, else -1.
  float std_V = 0;     ///< Of the reading, for kGauge.
};

/// The cost of some frames near the present values of the free parameters x,
/// without priors. Each x has its best contacts:
///
///   cost(x + dx) = cost + g' dx + dx' S dx / 2,
///   S = sum C'C - C'E (E'E)^-1 E'C,   g = sum (C - E (E'E)^-1 E'C)' r.
///
/// The robust loss weights the rows. The solver and all analyses need no more.
/// One pass over the frames gathers it, and a million frames fit into memory.
struct Linearization {
  // These have an entry for each row. The rows of a frame follow each other.
  std::vector<ResidualInfo> rows;
  std::vector<double> residuals;           ///< In units of their std.
  std::vector<double> weighted_residuals;  ///< Weighted by the robust loss.

  // These have an entry for each frame.
  std::vector<int> frames;
  /// J'r of each frame, free parameters x frames: how the frame pulls the
  /// parameters.
  Eigen::MatrixXf pulls;

  double cost = 0;
  Eigen::VectorXd gradient;  ///< g
  /// The parts of S, by group of frames and residual family. A group is a log,
  /// or a stretch of it (WideLinearization).
  std::map<int, std::array<Eigen::MatrixXd, kResidualFamilies>> information;
  /// The sum of the leverages of the contacts, e_i (E'E)^-1 e_i', by family.
  std::array<double, kResidualFamilies> contact_leverage;

  /// At most `most_frames` frames can be added.
  explicit Linearization(int parameters = 0, std::size_t most_frames = 0);
  /// Frames of one group should follow each other, else few rows are summed at
  /// a time, which takes longer.
  void Add(int frame, int group, const LinearizedFrame& at);
  /// Call it after the last frame is added. `information` is not complete
  /// before.
  void Finish();

  Eigen::MatrixXd Information() const;  ///< S
  Eigen::MatrixXd InformationOfGroup(int group) const;
  Eigen::MatrixXd InformationOfFamily(int family) const;

 private:
  void Sum();

  // Rows of the log added last whose products are not in `information` yet: a
  // product of many rows takes a fraction of the time of many products.
  struct Waiting {
    Eigen::MatrixXd rows;  // parameters x rows
    Eigen::Index count = 0;
  };
  int log_ = -1;
  std::array<Waiting, kResidualFamilies> waiting_;
};

}  // namespace finray

#endif  // FINRAY_CALIB_SOLVE_LINEARIZATION_H_
