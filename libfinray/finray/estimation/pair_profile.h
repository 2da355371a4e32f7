#ifndef FINRAY_ESTIMATION_PAIR_PROFILE_H_
#define FINRAY_ESTIMATION_PAIR_PROFILE_H_

#include <array>
#include <vector>

#include "finray/estimation/contact_solution.h"
#include "finray/estimation/packed_readings.h"

namespace finray {

/// The profile of chi2 over the place of each of two contacts, with the other
/// three unknowns refitted,
///
///   p_c(l) = min over the others of chi2,  l = l_1 or l_2.
///
/// Past the last rib and before the first one chi2 has curved valleys and
/// minima side by side, of which neither the curvature at one of them nor the
/// coarse table of pairs tells. A contact near either end is profiled to that
/// end, one whose std is large over a bay and more on either side, and others
/// not at all: their minimum is alone in its bay.
struct PairProfile {
  /// Beginnings of fits: places where p has a minimum of its own.
  static constexpr int kMostMinima = 8;
  std::array<ContactStart, kMostMinima> minima;
  std::array<LadderState, kMostMinima> states;  ///< Theirs.
  int count = 0;
  /// The number of equilibria.
  int iterations = 0;
  /// The bound of that number has ended the profile.
  bool ended = false;
};

/// Profiles a solution from its equilibrium. `places` get both contacts and
/// chi2 of each place; the solver ends at any equilibrium, and looks for
/// equilibria near the last one only. Each place takes one to four of them with
/// their derivatives, all together at most `most_iterations`. `most_force_N` is
/// the bound of the forces. Contacts do not pass each other.
void ProfilePair(const ContactSolution& solution, const PackedReadings& packed,
                 double friction, double most_force_N, int most_iterations,
                 EquilibriumSolver* solver, PairProfile* profile,
                 std::vector<ContactStart>* places);

}  // namespace finray

#endif  // FINRAY_ESTIMATION_PAIR_PROFILE_H_
