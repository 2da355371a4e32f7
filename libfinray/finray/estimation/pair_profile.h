#ifndef FINRAY_ESTIMATION_PAIR_PROFILE_H_
#define FINRAY_ESTIMATION_PAIR_PROFILE_H_

#include <array>
#include <vector>

#include "finray/estimation/contact_solution.h"
#include "finray/estimation/row_fit.h"

namespace finray {

/// Computes the profile of chi2 over the place of each of two contacts, with
/// the other three unknowns refitted,
///
///   p_c(l) = min over the others of chi2,  l = l_1 or l_2.
///
/// Past the last rib and before the first one chi2 has curved valleys and
/// minima side by side, of which neither the curvature at one of them nor the
/// coarse table of pairs tells. A contact near either end is profiled to that
/// end, one whose std is large over a bay and more on either side, and others
/// not at all: their minimum is alone in its bay.
class PairProfile {
 public:
  /// Profiles a solution for the row of `fit`, from its equilibrium. `places`
  /// get both contacts and chi2 of each place. Each of them takes one to four
  /// equilibria with their derivatives, all together at most `most_iterations`.
  /// Contacts do not pass each other.
  void Profile(const ContactSolution& solution, int most_iterations,
               RowFit* fit, std::vector<ContactStart>* places);

  // Results of the last call of Profile():

  /// Beginnings of fits: places where p has a minimum of its own.
  int count() const { return count_; }
  const ContactStart& minimum(int i) const { return minima_[i]; }
  /// The number of equilibria.
  int iterations() const { return iterations_; }
  /// The bound of that number has ended the profile.
  bool ended() const { return ended_; }

 private:
  class Walk;
  static constexpr int kMostMinima = 8;
  std::array<ContactStart, kMostMinima> minima_;
  std::array<LadderState, kMostMinima> states_;  // theirs
  int count_ = 0, iterations_ = 0;
  bool ended_ = false;
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_PAIR_PROFILE_H_
