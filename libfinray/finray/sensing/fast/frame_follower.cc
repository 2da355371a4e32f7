#include "finray/sensing/fast/frame_follower.h"

#include <algorithm>
#include <utility>

namespace finray {
namespace {

// Relative to l_0 and to the force. The remaining error is far below any
// gauge's noise.
constexpr double kTolerance = 2e-9;

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
                                          const Discretization& discretization,
                                          const ContactSearch& search) {
  ContactFit fit(finger, discretization);
  fit.set_most_force(search.most_force_N());
  return std::make_shared<const RivalMap>(
      search.table(), LeastWeights(finger, search.table()), &fit);
}

}  // namespace

bool FrameFollower::Serves(const Scene& scene) {
  return scene.contacts.value_or(1) == 1 && !scene.object_std_mm;
}

FrameFollower::FrameFollower(const Finger& finger, const Scene& scene,
                             const Discretization& discretization,
                             const ContactSearch& search,
                             std::shared_ptr<const RivalMap> rivals)
    : search_(search),
      gauges_(static_cast<int>(finger.gauges.size())),
      rivals_(rivals ? std::move(rivals)
                     : MapRivals(finger, discretization, search)),
      group_(FrameGroupFit::Make(finger, discretization,
                                 scene.friction_coefficient)) {
  group_->set_tolerance(kTolerance);
  group_->set_most_force(search.most_force_N());
  group_->set_surface(&search.surface());
}

bool FrameFollower::Start(const ContactSolution& solution, double arc_std_mm,
                          int gauges) {
  const PointContact& contact = solution.contacts[0];
  if (solution.count != 1 || gauges != gauges_ ||
      !rivals_->IsUnique(contact.arc_mm, arc_std_mm, contact.normal_N,
                         solution.chi2, kOtherPlaces)) {
    return false;
  }
  group_->Start(solution.state, contact);
  return true;
}

void FrameFollower::Fit(const PackedReadings* frames, std::size_t count) {
  if (fits_.size() < count) {
    fits_.resize(count);
    angles_rad_.resize(gauges_, static_cast<Eigen::Index>(count));
    weights_.resize(gauges_, static_cast<Eigen::Index>(count));
  }
  const auto columns = static_cast<Eigen::Index>(count);
  for (Eigen::Index i = 0; i < columns; ++i) {
    angles_rad_.col(i) = frames[i].values;
    weights_.col(i) = frames[i].weights;
  }
  group_->Fit(angles_rad_.leftCols(columns), weights_.leftCols(columns),
              fits_.data());
}

bool FrameFollower::IsCertain(std::size_t frame, double arc_std_mm,
                              double scale) const {
  const FrameFit& fit = fits_[frame];
  return fit.converged && !search_.OnBound(fit.arc_mm, fit.normal_N) &&
         rivals_->IsUnique(fit.arc_mm, arc_std_mm, fit.normal_N, fit.chi2,
                           kOtherPlaces * scale * scale);
}

}  // namespace finray
