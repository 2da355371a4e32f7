#include "finray/estimation/found_solutions.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace finray {
namespace {

constexpr double kSame = 0.01;  // chi2 between fits of one minimum
constexpr double kTie = 1e-6;   // chi2 that says nothing
// A rival lies outside the region that holds 99 % of the estimates. These are
// the quantiles of chi-squared for two and for four parameters.
constexpr double kDistinct[] = {9.21, 13.28};
// Fits of one minimum end this close to each other, in l_0 and f_c, however
// small the std.
constexpr double kRounding = 1e-10;

using ContactDifference =
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * kFittedContacts, 1>;

ContactDifference Apart(const ContactSolution& one,
                        const ContactSolution& other) {
  ContactDifference apart(2 * one.count);
  for (int c = 0; c < one.count; ++c) {
    apart[2 * c] = other.contacts[c].arc_mm - one.contacts[c].arc_mm;
    apart[2 * c + 1] = other.contacts[c].normal_N - one.contacts[c].normal_N;
  }
  return apart;
}

}  // namespace

FoundSolutions::FoundSolutions(const Finger& finger, double most_force_N)
    : length_mm_(finger.front_length_mm),
      most_force_N_(most_force_N),
      solutions_(kMost) {
  for (ContactSolution& solution : solutions_) {
    solution.rib_tension_N.resize(finger.ribs.size());
  }
}

void FoundSolutions::Sort(ContactSolution* solution) const {
  if (solution->count < 2 ||
      solution->contacts[0].arc_mm <= solution->contacts[1].arc_mm) {
    return;
  }
  std::swap(solution->contacts[0], solution->contacts[1]);
  std::swap(solution->poses[0], solution->poses[1]);
  const ContactMatrix was = solution->information;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      solution->information(i, j) = was((i + 2) % 4, (j + 2) % 4);
    }
  }
}

void FoundSolutions::Keep() {
  Sort(&next());
  int at = 0;
  while (at < count_ && !IsSame(solutions_[at], next())) ++at;
  if (at == count_) {
    ++count_;
  } else if (next().chi2 < solutions_[at].chi2) {
    std::swap(solutions_[at], next());
  }
  if (count_ == 1 || IsBetter(solutions_[at])) best_ = at;
}

bool FoundSolutions::IsBetter(const ContactSolution& solution) const {
  // A force on its bound is not credible and wins only where nothing else
  // explains the frame.
  const auto chi2 = [this](const ContactSolution& of) {
    return of.chi2 + (HasMostForce(of) ? kWithinNoise : 0);
  };
  // With as many unknowns as readings all leave nothing but rounding. Then the
  // lighter contact is likelier: a place explains the readings over a range
  // that is proportional to 1 / f_c (valley.h).
  const double more = chi2(solution) - chi2(best());
  const bool lighter =
      solution.contacts[0].normal_N < best().contacts[0].normal_N;
  return more < -kTie || (more < kTie && lighter);
}

double FoundSolutions::least_chi2() const {
  return empty() ? std::numeric_limits<double>::infinity() : best().chi2;
}

const ContactSolution* FoundSolutions::rival() const {
  const ContactSolution* rival = nullptr;
  for (const ContactSolution& other : *this) {
    if (!IsRival(other, kWithinNoise)) continue;
    if (rival == nullptr || other.chi2 < rival->chi2) rival = &other;
  }
  return rival;
}

bool FoundSolutions::IsRival(const ContactSolution& other,
                             double within) const {
  if (&other == &best() || other.chi2 > best().chi2 + within) return false;
  if (HasMostForce(other) && !HasMostForce(best())) return false;
  return IsDistinct(other);
}

bool FoundSolutions::IsDistinct(const ContactSolution& other) const {
  const ContactSolution& one = best();
  const ContactDifference apart = Apart(one, other);
  bool rounding = true;
  for (int c = 0; c < one.count; ++c) {
    rounding &=
        std::abs(apart[2 * c]) < kRounding * length_mm_ &&
        std::abs(apart[2 * c + 1]) < kRounding * one.contacts[c].normal_N;
  }
  return !rounding &&
         apart.dot(one.information * apart) > kDistinct[one.count - 1];
}

bool FoundSolutions::HasMostForce(const ContactSolution& solution) const {
  for (int c = 0; c < solution.count; ++c) {
    if (solution.contacts[c].normal_N >= most_force_N_) return true;
  }
  return false;
}

template <class Is>
bool FoundSolutions::Any(const Is& is) const {
  return std::any_of(solutions_.begin(), solutions_.begin() + count_, is);
}

bool FoundSolutions::IsSame(const ContactSolution& one,
                            const ContactSolution& other) const {
  // At the clamp of the beam the information is zero, and every other solution
  // would be near.
  if (other.chi2 < one.chi2 - kSame || AnyOnBound(one) != AnyOnBound(other)) {
    return false;
  }
  const ContactDifference apart = Apart(one, other);
  return apart.dot(one.information * apart) < kSame;
}

bool FoundSolutions::AnyOnBound(const ContactSolution& solution) const {
  return std::any_of(solution.contacts.begin(),
                     solution.contacts.begin() + solution.count,
                     [this](const PointContact& contact) {
                       return OnBound(contact.arc_mm, contact.normal_N);
                     });
}

bool FoundSolutions::IsWithin(double distance_mm, double arc_mm) const {
  return Any([&](const ContactSolution& one) {
    return std::abs(arc_mm - one.contacts[0].arc_mm) < distance_mm;
  });
}

double FoundSolutions::ExpectedChi2(double arc_mm) const {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < count_; ++i) {
    const ContactSolution& one = solutions_[i];
    const ContactMatrix& a = one.information;
    const double apart = arc_mm - one.contacts[0].arc_mm;
    const double given_force = a(0, 0) - a(0, 1) * a(1, 0) / a(1, 1);
    least = std::min(least, one.chi2 + given_force * apart * apart);
  }
  return least;
}

bool FoundSolutions::OnBound(double arc_mm, double normal_N) const {
  return arc_mm <= 0 || arc_mm >= length_mm_ || normal_N >= most_force_N_;
}

}  // namespace finray
