#include "finray/sensing/contact_search.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

// A second start is only worth its time while the best leaves more than this
// per measurement unexplained, or if it might lead to a rival: the table knows
// chi2 to a factor.
constexpr double kWellExplained = 4;
constexpr double kTableFactor = 0.25;
constexpr std::size_t kMostStarts = 4, kMostPairStarts = 8;
// A rival lies outside the region that holds 99 % of the estimates: chi2 of two
// and of four parameters.
constexpr double kDistinct[] = {9.21, 13.28};

std::optional<double> MeasuredRadius(const Scene& scene) {
  return scene.object_std_mm ? scene.circle_radius_mm() : std::nullopt;
}

}  // namespace

ContactSearch::ContactSearch(const Finger& finger, const Scene& scene,
                             const Discretization& discretization)
    : scene_(scene),
      length_mm_(finger.front_length_mm),
      solver_(finger, discretization),
      table_(&solver_, scene.friction_coefficient, MeasuredRadius(scene)),
      fit_(finger, discretization, MeasuredRadius(scene)),
      solutions_(kMostPairStarts) {
  fit_.set_most_force(kMostForce * table_.heaviest_N());
  solver_.Solve({});
  for (ContactSolution& solution : solutions_) {
    solution.rib_tension_N.resize(finger.ribs.size());
  }
}

bool ContactSearch::Search(int contacts, const Eigen::VectorXd& measured,
                           const Eigen::VectorXd& weights) {
  FindStarts(contacts, measured, weights);
  const double well =
      kWellExplained * static_cast<double>((weights.array() > 0).count());
  found_ = iterations_ = 0;
  for (const ContactStart& start : starts_) {
    if (found_ > 0) {
      const double least = solutions_[best_].chi2;
      const bool may_be_rival =
          kTableFactor * start.chi2 < least + kWithinNoise;
      if (least < well && !may_be_rival) break;
    }
    if (!FitFrom(start, measured, weights)) continue;
    if (found_ == 0 || solutions_[found_].chi2 < solutions_[best_].chi2) {
      best_ = found_;
    }
    ++found_;
  }
  return found_ > 0;
}

void ContactSearch::FindStarts(int contacts, const Eigen::VectorXd& measured,
                               const Eigen::VectorXd& weights) {
  if (contacts == 1) {
    table_.FindStarts(measured, weights, &starts_);
    if (starts_.size() > kMostStarts) starts_.resize(kMostStarts);
    return;
  }
  if (!pair_table_) {
    pair_table_ =
        std::make_unique<PairTable>(&solver_, scene_.friction_coefficient);
    solver_.Solve({});
  }
  pair_table_->FindStarts(measured, weights, kMostPairStarts, &starts_);
}

bool ContactSearch::FitFrom(const ContactStart& start,
                            const Eigen::VectorXd& measured,
                            const Eigen::VectorXd& weights) {
  contacts_.assign(start.contacts.begin(),
                   start.contacts.begin() + start.count);
  fit_.set_state(*start.state);
  const bool converged = fit_.Fit(measured, weights, &contacts_);
  iterations_ += fit_.iterations();
  if (!converged) return false;
  ContactSolution& solution = solutions_[found_];
  solution.count = start.count;
  solution.chi2 = fit_.chi2();
  solution.information = fit_.information();
  solution.tip_pose = fit_.tip_pose();
  for (std::size_t i = 0; i < solution.rib_tension_N.size(); ++i) {
    solution.rib_tension_N[i] = fit_.rib_tension(static_cast<int>(i));
  }
  const bool swapped =
      start.count == 2 && contacts_[1].arc_mm < contacts_[0].arc_mm;
  for (int c = 0; c < start.count; ++c) {
    const int from = swapped ? 1 - c : c;
    solution.contacts[c] = contacts_[from];
    solution.poses[c] = fit_.contact_pose(from);
  }
  if (swapped) {
    const ContactMatrix was = solution.information;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        solution.information(i, j) = was((i + 2) % 4, (j + 2) % 4);
      }
    }
  }
  return true;
}

bool ContactSearch::IsDistinct(const ContactSolution& other) const {
  const ContactSolution& one = best();
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * kFittedContacts, 1> apart(
      2 * one.count);
  for (int c = 0; c < one.count; ++c) {
    apart[2 * c] = other.contacts[c].arc_mm - one.contacts[c].arc_mm;
    apart[2 * c + 1] = other.contacts[c].normal_N - one.contacts[c].normal_N;
  }
  return apart.dot(one.information * apart) > kDistinct[one.count - 1];
}

const ContactSolution* ContactSearch::rival() const {
  const ContactSolution* rival = nullptr;
  for (int i = 0; i < found_; ++i) {
    const ContactSolution& other = solutions_[i];
    if (i == best_ || other.chi2 > best().chi2 + kWithinNoise) continue;
    if (!IsDistinct(other)) continue;
    if (rival == nullptr || other.chi2 < rival->chi2) rival = &other;
  }
  return rival;
}

bool ContactSearch::OnBound(const PointContact& contact) const {
  return contact.arc_mm <= 0 || contact.arc_mm >= length_mm_ ||
         contact.normal_N >= kMostForce * table_.heaviest_N();
}

}  // namespace finray
