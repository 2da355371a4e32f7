#ifndef FINRAY_FIT_CONTACT_STEP_H_
#define FINRAY_FIT_CONTACT_STEP_H_

#include <Eigen/Core>

#include "finray/fit/contact_covariance.h"

namespace finray {

// The rules by which fits move contacts to explain gauges: Gauss-Newton on x =
// (l_c / l_0, f_c / force unit) of each contact,
//
//   (A + B + D) dx = -g,    A = S' S,  g = S' r,
//
// with r the whitened residuals, S their slopes, B = sum_j r_j d2r_j/dx2 where
// it is known, and D a damping, within bounds of l_c and f_c.

using ContactVector =
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * kFittedContacts, 1>;

// A linearisation is of no use beyond this change of l_c, about a bay, in l_0.
constexpr double kLongestMove = 0.1;

struct ContactEquations {
  ContactMatrix normal;
  ContactVector gradient;
  double chi2;
  ContactMatrix curvature = {};  ///< B; empty if it is not known.
};

/// Updates B after a `step` from one linearisation to the next, by the secant
/// method of Dennis, Gay and Welsch (NL2SOL, ACM TOMS 7, 1981): B takes the
/// change of the slopes along the step, times the residuals behind it. `before`
/// and `behind` are S' r at both, `mixed` has the slopes before the step and
/// the residuals behind it. B begins with zero.
void UpdateCurvature(const ContactVector& step, const ContactVector& before,
                     const ContactVector& mixed, const ContactVector& behind,
                     ContactMatrix* curvature);

/// low <= x <= high; a component with equal bounds is held.
struct ContactBounds {
  ContactVector low, high;
};

/// Solves for the change dx from x, which is within the bounds. A component
/// that would pass a bound is set to the bound, and the others are solved
/// again. `damping` is Levenberg's.
ContactVector BoundedChange(const ContactEquations& equations,
                            const ContactVector& x, const ContactBounds& bounds,
                            double damping);

/// The share of a change of l_c to be taken with a change `by` of f_c. Small
/// angles are f phi(l); the linearised change (dl, df) is that of
/// (f + df) phi(l + dl f / (f + df)). Near the tip, where the gauges see little
/// but f (l_0 - l_c), the contact then moves along that hyperbola. 1 for small
/// `by`, so that the last steps are Newton's.
double ArcShare(double normal, double by);

/// The largest of the changes of l_c over l_0 and of f_c over its size.
double LargestChange(const ContactVector& change, const ContactVector& x);

}  // namespace finray

#endif  // FINRAY_FIT_CONTACT_STEP_H_
