#include "finray/sensing/fast/frame_follower.h"

#include <algorithm>
#include <utility>

namespace finray {
namespace {

// A frame is searched if another place may have a chi2 that is larger by less
// than this. The map's margins reach to Valley::kFarthest then (ramp_study).
constexpr double kOtherPlaces = 17;

// Returns the least weight that each gauge has at any angle of the table: with
// a curve, weights differ, and smaller ones let more places be rivals.
Eigen::VectorXd LeastWeights(const Finger& finger, const GaugeTable& table) {
  const auto gauges = static_cast<Eigen::Index>(finger.gauges.size());
  Eigen::VectorXd weights(gauges);
  for (Eigen::Index j = 0; j < gauges; ++j) {
    const Gauge& gauge = finger.gauges[j];
    weights[j] = gauge.AngleWeight();
    if (!gauge.IsCurved()) continue;
    for (const GaugeTable::Row& row : table.rows()) {
      for (const GaugeTable::Node& node : row.nodes) {
        weights[j] = std::min(weights[j], gauge.AngleWeight(node.values[j]));
      }
    }
  }
  return weights;
}

std::shared_ptr<const RivalMap> MapRivals(const Finger& finger,
                                          const ContactSearch& search) {
  return std::make_shared<const RivalMap>(search.table(), search.surface(),
                                          LeastWeights(finger, search.table()),
                                          search.most_force_N());
}

}  // namespace

bool FrameFollower::Serves(const Scene& scene) {
  return scene.contacts.value_or(1) == 1 && !scene.object_std_mm;
}

FrameFollower::FrameFollower(const Finger& finger, const ContactSearch& search,
                             std::shared_ptr<const RivalMap> rivals)
    : search_(search),
      gauges_(static_cast<int>(finger.gauges.size())),
      rivals_(rivals ? std::move(rivals) : MapRivals(finger, search)) {}

bool FrameFollower::Start(const ContactSolution& solution, double arc_std_mm,
                          int gauges) {
  const PointContact& contact = solution.contacts[0];
  if (solution.count != 1 || gauges != gauges_ ||
      !rivals_->IsUnique(contact.arc_mm, arc_std_mm, contact.normal_N,
                         solution.chi2, kOtherPlaces)) {
    return false;
  }
  last_ = contact;
  return true;
}

void FrameFollower::Fit(const PackedReadings* frames, std::size_t count) {
  if (fits_.size() < count) fits_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    ContactSolution& fit = fits_[i];
    if (search_.surface().Fit(frames[i].values, frames[i].weights,
                              search_.most_force_N(), last_, &fit)) {
      last_ = fit.contacts[0];
    } else {
      fit.count = 0;
    }
  }
}

bool FrameFollower::IsCertain(std::size_t frame, double arc_std_mm,
                              double scale) const {
  const ContactSolution& fit = fits_[frame];
  const PointContact& contact = fit.contacts[0];
  return fit.count == 1 && !search_.OnBound(contact.arc_mm, contact.normal_N) &&
         rivals_->IsUnique(contact.arc_mm, arc_std_mm, contact.normal_N,
                           fit.chi2, kOtherPlaces * scale * scale);
}

}  // namespace finray
