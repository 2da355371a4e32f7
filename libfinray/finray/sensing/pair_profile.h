#ifndef FINRAY_SENSING_PAIR_PROFILE_H_
#define FINRAY_SENSING_PAIR_PROFILE_H_

#include <array>
#include <vector>

#include "finray/sensing/contact_solution.h"
#include "finray/sensing/packed_readings.h"

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
  int count = 0;
};

/// Profiles a solution. `places` get both contacts and chi2 of each place; the
/// solver ends at any equilibrium. Each place takes one to four equilibria with
/// their derivatives. `most_force_N` is the bound of the forces.
PairProfile ProfilePair(const ContactSolution& solution,
                        const PackedReadings& packed, double friction,
                        double most_force_N, EquilibriumSolver* solver,
                        std::vector<ContactStart>* places);

/// How much larger the std of (l_c, f_c) of both contacts are than those of the
/// minimum, 1 or more each. A place with d(l)^2 = (p - chi2) / scale^2 is d
/// std away, as in valley.h, and the std are at least the distances of all
/// unknowns over 1.5 d, for d below 3.5: noise reaches farther in one frame of
/// 2000. `std` are those of the minimum.
std::array<double, 2 * kFittedContacts> PairFactors(
    const std::vector<ContactStart>& places, const ContactSolution& solution,
    const std::array<double, 2 * kFittedContacts>& std, double scale);

}  // namespace finray

#endif  // FINRAY_SENSING_PAIR_PROFILE_H_
