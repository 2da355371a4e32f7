#ifndef FINRAY_SENSING_FAST_CONTACT_STEP_H_
#define FINRAY_SENSING_FAST_CONTACT_STEP_H_

#include <Eigen/Core>

#include "finray/ladder/ladder_frame.h"
#include "finray/sensing/contact_covariance.h"

namespace finray {

// The rules by which contacts are moved to explain gauges, common to ContactFit
// and FrameGroupFit: Gauss-Newton on x = (l_c / l_0, f_c / force unit) of each
// contact,
//
//   (A + D) dx = -g,    A = S' S,  g = S' r,
//
// r the whitened residuals, S their slopes, D a damping; within 0 <= l_c <= l_0
// and 0 <= f_c <= its bound.

using ContactVector =
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * kFittedContacts, 1>;

// Beyond these a linearisation says nothing: a bay, a quarter turn.
constexpr double kLongestMove = 0.1;  // of l_0
constexpr double kMaxTurn_rad = 0.7;
// A change that raises chi2 by this factor and by more than 1 is taken back.
// Less says little: before equilibrium is reached chi2 is known to first order
// only.
constexpr double kMostRise = 2;

struct ContactEquations {
  ContactMatrix normal;
  ContactVector gradient;
  double chi2;
};

/// The change dx from x. What would pass a bound (`most_force` in units of x)
/// stays at it and the rest is solved for anew. `damping` is Levenberg's.
ContactVector BoundedChange(const ContactEquations& equations,
                            const ContactVector& x, double most_force,
                            double damping);

/// The largest of the changes of l_c over l_0, f_c over its size, and `shape`,
/// that of positions over l_0 and angles.
double LargestChange(const ContactVector& change, const ContactVector& x,
                     double shape);

// When to stop. Near the end changes obey next = rho now + C now^2. C follows
// from the last two: Newton squares, so that C now is at most (now / before)^2.
// rho is due to what A + D has too much and what it leaves out, the curvature
// of the gauges,
//
//   rho = |(A + D)^-1 (D step - dS' r)| / |step|,
//
// r the residuals after the change and dS by how much the slopes differ from
// those of the linearisation before, which was `step` away. That is the rate
// along that step; others may be a few times as large (kDoubt).
constexpr double kDoubt = 4;
/// In place of a change before the first one.
constexpr double kUnknownChange = 1e-4;

/// rho; `by_residual` is dS' r.
double CurvatureRate(const ContactEquations& equations, double damping,
                     const ContactVector& by_residual,
                     const ContactVector& step, const ContactVector& x);

/// Whether the next change is expected below `tolerance`. Where the last one
/// took a contact to another element, the linearisation did not reach so far
/// and `now` itself counts.
bool IsLastChange(double now, double before, double rate, bool crossed,
                  double tolerance);

}  // namespace finray

#endif  // FINRAY_SENSING_FAST_CONTACT_STEP_H_
