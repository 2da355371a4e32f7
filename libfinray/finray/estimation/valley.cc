#include "finray/estimation/valley.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

// The interval reaches to two std.
constexpr double kInterval = 2;
// Places nearer than this many std say nothing that the curvature does not.
constexpr double kNear = 2;
// A place that explains the frame as well or better counts as if it were this
// many std away.
constexpr double kLeastDistance = 0.5;
// The evidence of a place without force is that of this share of f_c,
// exp(-kMostEvidence / 2).
constexpr double kLightest = 1e-3;

}  // namespace

std::optional<Valley> FindValley(const std::vector<ContactStart>& profile,
                                 const ContactSolution& solution,
                                 double arc_std_mm, double normal_std_N,
                                 double scale, double length_mm) {
  const double arc = solution.contacts[0].arc_mm,
               normal = solution.contacts[0].normal_N;
  // Neither counts where the readings do not determine the contact at all.
  if (!std::isfinite(arc_std_mm) || !std::isfinite(normal_std_N)) {
    return std::nullopt;
  }
  const auto more_chi2 = [&](const ContactStart& place) {
    return std::max(0.0, place.chi2 - solution.chi2) / (scale * scale);
  };
  const double most_chi2 = solution.chi2 + scale * scale * Valley::kMostChi2;
  double arc_far_mm = arc_std_mm, normal_far_N = normal_std_N;
  for (const ContactStart& place : profile) {
    const PointContact& other = place.contacts[0];
    const double away = std::abs(other.arc_mm - arc);
    if (place.chi2 > most_chi2 || away < kNear * arc_std_mm) continue;
    const double more = more_chi2(place);
    const double evidence =
        2 * std::log(std::max(kLightest, other.normal_N / normal));
    const double distance =
        std::sqrt(std::max(kLeastDistance * kLeastDistance, more + evidence));
    if (!(distance < Valley::kFarthest)) continue;
    const double least = std::min(Valley::kSlack * distance, Valley::kMostStd);
    arc_far_mm = std::max(arc_far_mm, away / least);
    normal_far_N =
        std::max(normal_far_N, std::abs(other.normal_N - normal) / least);
  }
  if (arc_far_mm == arc_std_mm && normal_far_N == normal_std_N) {
    return std::nullopt;
  }
  Valley valley;
  valley.arc_factor = arc_far_mm / arc_std_mm;
  valley.normal_factor = normal_far_N / normal_std_N;

  // The interval: that of the minimum's std, the places within it, and up to
  // where it ends between two places.
  valley.arc_low_mm = std::max(0.0, arc - kInterval * arc_std_mm);
  valley.arc_high_mm = std::min(length_mm, arc + kInterval * arc_std_mm);
  valley.normal_low_N = std::max(0.0, normal - kInterval * normal_std_N);
  valley.normal_high_N = normal + kInterval * normal_std_N;
  const auto widen = [&valley](double arc_mm, double normal_N) {
    valley.arc_low_mm = std::min(valley.arc_low_mm, arc_mm);
    valley.arc_high_mm = std::max(valley.arc_high_mm, arc_mm);
    valley.normal_low_N = std::min(valley.normal_low_N, normal_N);
    valley.normal_high_N = std::max(valley.normal_high_N, normal_N);
  };
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const double inside = std::sqrt(more_chi2(profile[i]));
    if (!(inside < kInterval)) continue;
    const PointContact& from = profile[i].contacts[0];
    widen(from.arc_mm, from.normal_N);
    if (i == 0) widen(0, from.normal_N);
    if (i + 1 == profile.size()) widen(length_mm, from.normal_N);
    for (const std::size_t next : {i - 1, i + 1}) {
      if (next >= profile.size()) continue;
      const double outside = std::sqrt(more_chi2(profile[next]));
      if (!(outside >= kInterval) || std::isinf(outside)) continue;
      const PointContact& to = profile[next].contacts[0];
      const double share = (kInterval - inside) / (outside - inside);
      widen(from.arc_mm + share * (to.arc_mm - from.arc_mm),
            from.normal_N + share * (to.normal_N - from.normal_N));
    }
  }
  return valley;
}

}  // namespace finray
