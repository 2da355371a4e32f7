#ifndef FINRAY_ESTIMATION_PAIR_PROFILE_H_
#define FINRAY_ESTIMATION_PAIR_PROFILE_H_

#include <array>
#include <vector>

#include "finray/estimation/contact_solution.h"
#include "finray/estimation/packed_readings.h"

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
  /// `most_force_N` is the bound of the forces.
  PairProfile(const EquilibriumSolver& solver, double most_force_N)
      : solver_(solver), most_force_N_(most_force_N) {}

  /// Profiles a solution from its equilibrium. `places` get both contacts and
  /// chi2 of each place. Each of them takes one to four equilibria with their
  /// derivatives, all together at most `most_iterations`. Contacts do not pass
  /// each other.
  void Profile(const ContactSolution& solution, const PackedReadings& packed,
               double friction, int most_iterations,
               std::vector<ContactStart>* places);

  // Of the last profile:

  /// Beginnings of fits: places where p has a minimum of its own.
  int count() const { return count_; }
  const ContactStart& minimum(int i) const { return minima_[i]; }
  /// The number of equilibria.
  int iterations() const { return iterations_; }
  /// The bound of that number has ended the profile.
  bool ended() const { return ended_; }

  const Finger& finger() const { return solver_.model().finger(); }
  /// The solver of the finger, at any equilibrium.
  EquilibriumSolver* solver() { return &solver_; }

 private:
  class Walk;
  static constexpr int kMostMinima = 8;
  EquilibriumSolver solver_;
  double most_force_N_;
  std::array<ContactStart, kMostMinima> minima_;
  std::array<LadderState, kMostMinima> states_;  // theirs
  int count_ = 0, iterations_ = 0;
  bool ended_ = false;
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_PAIR_PROFILE_H_
