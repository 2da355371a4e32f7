#ifndef FINRAY_SENSING_FAST_STEP_PACE_H_
#define FINRAY_SENSING_FAST_STEP_PACE_H_

#include <algorithm>
#include <cmath>

#include "finray/fit/contact_step.h"

namespace finray {

/// How far to go along a Gauss-Newton change. Where the data hardly determine
/// the contacts, Gauss-Newton creeps or goes to and fro for ever: each change
/// is q times the one before, along the same line. A change taken s_0-fold
/// leaves q = 1 - s_0 (1 - rho) of the next one, so that
///
///   s = s_0 / (1 - q)
///
/// leads to where it ends: the secant method along that line.
class StepPace {
 public:
  /// Forgets the change before.
  void Reset() { taken_ = 0; }

  /// Returns s for the change that follows those of the calls before; 1 where
  /// changes shrink fast or turn.
  double Of(const ContactVector& change, const ContactVector& x) {
    ContactVector now = change;
    for (int k = 1; k < x.size(); k += 2) now[k] /= x[k] + kSmallForce;
    double pace = 1;
    if (taken_ > 0) {
      const double along = now.dot(before_), before = before_.squaredNorm();
      const double q = along / before;
      if (along * along > kAligned * before * now.squaredNorm() &&
          std::abs(q) > kSlow) {
        const double most = kMostGain * taken_;
        pace = q < 1 ? std::min(taken_ / (1 - q), most) : most;
        pace =
            std::clamp(pace, kLeast,
                       std::max(1.0, kLongest / now.lpNorm<Eigen::Infinity>()));
      }
    }
    before_ = now;
    taken_ = pace;
    return pace;
  }

 private:
  // Squared cosine between two changes along one line, and the least |q| that
  // is worth a secant.
  static constexpr double kAligned = 0.9, kSlow = 0.3;
  static constexpr double kMostGain = 8, kLeast = 0.1;
  // No line is straight over more than this share of l_0 and of the force.
  static constexpr double kLongest = 0.02;

  ContactVector before_;
  double taken_ = 0;  // 0: no change before
};

}  // namespace finray

#endif  // FINRAY_SENSING_FAST_STEP_PACE_H_
