#ifndef FINRAY_MODEL_LOAD_CELL_H_
#define FINRAY_MODEL_LOAD_CELL_H_

#include <Eigen/Core>
#include <algorithm>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "finray/model/chebyshev.h"
#include "finray/model/load_polynomial.h"

namespace finray {

/// Computes all values under a load (l_c, f_c), group after group. Returns
/// false if there is no equilibrium.
using LoadSampler =
    std::function<bool(double arc_mm, double normal_N, double* values)>;

/// The values of a surface, how exact they must be, and who computes them.
struct LoadValues {
  /// The numbers of values of each group.
  std::vector<int> sizes;
  /// A unit for each value of the first group, by which cells are judged: a
  /// cell is fine enough if it leaves out less.
  Eigen::VectorXd resolution;
  /// Each cell gets a sampler of its own.
  std::function<LoadSampler()> make_sampler;
  /// The other groups are evaluated without terms below this share of the
  /// largest term of the same value.
  double negligible = 0;
};

/// A rectangle of loads, with the series of chebyshev.h for each value.
class LoadCell {
 public:
  struct Interval {
    double from, to;

    double middle() const { return 0.5 * (from + to); }
    double slope() const { return 2 / (to - from); }
    /// From -1 to 1.
    double At(double x) const {
      return std::clamp((x - middle()) * slope(), -1.0, 1.0);
    }
    double Zero(int i, int terms) const {
      return middle() + 0.5 * (to - from) * ChebyshevZero(i, terms);
    }
  };

  /// A cell that starts with as many terms as `values` need, where l_0 is
  /// `length_mm`. The `light` cells, which hold the least forces, need fewer.
  LoadCell(const Interval& arc_mm, const Interval& normal_N, double length_mm,
           bool light, const LoadValues& values);

  /// Returns the part of the cell that holds a load: itself, or a part of a
  /// half. What is not made is made now, once, while other threads wait. Where
  /// the last coefficients are not small, a cell is made again with as many
  /// terms as their fall says, or halved.
  const LoadCell* PartAt(double arc_mm, double normal_N,
                         const LoadValues& values);
  /// Makes all parts.
  void MakeWhole(const LoadValues& values);

  // Only a part that PartAt has returned has these.

  /// Says whether there is an equilibrium, and so values.
  bool has_values() const { return !groups_.empty(); }
  /// About how far the values of the first group may be off, in units of their
  /// resolution.
  double error() const { return error_; }
  void SetBasis(double arc_mm, double normal_N, PolynomialBasis* basis) const;
  LoadPolynomial Polynomial(int group) const;

 private:
  struct Group {
    std::vector<int> force_terms;  // LoadPolynomial
    int values = 0;
    std::vector<double> c;
  };

  // Half a cell.
  LoadCell(const LoadCell& whole, bool by_arc, bool upper);
  // Makes the cell unless it is made.
  void Need(const LoadValues& values);
  // Returns false if the cell must be made again with more terms.
  bool Make(const LoadValues& values);
  // Computes the values at all zeros. Returns false at the first one without an
  // equilibrium; `*lightest` says whether that is the first of all.
  bool Sample(const LoadSampler& sample, ChebyshevRows* samples,
              bool* lightest) const;
  // Keeps `size` values from `first` on, but for terms of a size below `least`
  // that none of the others follows.
  void Keep(const ChebyshevRows& c, int first, int size,
            const Eigen::ArrayXXd& sizes, double least);
  void Halve(bool by_arc);

  Interval arc_mm_, normal_N_;
  int arc_terms_, force_terms_, halvings_ = 0;
  std::once_flag made_;
  // Afterwards: the groups, or the halves, or neither where there is no
  // equilibrium.
  std::vector<Group> groups_;
  double error_ = 0;
  bool halved_by_arc_ = false;
  std::unique_ptr<LoadCell> halves_[2];
};

}  // namespace finray

#endif  // FINRAY_MODEL_LOAD_CELL_H_
