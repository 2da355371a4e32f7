#ifndef FINRAY_CALIB_SOLVE_LINEARIZATION_H_
#define FINRAY_CALIB_SOLVE_LINEARIZATION_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "finray/residuals/residual_family.h"

namespace finray {

/// The measurements of one frame at the present parameters and contact, and
/// their derivatives: the rows of the frame in [C | E]. They are in units of
/// their std. The robust loss weights them by
///
///   w = sqrt(rho'(|r|^2)),
///
/// with |r|^2 over the residuals of one measurement.
struct LinearizedFrame {
  struct Row {
    ResidualFamily family;
    int gauge;         ///< The gauge of kGauge and kBench, else -1.
    double std_V = 0;  ///< Of the reading, for kGauge.
  };
  using Rows =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  std::vector<Row> rows;
  Eigen::VectorXd residuals;  ///< r, without weights.
  Eigen::VectorXd weights;    ///< w.
  Rows by_parameter;          ///< C, rows x free parameters, weighted.
  /// E, rows x (l_c, f_c), weighted. It is zero for a free frame.
  Eigen::Matrix<double, Eigen::Dynamic, 2> by_contact;
  double cost = 0;  ///< The sum of rho / 2.

  Eigen::VectorXd WeightedResiduals() const {
    return weights.cwiseProduct(residuals);
  }
  /// The contact should move by A + B dx when the parameters move by dx:
  /// (A | B) = -(E'E)^-1 E'(r | C).
  struct ContactMove {
    Eigen::Vector2d now = Eigen::Vector2d::Zero();
    Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor> by_parameter;
    double decrease = 0;  ///< The move A lowers the cost by this.
  };
  ContactMove move;
  /// The rows with the contact eliminated, C - E (E'E)^-1 E'C. They say what
  /// the frame tells about the parameters if l_c and f_c may be anything. Their
  /// product with themselves is the information of the frame.
  Rows reduced;

  /// Computes `move` and `reduced` from the rest.
  void Eliminate();
};

/// Inverts the part of a 2 x 2 information matrix that is more than rounding.
/// For example, a contact without force says nothing about its place.
Eigen::Matrix2d PseudoInverse(const Eigen::Matrix2d& information);

/// Returns C - E (E'E)^-1 E'C.
Eigen::MatrixXd EliminateContact(
    const Eigen::MatrixXd& by_parameter,
    const Eigen::Matrix<double, Eigen::Dynamic, 2>& by_contact);

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
