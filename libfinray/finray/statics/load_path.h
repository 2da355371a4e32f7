#ifndef FINRAY_STATICS_LOAD_PATH_H_
#define FINRAY_STATICS_LOAD_PATH_H_

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "finray/ladder/ladder_newton.h"

namespace finray {

/// Follows the equilibria of a finger from the unloaded one while contact
/// forces and assembly prestress grow together, both at a share lambda of their
/// given values. This is pseudo-arclength continuation: with z the shape and
/// (z', lambda') the unit tangent of the path, every point solves equilibrium
/// together with
///
///   z' . (z - z_0) + lambda' (lambda - lambda_0) = ds,
///
/// so the path goes on at a limit point, where lambda turns back.
class LoadPath {
 public:
  /// `newton` must stand at an equilibrium at share `fraction` of the load.
  LoadPath(LadderNewton* newton, const std::vector<PointContact>& contacts,
           double fraction);

  /// Goes one step on. Returns false if no step is short enough; the path then
  /// stays where it was or is lost. A step that reaches `goal`, a share of the
  /// load, ends before any limit point above `goal`.
  bool Advance(double goal = std::numeric_limits<double>::infinity());

  double fraction() const { return fraction_; }
  /// Whether the last step passed a limit point where the load is largest, and
  /// the share of the load there (to about 1e-7).
  bool passed_limit_point() const { return passed_limit_point_; }
  double limit_fraction() const { return limit_fraction_; }

 private:
  bool FindTangent(double fraction, Eigen::VectorXd* tangent, double* slope);
  bool Tangent();
  bool Refine();
  bool GoTo(double arc);
  bool Joins(const Eigen::VectorXd& reached, const Eigen::VectorXd& tangent,
             double slope) const;
  double LimitFraction(double arc, double end_slope);
  double Dot(const double* a, const double* b) const;
  void Keep(Eigen::VectorXd* state) const;
  void Restore(const Eigen::VectorXd& state);
  Eigen::Index Size() const;

  LadderNewton* newton_;
  std::vector<PointContact> contacts_;
  double fraction_, trial_fraction_ = 0;
  double step_ = 0.05;
  double limit_fraction_ = 0;
  bool passed_limit_point_ = false, lost_ = false;
  int corrections_ = 0;
  // In the order of LadderNodes. The tangent is empty at the start.
  Eigen::VectorXd start_, tangent_;
  double tangent_fraction_ = 0;
};

/// How a solve, or a walk along the path, ended.
enum class SolveStatus {
  kSolved,
  kBadLoad,     ///< A contact off its beam, or a number that is not finite.
  kLimitPoint,  ///< The equilibrium that grows out of the unloaded finger ends
                ///< (folds over) before the whole load is reached.
  kNotConverged,
  kRibTooBent,  ///< A rib bends further than its equations hold (rib_law.h).
};

/// Walks from the undeformed finger to the whole load. On kSolved `newton` is
/// near the equilibrium there and must be converged. *fraction is the share of
/// the load that was reached, at which the path turned back or was lost.
SolveStatus WalkLoadPath(const std::vector<PointContact>& contacts,
                         LadderNewton* newton, double* fraction);

}  // namespace finray

#endif  // FINRAY_STATICS_LOAD_PATH_H_
