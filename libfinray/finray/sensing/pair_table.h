#ifndef FINRAY_SENSING_PAIR_TABLE_H_
#define FINRAY_SENSING_PAIR_TABLE_H_

#include <Eigen/Core>
#include <vector>

#include "finray/sensing/contact_start.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// Gauge angles, their slopes and equilibria over a coarse grid of two
/// contacts, from which a frame with two contacts is started without a guess.
/// Built once for a finger, where a scene allows two contacts.
///
/// How well a node explains a frame is judged by the least of
///
///   chi2(x) + |(x - node) / spacing|^2,
///
/// the slopes being taken as constant: nodes that would have to be left far
/// behind are no start.
class PairTable {
 public:
  PairTable(EquilibriumSolver* solver, double friction);

  /// The best `most` starts of different pairs of places, best first.
  void FindStarts(const Eigen::VectorXd& angles_rad,
                  const Eigen::VectorXd& weight_per_rad, std::size_t most,
                  std::vector<ContactStart>* starts) const;

 private:
  static constexpr int kUnknowns = 2 * kFittedContacts;
  struct Node {
    std::array<double, kUnknowns> at;       // l_1, f_1, l_2, f_2
    std::array<double, kUnknowns> spacing;  // their size of a step
    Eigen::VectorXd angles_rad;
    Eigen::Matrix<double, Eigen::Dynamic, kUnknowns> slopes;  // per spacing
    LadderState state;
  };
  ContactStart StartFrom(const Node& node, const Eigen::VectorXd& angles_rad,
                         const Eigen::VectorXd& weight_per_rad) const;

  double friction_;
  double length_mm_;
  std::vector<std::vector<Node>> pairs_;  // by place
};

}  // namespace finray

#endif  // FINRAY_SENSING_PAIR_TABLE_H_
