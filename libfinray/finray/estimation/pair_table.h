#ifndef FINRAY_ESTIMATION_PAIR_TABLE_H_
#define FINRAY_ESTIMATION_PAIR_TABLE_H_

#include <Eigen/Core>
#include <array>
#include <vector>

#include "finray/estimation/contact_solution.h"
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
/// leave far behind. Between nodes, the angles are
///
///   s(x) = sum_k N_k(x) (s_k + S_k (x - x_k) / 2),
///
/// with N_k the multilinear weights of the cell's 16 nodes, and S_k their
/// slopes, by places and logarithms of forces. This is exact for polynomials of
/// the second degree.
class PairTable {
 public:
  PairTable(EquilibriumSolver* solver, double friction);

  /// Finds at most `most` starts, the best of different pairs of places, best
  /// first. Starts that descend to the same minimum of the interpolated chi2
  /// are one.
  void FindStarts(const Eigen::VectorXd& angles_rad,
                  const Eigen::VectorXd& weight_per_rad, std::size_t most,
                  std::vector<ContactStart>* starts) const;

 private:
  static constexpr int kUnknowns = 2 * kFittedContacts;
  // l_1, f_1, l_2, f_2: in mm and N, in spacings from a node, or in steps of
  // the grid.
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;
  using Place = std::array<int, kUnknowns>;  // of a node on the grid
  static constexpr int kForcePairs = 16;
  static constexpr int kColumns = 1 + kUnknowns;
  // All nodes at one pair of places, by pairs of forces.
  struct Pair {
    int first, second;
    // The angle of each gauge in rad, then its slopes per spacing. NaN where
    // the finger folds over.
    Eigen::Array<double, kForcePairs, Eigen::Dynamic> values;
    std::array<LadderState, kForcePairs> states;
  };
  struct Rating {
    const Pair* pair;
    int force;  // of the best node; -1 if there is none
    double chi2;
  };
  const Pair* PairAt(const Place& place) const;
  static int ForcesAt(const Place& place);
  Vector At(const Pair& pair, int force) const;  // mm, N
  Vector Spacing(const Vector& at) const;        // mm, N
  Rating Rate(const Pair& pair, const Eigen::VectorXd& angles_rad,
              const Eigen::VectorXd& weight_per_rad) const;
  ContactStart StartFrom(const Rating& rating,
                         const Eigen::VectorXd& angles_rad,
                         const Eigen::VectorXd& weight_per_rad) const;
  // Moves a start to a minimum of the interpolated chi2, at `grid`. Returns
  // false where the grid does not reach, and leaves the start.
  bool Descend(const Eigen::VectorXd& angles_rad,
               const Eigen::VectorXd& weight_per_rad, ContactStart* start,
               Vector* grid) const;
  // One step of Gauss and Newton from x in a cell.
  bool Descent(const Place& cell, const Vector& x,
               const Eigen::VectorXd& angles_rad,
               const Eigen::VectorXd& weight_per_rad, Vector* change) const;
  Vector OnGrid(const ContactStart& start) const;

  double friction_, length_mm_, step_mm_, unit_N_;
  int gauges_;
  std::vector<Pair> pairs_;
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_PAIR_TABLE_H_
