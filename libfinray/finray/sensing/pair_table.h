#ifndef FINRAY_SENSING_PAIR_TABLE_H_
#define FINRAY_SENSING_PAIR_TABLE_H_

#include <Eigen/Core>
#include <vector>

#include "finray/sensing/contact_solution.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// Gauge angles, their slopes and equilibria over a coarse grid of two
/// contacts. A frame with two contacts starts from this table without a guess.
/// It is built once for a finger whose scene allows two contacts.
///
/// A node's rating for a frame is the minimum over x of
///
///   chi2(x) + |(x - node) / spacing|^2
///
/// with constant slopes. The second term rejects nodes that a fit would have to
/// leave far behind.
class PairTable {
 public:
  PairTable(EquilibriumSolver* solver, double friction);

  /// Finds a start for each pair of places, best first.
  void FindStarts(const Eigen::VectorXd& angles_rad,
                  const Eigen::VectorXd& weight_per_rad,
                  std::vector<ContactStart>* starts) const;

 private:
  static constexpr int kUnknowns = 2 * kFittedContacts;
  struct Node {
    std::array<double, kUnknowns> at;       // l_1, f_1, l_2, f_2
    std::array<double, kUnknowns> spacing;  // step of each
    Eigen::VectorXd angles_rad;
    Eigen::Matrix<double, Eigen::Dynamic, kUnknowns> slopes;  // per spacing
    LadderState state;
  };
  ContactStart StartFrom(const Node& node, const Eigen::VectorXd& angles_rad,
                         const Eigen::VectorXd& weight_per_rad) const;

  double friction_;
  double length_mm_;
  std::vector<std::vector<Node>> pairs_;  // by pair of places
};

}  // namespace finray

#endif  // FINRAY_SENSING_PAIR_TABLE_H_
