#ifndef FINRAY_ESTIMATION_FOUND_SOLUTIONS_H_
#define FINRAY_ESTIMATION_FOUND_SOLUTIONS_H_

#include <vector>

#include "finray/estimation/contact_solution.h"

namespace finray {

/// The minima that a search has found for a frame, all with the same number of
/// contacts. Memory is allocated once.
class FoundSolutions {
 public:
  static constexpr int kMost = 16;
  /// Two solutions explain a frame equally well if their chi2 differ by less
  /// than this, the 99 % quantile of chi-squared with two degrees of freedom.
  static constexpr double kWithinNoise = 9.21;

  /// Forces end at `most_force_N`, places at `length_mm`.
  FoundSolutions(double length_mm, double most_force_N, std::size_t ribs);

  void Clear() { count_ = 0; }
  bool empty() const { return count_ == 0; }
  bool full() const { return count_ == kMost; }

  /// Where the next solution is filled in before Keep. Not if full().
  ContactSolution& next() { return solutions_[count_]; }
  /// Keeps the next solution, with its contacts sorted from base to tip.
  void Keep();

  /// A solution with a force on its bound is the best one only if nothing else
  /// explains the frame.
  const ContactSolution& best() const { return solutions_[best_]; }
  /// The solutions that Keep has stored first and last.
  const ContactSolution& first() const { return solutions_[0]; }
  const ContactSolution& last() const { return solutions_[count_ - 1]; }
  /// Its chi2; infinite if there is none.
  double least_chi2() const;
  /// The best solution that is distinct from best() beyond its uncertainty and
  /// explains the frame as well; null if there is none. `within` is the
  /// difference of chi2 that this allows.
  const ContactSolution* rival(double within = kWithinNoise) const;

  // For one contact.

  /// Says whether the next solution is one that is kept.
  bool KnowsNext() const;
  /// Says whether a minimum at that contact, not yet fitted, is one that is
  /// kept. Solutions on a bound know nothing of other places.
  bool Knows(const PointContact& contact, double chi2) const;
  /// Says whether a solution lies within that distance of a place.
  bool IsWithin(double distance_mm, double arc_mm) const;
  /// The least chi2 that they expect of a contact at that place.
  double ExpectedChi2(double arc_mm) const;

  /// Says whether a contact is at an end of the beam or at the largest force.
  bool OnBound(double arc_mm, double normal_N) const;

 private:
  // Says whether a contact with that chi2 is the minimum `one`.
  bool IsNear(const ContactSolution& one, const PointContact& contact,
              double chi2) const;
  bool HasMostForce(const ContactSolution& solution) const;
  bool IsDistinct(const ContactSolution& other) const;
  template <class Is>
  bool Any(const Is& is) const;

  double length_mm_, most_force_N_;
  std::vector<ContactSolution> solutions_;
  int count_ = 0, best_ = 0;
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_FOUND_SOLUTIONS_H_
