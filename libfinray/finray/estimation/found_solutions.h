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

  /// Forces end at `most_force_N`.
  FoundSolutions(const Finger& finger, double most_force_N);

  void Clear() { count_ = 0; }
  bool empty() const { return count_ == 0; }
  bool full() const { return count_ == kMost; }

  /// Where the next solution is filled in before Keep. Not if full().
  ContactSolution& next() { return solutions_[count_]; }
  /// Keeps the next solution, with its contacts sorted from base to tip. Of two
  /// fits of one minimum the better one stays.
  void Keep();

  /// A solution with a force on its bound is the best one only if nothing else
  /// explains the frame.
  const ContactSolution& best() const { return solutions_[best_]; }
  /// All, in the order in which Keep has stored them.
  const ContactSolution* begin() const { return solutions_.data(); }
  const ContactSolution* end() const { return begin() + count_; }
  /// The chi2 of best(); infinite if there is none.
  double least_chi2() const;
  /// The best solution that is distinct from best() beyond its uncertainty and
  /// explains the frame within kWithinNoise as well; null if there is none.
  const ContactSolution* rival() const;
  /// Says whether another solution is one with `within` instead of
  /// kWithinNoise.
  bool IsRival(const ContactSolution& other, double within) const;

  // For one contact.

  /// Says whether a solution lies within that distance of a place.
  bool IsWithin(double distance_mm, double arc_mm) const;
  /// The least chi2 that they expect of a contact at that place.
  double ExpectedChi2(double arc_mm) const;

  /// Says whether a contact is at an end of the beam or at the largest force.
  bool OnBound(double arc_mm, double normal_N) const;
  bool BestOnBound() const { return !empty() && AnyOnBound(best()); }
  double most_force_N() const { return most_force_N_; }

 private:
  void Sort(ContactSolution* solution) const;
  // Says whether a solution is to be best() instead of that one.
  bool IsBetter(const ContactSolution& solution) const;
  // Says whether two fits have led to one minimum, which `one` has found.
  bool IsSame(const ContactSolution& one, const ContactSolution& other) const;
  bool AnyOnBound(const ContactSolution& solution) const;
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
