#ifndef FINRAY_ESTIMATION_VALLEY_H_
#define FINRAY_ESTIMATION_VALLEY_H_

#include <array>
#include <optional>
#include <vector>

#include "finray/estimation/contact_solution.h"

namespace finray {

// The profile likelihood: how far chi2 lets contacts move where its curvature
// at the minimum does not tell, along a valley that is longer than the std says
// or to another place that explains the frame nearly as well.
//
// The profile of chi2 over the place l of a contact is p(l), the minimum over
// all other unknowns x, reached at x(l). With the minimum at x_c and forces f,
// a place is d(l) std away,
//
//   d(l)^2 = (p(l) - chi2(x_c)) / scale^2 + 2 sum over contacts ln (f(l) /
//   f_c).
//
// The last term is evidence integrated over the neighbourhood of each place:
// the std of l is proportional to 1 / f, so a heavy contact at the tip explains
// a frame over a narrow range of places only. The std are at least
//
//   max |x(l) - x_c| / s(l),   s(l) = min(slack d(l), most_std)
//
// over all places with d(l) < farthest. An ordinary valley is so straight that
// these are smaller than its std.

struct ProfileRule {
  double farthest, slack, most_std;
  /// Places whose first contact is nearer, in std of its place, do not count.
  double near_std;
};
/// Noise reaches farther than 5.3 std once in a million frames, and farther
/// than 3.5 std once in 2000.
constexpr ProfileRule kOneContactRule{5.3, 1.25, 6, 2};
constexpr ProfileRule kTwoContactsRule{3.5, 1.5, 1e9, 0};

/// The std of (l_c, f_c) of each contact.
using ContactsStd = std::array<double, 2 * kFittedContacts>;

/// Returns the std that the places of a profile demand, those of the minimum or
/// more. `scale` is the factor on the declared noise.
ContactsStd ProfiledStd(const std::vector<ContactStart>& places,
                        const ContactSolution& solution, const ContactsStd& std,
                        double scale, const ProfileRule& rule);

/// The std and intervals of one contact by its profile.
struct Valley {
  /// ProfiledStd over those of the minimum, 1 or more.
  double arc_factor, normal_factor;
  /// Where p(l) is less than 4 above the minimum: two std.
  double arc_low_mm, arc_high_mm, normal_low_N, normal_high_N;

  /// Evidence makes d(l)^2 smaller by this at most, ln 10^6.
  static constexpr double kMostEvidence = 13.82;
  /// Places with p(l) above the minimum by this times scale^2 do not count.
  static constexpr double kMostChi2 =
      kOneContactRule.farthest * kOneContactRule.farthest + kMostEvidence;
};

/// Compares a solution with the best contact at each place of a table
/// (GaugeTable::Profile). `std` are those of the minimum. Empty if they stand.
std::optional<Valley> FindValley(const std::vector<ContactStart>& profile,
                                 const ContactSolution& solution,
                                 const ContactsStd& std, double scale,
                                 double length_mm);

}  // namespace finray

#endif  // FINRAY_ESTIMATION_VALLEY_H_
