#ifndef FINRAY_SENSING_CONTACT_STEP_H_
#define FINRAY_SENSING_CONTACT_STEP_H_

#include <Eigen/Core>

#include "finray/sensing/contact_covariance.h"
#include "finray/statics/ladder_frame.h"

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

/// In place of a change before the first one: of how fast changes shrink
/// nothing is known but that Newton squares them, with some constant.
constexpr double kUnknownChange = 1e-4;

/// Whether the next change is expected below `tolerance` after changes `before`
/// and then `now`: their ratio at least is what the next one shrinks by. Where
/// the last one took a contact to another element, the linearisation did not
/// reach so far and `now` itself counts.
bool IsLastChange(double now, double before, bool crossed, double tolerance);

}  // namespace finray

#endif  // FINRAY_SENSING_CONTACT_STEP_H_
