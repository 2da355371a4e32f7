#include "finray/estimation/valley.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

// The interval reaches to two std.
constexpr double kInterval = 2;
// A place that explains the frame as well or better counts as if it were this
// many std away.
constexpr double kLeastDistance = 0.5;
// The evidence of a place without force is that of this share of f_c,
// exp(-kMostEvidence / 2).
constexpr double kLightest = 1e-3;

}  // namespace

ContactsStd ProfiledStd(const std::vector<ContactStart>& places,
                        const ContactSolution& solution, const ContactsStd& std,
                        double scale, const ProfileRule& rule) {
  ContactsStd far = std;
  // No evidence makes a place nearer that is farther than this.
  const double most_chi2 =
      solution.chi2 + scale * scale *
                          (rule.farthest * rule.farthest +
                           solution.count * Valley::kMostEvidence);
  for (const ContactStart& place : places) {
    const double away =
        std::abs(place.contacts[0].arc_mm - solution.contacts[0].arc_mm);
    if (place.chi2 > most_chi2 || away < rule.near_std * std[0]) continue;
    double distance2 =
        std::max(0.0, place.chi2 - solution.chi2) / (scale * scale);
    for (int c = 0; c < solution.count; ++c) {
      distance2 +=
          2 * std::log(std::max(kLightest, place.contacts[c].normal_N /
                                               solution.contacts[c].normal_N));
    }
    const double distance =
        std::sqrt(std::max(kLeastDistance * kLeastDistance, distance2));
    if (!(distance < rule.farthest)) continue;
    const double least = std::min(rule.slack * distance, rule.most_std);
    for (int c = 0; c < solution.count; ++c) {
      const PointContact &at = place.contacts[c], &of = solution.contacts[c];
      const double apart[] = {at.arc_mm - of.arc_mm, at.normal_N - of.normal_N};
      for (int i = 0; i < 2; ++i) {
        far[2 * c + i] = std::max(far[2 * c + i], std::abs(apart[i]) / least);
      }
    }
  }
  return far;
}

std::optional<Valley> FindValley(const std::vector<ContactStart>& profile,
                                 const ContactSolution& solution,
                                 const ContactsStd& std, double scale,
                                 double length_mm) {
  const double arc = solution.contacts[0].arc_mm,
               normal = solution.contacts[0].normal_N;
  const double arc_std_mm = std[0], normal_std_N = std[1];
  // Neither counts where the readings do not determine the contact at all.
  if (!std::isfinite(arc_std_mm) || !std::isfinite(normal_std_N)) {
    return std::nullopt;
  }
  const ContactsStd far =
      ProfiledStd(profile, solution, std, scale, kOneContactRule);
  if (far[0] == arc_std_mm && far[1] == normal_std_N) return std::nullopt;
  Valley valley;
  valley.arc_factor = far[0] / arc_std_mm;
  valley.normal_factor = far[1] / normal_std_N;
  const auto more_chi2 = [&](const ContactStart& place) {
    return std::max(0.0, place.chi2 - solution.chi2) / (scale * scale);
  };

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
