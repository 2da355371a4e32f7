#ifndef FINRAY_FIT_CONTACT_STEP_H_
#define FINRAY_FIT_CONTACT_STEP_H_

#include <Eigen/Core>

#include "finray/finger/mesh.h"
#include "finray/fit/contact_covariance.h"

namespace finray {

// The rules by which fits move contacts to explain gauges: Gauss-Newton on x =
// (l_c / l_0, f_c / force unit) of each contact,
//
//   (A + B + D) dx = -g,    A = S' S,  g = S' r,
//
// with r the whitened residuals, S their slopes, B = sum_j r_j d2r_j/dx2 where
// it is known, and D a damping, within 0 <= l_c <= l_0 and 0 <= f_c <= its
// bound.

using ContactVector =
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * kFittedContacts, 1>;

// A linearisation is of no use beyond these changes, about a bay and 40
// degrees.
constexpr double kLongestMove = 0.1;  // of l_0
constexpr double kMaxTurn_rad = 0.7;
// A change is taken back if it raises chi2 by more than this factor plus 1. A
// smaller rise means little, because chi2 is known only to first order before
// equilibrium is reached.
constexpr double kMostRise = 2;

// A force counts as at least this large when its changes are compared, in units
// of EI / l_0^2.
constexpr double kSmallForce = 0.02;

struct ContactEquations {
  ContactMatrix normal;
  ContactVector gradient;
  double chi2;
  ContactMatrix curvature = {};  ///< B; empty if it is not known.
};

/// Adds up the equations of one contact with B.
class CurvedSums {
 public:
  /// `angle` is s_j - measured_j, then come its derivatives by x.
  void Add(double weight, double angle, double by_arc, double by_force,
           double by_arc_arc, double by_arc_force, double by_force_force);
  /// B is left out unless A + B is positive. Without B the change leads
  /// downhill.
  ContactEquations Equations() const;

 private:
  double chi2_ = 0, gradient_[2] = {}, normal_[3] = {}, curvature_[3] = {};
};

/// Updates B after a `step` from one linearisation to the next, by the secant
/// method of Dennis, Gay and Welsch (NL2SOL, ACM TOMS 7, 1981): B takes the
/// change of the slopes along the step, times the residuals behind it. `before`
/// and `behind` are S' r at both, `mixed` has the slopes before the step and
/// the residuals behind it. B begins with zero.
void UpdateCurvature(const ContactVector& step, const ContactVector& before,
                     const ContactVector& mixed, const ContactVector& behind,
                     ContactMatrix* curvature);

/// Solves for the change dx from x. A component that would pass a bound is set
/// to the bound, and the others are solved again. `most_force` is in units of
/// x, `damping` is Levenberg's.
ContactVector BoundedChange(const ContactEquations& equations,
                            const ContactVector& x, double most_force,
                            double damping);

/// The share of a change of l_c to be taken with a change `by` of f_c. Small
/// angles are f phi(l); the linearised change (dl, df) is that of
/// (f + df) phi(l + dl f / (f + df)). Near the tip, where the gauges see little
/// but f (l_0 - l_c), the contact then moves along that hyperbola. 1 for small
/// `by`, so that the last steps are Newton's.
double ArcShare(double normal, double by);

/// Moves a contact by `change` = (l_c, f_c) of x, within 0 <= l_c <= l_0 and 0
/// <= f_c. Returns whether it has passed to another element of the mesh.
bool MoveContact(const BeamMesh& mesh, const double* change, double length_unit,
                 double force_unit, double* arc_mm, double* normal_N);

/// The Fisher information of (l_c, f_c) per mm and N from that of x.
ContactMatrix InformationOf(ContactMatrix normal, double length_unit,
                            double force_unit);

/// The largest of the changes of l_c over l_0, of f_c over its size, and
/// `shape`, the change of positions over l_0 and of angles.
double LargestChange(const ContactVector& change, const ContactVector& x,
                     double shape);

// When to stop. Near the solution the changes obey next = rho now + C now^2. C
// follows from the last two changes: Newton's method converges quadratically,
// so C now is at most (now / before)^2. The linear rate rho has two causes: the
// damping D, and the curvature of the gauges that B leaves out,
//
//   rho = |(A + B + D)^-1 ((B + D) step - dS' r)| / |step|.
//
// r are the residuals after the change. dS is the difference of the slopes to
// those of the linearisation before, which was `step` away. This is the rate
// along that step; the rate along others may be up to kDoubt times as large.
constexpr double kDoubt = 4;
/// The assumed last change before the first iteration.
constexpr double kUnknownChange = 1e-4;

/// Returns rho. `by_residual` is dS' r.
double CurvatureRate(const ContactEquations& equations, double damping,
                     const ContactVector& by_residual,
                     const ContactVector& step, const ContactVector& x);

/// Says whether the next change is expected below `tolerance`. If the last
/// change took a contact to another element, the linearisation does not cover
/// it, and `now` itself is compared.
bool IsLastChange(double now, double before, double rate, bool crossed,
                  double tolerance);

}  // namespace finray

#endif  // FINRAY_FIT_CONTACT_STEP_H_
