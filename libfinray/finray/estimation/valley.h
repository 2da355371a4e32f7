#ifndef FINRAY_ESTIMATION_VALLEY_H_
#define FINRAY_ESTIMATION_VALLEY_H_

#include <optional>
#include <vector>

#include "finray/estimation/contact_solution.h"

namespace finray {

/// How far chi2 lets one contact move where its curvature at the minimum does
/// not tell: along a valley that is longer than the std says, or to another
/// place that explains the frame nearly as well.
///
/// The profile of chi2 is p(l) = min over f of chi2(l, f), reached at f(l).
/// With the minimum at (l_c, f_c), a place is d(l) std away,
///
///   d(l)^2 = p(l) - chi2(l_c, f_c) + 2 ln (f(l) / f_c).
///
/// The last term is evidence integrated over the neighbourhood of each place:
/// the std of l is proportional to 1 / f, so a heavy contact at the tip
/// explains a frame over a narrow range of places only. The std are at least
///
///   max |l - l_c| / s(l),   max |f(l) - f_c| / s(l),
///   s(l) = min(kSlack d(l), kMostStd)
///
/// over all places with d(l) < kFarthest, which noise reaches once in a million
/// frames. An ordinary valley is so straight that these are smaller than its
/// std.
struct Valley {
  /// These std over those of the minimum, 1 or more.
  double arc_factor, normal_factor;
  /// Where p(l) is less than 4 above the minimum: two std.
  double arc_low_mm, arc_high_mm, normal_low_N, normal_high_N;

  static constexpr double kFarthest = 5.3, kSlack = 1.25, kMostStd = 6;
  /// Evidence makes d(l)^2 smaller by this at most, ln 10^6.
  static constexpr double kMostEvidence = 13.82;
  /// Places with p(l) above the minimum by this times scale^2 do not count.
  static constexpr double kMostChi2 = kFarthest * kFarthest + kMostEvidence;
};

/// Compares a solution with the best contact at each place of a table
/// (GaugeTable::Profile). The std given are those of the minimum; `scale` is
/// the factor on the declared noise. Empty if they stand.
std::optional<Valley> FindValley(const std::vector<ContactStart>& profile,
                                 const ContactSolution& solution,
                                 double arc_std_mm, double normal_std_N,
                                 double scale, double length_mm);

}  // namespace finray

#endif  // FINRAY_ESTIMATION_VALLEY_H_
