// The part of ContactSearch that looks for minima which the profile of the
// table's rows does not show.

#include <algorithm>
#include <cmath>

#include "finray/estimation/contact_search.h"

namespace finray {
namespace {

// A row of the table hides a minimum if its chi2 is below this fraction of what
// the solutions found expect there.
constexpr double kHides = 0.5;
// So many std from one row to the next hide a minimum of any finger.
constexpr double kSharp = 30;

// Says whether neither neighbour of a row explains the frame better.
bool IsLowest(const std::vector<ContactStart>& profile, std::size_t i) {
  return (i == 0 || profile[i].chi2 <= profile[i - 1].chi2) &&
         (i + 1 == profile.size() || profile[i].chi2 <= profile[i + 1].chi2);
}

// Says whether the distance to the readings, in std, may change by `rise` or
// more from a row to a neighbour. It does not while all three are nearer.
bool MayRise(const std::vector<ContactStart>& profile, std::size_t i,
             double rise) {
  const double least = rise * rise;
  return profile[i].chi2 >= least || (i > 0 && profile[i - 1].chi2 >= least) ||
         (i + 1 < profile.size() && profile[i + 1].chi2 >= least);
}

bool IsLoaded(const ContactStart& row) {
  return row.state != nullptr && row.contacts[0].normal_N > 0;
}

}  // namespace

// Minima lie close together where a finger is upright or has many ribs, and the
// table may rank them wrongly where the noise is less than its own error.
void ContactSearch::SearchRows(bool close) {
  const auto may_lead_on = [&](std::size_t i) {
    return close
               ? IsBeside(i) || Hides(i, 0)
               : MayRise(profile_, i, kSharp) &&
                     (IsBeside(i) || IsLowest(profile_, i)) && Hides(i, kSharp);
  };
  while (!found_.full()) {
    std::size_t next = profile_.size();
    for (std::size_t i = 0; i < profile_.size(); ++i) {
      if (next < profile_.size() && profile_[i].chi2 >= profile_[next].chi2)
        continue;
      if (profile_[i].count > 0 && may_lead_on(i)) {
        next = i;
      }
    }
    if (next == profile_.size() || !budget_.MayGoOn()) return;
    TryFit(profile_[next]);
    profile_[next].count = 0;  // tried
  }
}

// Two minima may lie between the same two rows.
void ContactSearch::SearchBeside() {
  // The best one may be another one after the first fit.
  const PointContact from = found_.best().contacts[0];
  const ContactMatrix a = found_.best().information;
  for (const double rows : {-1.0, -0.5, 0.5, 1.0}) {
    if (found_.full() || !budget_.MayGoOn()) return;
    ContactStart start;
    start.count = 1;
    start.contacts[0] = from;
    const double apart = rows * table().row_spacing_mm();
    start.contacts[0].arc_mm =
        std::clamp(from.arc_mm + apart, 0.0, tables_->finger().front_length_mm);
    start.contacts[0].normal_N = std::clamp(
        from.normal_N - a(0, 1) / a(1, 1) * apart, 0.0, most_force_N());
    start.state = &table().StateNear(start.contacts[0].arc_mm,
                                     start.contacts[0].normal_N);
    TryFit(start);
  }
}

// Two minima may lie at one row, and its profile shows the force of one only.
void ContactSearch::SearchForces(const PackedReadings& packed) {
  const double arc_mm = best().contacts[0].arc_mm;
  for (std::size_t i = 0; i < profile_.size(); ++i) {
    const GaugeTable::Row& row = table().rows()[i];
    if (!IsLoaded(profile_[i]) ||
        std::abs(row.arc_mm - arc_mm) > 2 * table().row_spacing_mm()) {
      continue;
    }
    const auto chi2 = [&](std::size_t k) {
      return (packed.weights.array() *
              (row.nodes[k].values - packed.values).array())
          .matrix()
          .squaredNorm();
    };
    const double shown_N = profile_[i].contacts[0].normal_N;
    for (std::size_t k = 1; k < row.nodes.size(); ++k) {
      const bool last = k + 1 == row.nodes.size();
      const bool shown = shown_N >= row.nodes[k - 1].normal_N &&
                         (last || shown_N <= row.nodes[k + 1].normal_N);
      if (shown || chi2(k) > chi2(k - 1) || (!last && chi2(k) > chi2(k + 1))) {
        continue;
      }
      if (found_.full() || !budget_.MayGoOn()) return;
      ContactStart start;
      start.count = 1;
      start.contacts[0] = {row.arc_mm, row.nodes[k].normal_N,
                           table().friction()};
      start.state = &row.nodes[k].state;
      TryFit(start);
    }
  }
}

// Another minimum may be nearer to a solution than the rows are to each other.
bool ContactSearch::IsBeside(std::size_t i) const {
  return IsLoaded(profile_[i]) &&
         found_.IsWithin(table().row_spacing_mm(),
                         profile_[i].contacts[0].arc_mm);
}

bool ContactSearch::Hides(std::size_t i, double least_rise) const {
  const ContactStart& row = profile_[i];
  if (!IsLoaded(row)) return false;
  const double distance = std::sqrt(row.chi2);
  const double at_row = std::max(0.0, distance - row.error);
  if (at_row * at_row > kHides * found_.ExpectedChi2(row.contacts[0].arc_mm)) {
    return false;
  }
  // Towards a minimum between two rows the distance falls by no more than it
  // rises on the other side.
  double rise = 0;
  if (i > 0) rise = std::abs(distance - std::sqrt(profile_[i - 1].chi2));
  if (i + 1 < profile_.size()) {
    rise = std::max(rise, std::abs(distance - std::sqrt(profile_[i + 1].chi2)));
  }
  if (rise < least_rise) return false;
  const double between = std::max(0.0, at_row - rise);
  return between * between < found_.least_chi2() + kWithinNoise;
}

}  // namespace finray
