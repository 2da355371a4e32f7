#ifndef FINRAY_SENSING_FAST_CONTACT_FIT_H_
#define FINRAY_SENSING_FAST_CONTACT_FIT_H_

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "finray/ladder/ladder_newton.h"
#include "finray/sensing/fast/gauge_reading.h"

namespace finray {

/// Fits contacts to gauge angles s_j. It minimises
///
///   chi2(l_c, f_c) = sum_j w_j^2 (s_j(l_c, f_c) - measured_j)^2
///
/// over equilibria, with 0 <= l_c <= l_0 and f_c >= 0. These are equations
/// (17), (18) of the paper with equilibrium eliminated. Each iteration
/// linearises the ladder once. Its gauge rows, with their derivatives by (l_c,
/// f_c), give the change of the contacts by least squares, and that change
/// gives the step of all nodes. Equilibrium and contacts thus converge together
/// in a few iterations, and need no weight between them. A warm fit allocates
/// nothing.
class ContactFit {
 public:
  using Readings = Eigen::Ref<const Eigen::VectorXd>;

  /// Throws InputError as LadderModel does. With `circle_radius_mm`, the centre
  /// of a circle that touches the finger at the one contact (circle_centre.h)
  /// is measured too. Its x and y in mm follow the gauges' angles in `measured`
  /// and `weights`.
  ContactFit(const Finger& finger, const Discretization& discretization,
             std::optional<double> circle_radius_mm = std::nullopt);

  /// A fit ends when the next change of l_c over l_0 and of f_c over its size
  /// is expected to be below `relative`. If `relative` is not small in std, the
  /// last change must be below it.
  void set_tolerance(double relative) { tolerance_ = relative; }

  /// Upper bound of f_c.
  void set_most_force(double force_N) { most_force_N_ = force_N; }

  /// A fit that takes more linearisations does not converge; 60 at most.
  void set_most_iterations(int count) { most_iterations_ = count; }
  static constexpr int kMostIterations = 60;

  /// Sets the equilibrium to start from. It must be near the contacts given to
  /// Fit.
  void set_state(const LadderState& state) {
    newton_.Load(state);
    linearised_contacts_ = 0;
  }

  /// Starts from the present equilibrium and from `*contacts` (one or two, on
  /// the front beam; their friction is kept) and leaves both at the solution.
  /// `weights` are 1 / std, and 0 where nothing was measured. Returns false if
  /// the fit does not converge; state and contacts are then undefined.
  bool Fit(const Readings& measured, const Readings& weights,
           std::vector<PointContact>* contacts);

  /// Like Fit, for a frame similar to that of the last call. State and
  /// `*contacts` must be as that call left them. The fit starts from the
  /// solution that the last linearisation predicts for the new readings, so one
  /// iteration is usually enough. The stopping rule is that of Fit, with the
  /// predicted change counted as the change before. Without a successful last
  /// call, Follow does the same as Fit.
  bool Follow(const Readings& measured, const Readings& weights,
              std::vector<PointContact>* contacts);

  // Results of the last successful fit.

  double chi2() const { return chi2_; }
  /// Copies the equilibrium.
  void SaveState(LadderState* state) const { newton_.Save(state); }
  /// Number of linearisations.
  int iterations() const { return iterations_; }
  /// Fisher information of (l_c, f_c) of each contact, per mm and N.
  using Information = ContactMatrix;
  const Information& information() const { return information_; }
  /// (x, y, theta) of a contact and of the tip, in mm and rad.
  const Eigen::Vector3d& contact_pose(int contact) const {
    return poses_[contact];
  }
  const Eigen::Vector3d& tip_pose() const { return poses_[kFittedContacts]; }
  double rib_tension(int rib) const {
    return newton_.frame().state.q[6 + rib] * newton_.workspace().force_unit();
  }

 private:
  void ReadCentre(double radius_mm, int unknowns);
  void Keep(const std::vector<PointContact>& contacts);
  void Restore(std::vector<PointContact>* contacts);

  LadderNewton newton_;
  std::optional<double> circle_radius_mm_;
  double tolerance_ = 1e-12;
  double most_force_N_ = std::numeric_limits<double>::infinity();
  int most_iterations_ = kMostIterations;
  double chi2_ = 0;
  int iterations_ = 0;
  Information information_;
  std::array<Eigen::Vector3d, kFittedContacts + 1> poses_;
  GaugeReading gauges_;
  ContactVector step_;  // since the last linearisation
  // Number of contacts of the last fit whose linearisation the frame still
  // holds; 0 if it holds none.
  int linearised_contacts_ = 0;
  std::vector<double> kept_state_;
  std::vector<PointContact> kept_contacts_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_FAST_CONTACT_FIT_H_
