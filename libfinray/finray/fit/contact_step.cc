#include "finray/fit/contact_step.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

// Damping of l_c, equal to a prior of 30 mm about its present place. It keeps a
// contact without force from wandering. It is scaled by min(1, chi2), so that
// convergence on noise-free data stays quadratic. Where B is known, A + B is
// the Hessian of chi2 and positive, and damping would only slow the fit down.
constexpr double kArcDamping = 22;
constexpr double kForceDamping = 1e-9;
// A force counts as at least this large when its changes are compared.
constexpr double kSmallForce = 0.02;
// A bound is met or left at most so often for each component.
constexpr int kMostPasses = 4;

// A + B + D
ContactMatrix Damped(const ContactEquations& equations, double damping) {
  const double unexplained = std::min(1.0, equations.chi2);
  ContactMatrix system = equations.normal;
  const bool free = equations.curvature.size() > 0;
  if (free) system += equations.curvature;
  for (Eigen::Index k = 0; k < system.rows(); ++k) {
    system(k, k) *= 1 + damping;
    system(k, k) +=
        kForceDamping + (!free && k % 2 == 0 ? kArcDamping * unexplained : 0);
  }
  return system;
}

// Solves a x = b in place for a symmetric positive `a`, by L D L'.
void SolvePositive(ContactMatrix* a, ContactVector* b) {
  ContactMatrix& l = *a;
  ContactVector& x = *b;
  const int n = static_cast<int>(x.size());
  if (n == 2) {
    const double inverse = 1 / (l(0, 0) * l(1, 1) - l(1, 0) * l(1, 0));
    const double first = x[0];
    x[0] = (l(1, 1) * first - l(1, 0) * x[1]) * inverse;
    x[1] = (l(0, 0) * x[1] - l(1, 0) * first) * inverse;
    return;
  }
  for (int j = 0; j < n; ++j) {
    const double pivot = 1 / l(j, j);
    for (int i = j + 1; i < n; ++i) {
      const double factor = l(i, j) * pivot;
      for (int k = j + 1; k <= i; ++k) l(i, k) -= factor * l(k, j);
      x[i] -= factor * x[j];
    }
  }
  for (int j = n - 1; j >= 0; --j) {
    for (int i = j + 1; i < n; ++i) x[j] -= l(i, j) * x[i];
    x[j] /= l(j, j);
  }
}

}  // namespace

void UpdateCurvature(const ContactVector& step, const ContactVector& before,
                     const ContactVector& mixed, const ContactVector& behind,
                     ContactMatrix* curvature) {
  constexpr int kMost = 2 * kFittedContacts;
  const int n = static_cast<int>(step.size());
  ContactMatrix& b = *curvature;
  double known[kMost] = {}, change[kMost] = {}, off[kMost] = {};
  double along = 0, told = 0, bent = 0;
  for (int k = 0; k < n; ++k) {
    for (int l = 0; l < n; ++l) known[k] += b(k, l) * step[l];
    change[k] = behind[k] - before[k];
    along += change[k] * step[k];
    told += known[k] * step[k];
    bent += (behind[k] - mixed[k]) * step[k];
  }
  if (!(along > 0)) return;
  // B is proportional to the residuals, so the old one shrinks as they do.
  const double size =
      told == 0 ? 0 : std::min(1.0, std::abs(bent) / std::abs(told));
  double missed = 0;
  for (int k = 0; k < n; ++k) {
    off[k] = behind[k] - mixed[k] - size * known[k];
    missed += off[k] * step[k];
  }
  for (int k = 0; k < n; ++k) {
    for (int l = 0; l < n; ++l) {
      b(k, l) = size * b(k, l) +
                (off[k] * change[l] + change[k] * off[l]) / along -
                missed * change[k] * change[l] / (along * along);
    }
  }
}

// The primal active-set method for a convex quadratic in a box: goes towards
// the least squares of the free components until the first of them meets its
// bound, and lets a bound go that the gradient leaves.
ContactVector BoundedChange(const ContactEquations& equations,
                            const ContactVector& x, const ContactBounds& bounds,
                            double damping) {
  const int unknowns = static_cast<int>(x.size());
  const ContactMatrix system = Damped(equations, damping);
  ContactVector change = ContactVector::Zero(unknowns);
  ContactVector low = bounds.low - x, high = bounds.high - x;
  bool fixed[2 * kFittedContacts] = {}, held[2 * kFittedContacts] = {};
  for (int k = 0; k < unknowns; ++k) {
    held[k] = fixed[k] = bounds.low[k] == bounds.high[k];
    if (k % 2 != 0) continue;
    low[k] = std::max(low[k], -kLongestMove);
    high[k] = std::min(high[k], kLongestMove);
  }
  for (int pass = 0; pass < kMostPasses * unknowns; ++pass) {
    ContactMatrix free = system;
    ContactVector target = -equations.gradient;
    for (int k = 0; k < unknowns; ++k) {
      if (fixed[k]) target -= system.col(k) * change[k];
    }
    for (int k = 0; k < unknowns; ++k) {
      if (!fixed[k]) continue;
      free.row(k).setZero();
      free.col(k).setZero();
      free(k, k) = 1;
      target[k] = change[k];
    }
    SolvePositive(&free, &target);
    double share = 1;
    int met = -1;
    for (int k = 0; k < unknowns; ++k) {
      const double bound = std::clamp(target[k], low[k], high[k]);
      if (fixed[k] || bound == target[k]) continue;
      const double to_bound = (bound - change[k]) / (target[k] - change[k]);
      if (met >= 0 && !(to_bound < share)) continue;
      share = to_bound;
      met = k;
    }
    change += share * (target - change);
    if (met >= 0) {
      change[met] = std::clamp(target[met], low[met], high[met]);
      fixed[met] = true;
      continue;
    }
    if (std::count(fixed, fixed + unknowns, true) == 0) break;
    const ContactVector slope = equations.gradient + system * change;
    int left = -1;
    for (int k = 0; k < unknowns; ++k) {
      if (fixed[k] && !held[k] &&
          (change[k] == low[k] ? slope[k] < 0 : slope[k] > 0)) {
        left = k;
      }
    }
    if (left < 0) break;
    fixed[left] = false;
  }
  return change;
}

double ArcShare(double normal, double by) {
  constexpr double kSmall = 0.1, kMost = 2;
  if (std::abs(by) < kSmall * normal) return 1;
  return normal > 0 ? normal / std::max(normal / kMost, normal + by) : 1;
}

double LargestChange(const ContactVector& change, const ContactVector& x) {
  double largest = 0;
  for (int k = 0; k < change.size(); ++k) {
    const double unit = k % 2 == 0 ? 1 : x[k] + kSmallForce;
    largest = std::max(largest, std::abs(change[k]) / unit);
  }
  return largest;
}

}  // namespace finray
