#include "finray/statics/load_trail.h"

#include <algorithm>
#include <cmath>

namespace finray {
namespace {

// Larger weights lead far beyond the trail. A step as long as the last two has
// |w_1| + |w_2| = 3 + 1.
constexpr double kMostWeight = 6;
// A step at most this share of the one before counts as a correction of the
// load. Newton's method over loads takes such steps.
constexpr double kCorrection = 0.05;
// Nearer loads differ by rounding.
constexpr double kSameLoad = 1e-9;

}  // namespace

bool LoadTrail::SameKind(const std::vector<PointContact>& contacts,
                         Eigen::Index size) const {
  const std::vector<PointContact>& newest = points_[newest_].contacts;
  return points_[newest_].state.size() == size &&
         std::equal(contacts.begin(), contacts.end(), newest.begin(),
                    newest.end(),
                    [](const PointContact& a, const PointContact& b) {
                      return a.side == b.side && a.friction == b.friction;
                    });
}

void LoadTrail::Add(const std::vector<PointContact>& contacts,
                    const double* state, Eigen::Index size) {
  if (count_ > 0 && !SameKind(contacts, size)) count_ = 0;
  bool corrects = false;
  if (count_ == 0) {
    last_square_ = 0;
  } else if (const double square = Product(contacts, contacts); square > 0) {
    corrects = square <= std::max(kCorrection * kCorrection * last_square_,
                                  kSameLoad * kSameLoad);
    last_square_ = square;
  } else {
    corrects = true;  // the load comes again
  }
  if (!corrects) {
    newest_ = (newest_ + 1) % kPoints;
    count_ = std::min(count_ + 1, kPoints);
  }
  points_[newest_].contacts = contacts;
  points_[newest_].state = Eigen::Map<const Eigen::VectorXd>(state, size);
}

double LoadTrail::Product(const std::vector<PointContact>& a,
                          const std::vector<PointContact>& b) const {
  const std::vector<PointContact>& from = points_[newest_].contacts;
  double by_arc = 0, by_force = 0;
  for (std::size_t c = 0; c < from.size(); ++c) {
    by_arc += (a[c].arc_mm - from[c].arc_mm) * (b[c].arc_mm - from[c].arc_mm);
    by_force +=
        (a[c].normal_N - from[c].normal_N) * (b[c].normal_N - from[c].normal_N);
  }
  return by_arc / (length_mm_ * length_mm_) +
         by_force / (force_unit_N_ * force_unit_N_);
}

// The normal equations need products of the d only: those of the d d' are their
// squares.
bool LoadTrail::Predict(const std::vector<PointContact>& contacts,
                        double* state, Eigen::Index size) const {
  if (count_ < 2 || !SameKind(contacts, size)) return false;
  const Point& one = Before(1);
  const auto entry = [](double product) { return product * (1 + product); };
  const double a = entry(Product(one.contacts, one.contacts));
  const double right = entry(Product(one.contacts, contacts));
  double w1 = right / a, w2 = 0;
  if (count_ > 2) {
    const Point& two = Before(2);
    const double b = entry(Product(one.contacts, two.contacts));
    const double c = entry(Product(two.contacts, two.contacts));
    const double right2 = entry(Product(two.contacts, contacts));
    const double determinant = a * c - b * b;
    w1 = (c * right - b * right2) / determinant;
    w2 = (a * right2 - b * right) / determinant;
  }
  // Written so that a NaN of loads on one point fails.
  if (!(std::abs(w1) + std::abs(w2) <= kMostWeight)) return false;
  Eigen::Map<Eigen::VectorXd> z(state, size);
  z += w1 * (one.state - newest());
  if (w2 != 0) z += w2 * (Before(2).state - newest());
  return true;
}

}  // namespace finray
