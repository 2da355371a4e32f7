#ifndef FINRAY_STATICS_LOAD_TRAIL_H_
#define FINRAY_STATICS_LOAD_TRAIL_H_

#include <Eigen/Core>
#include <array>
#include <vector>

#include "finray/finger/point_contact.h"

namespace finray {

/// The last equilibria of a solver and what they say of the next one. With u =
/// (l_c / l_0, f_c / force unit) of all contacts, d_i = u_i - u_0 from the
/// newest equilibrium z_0 and d = u - u_0,
///
///   z(u) ~ z_0 + sum_i w_i (z_i - z_0),
///   min_w |sum w_i d_i - d|^2 + |sum w_i d_i d_i' - d d'|^2,    i = 1, 2.
///
/// Loads off one line determine a plane, and the first term makes the guess
/// right to first order. Along a line the second term makes it right to second
/// order. docs/decisions/0017-a-solve-starts-from-three.md has figures.
class LoadTrail {
 public:
  LoadTrail(double length_mm, double force_unit_N)
      : length_mm_(length_mm), force_unit_N_(force_unit_N) {}

  void Clear() { count_ = 0; }
  /// Keeps the equilibrium `state`, `size` numbers, as the newest one. It takes
  /// the place of the newest one if the load comes again, or after a step much
  /// shorter than the one before: the trail then holds less of the way of a
  /// search for a load. Other kinds of contacts or another size begin a new
  /// trail. A trail that is full allocates nothing.
  void Add(const std::vector<PointContact>& contacts, const double* state,
           Eigen::Index size);
  /// Replaces `state`, which must be the newest one, by the guess for
  /// `contacts`. Returns false and leaves it alone if the trail says nothing of
  /// them.
  bool Predict(const std::vector<PointContact>& contacts, double* state,
               Eigen::Index size) const;
  /// The newest equilibrium. Requires a call of Add after the last Clear.
  const Eigen::VectorXd& newest() const { return points_[newest_].state; }

 private:
  struct Point {
    std::vector<PointContact> contacts;
    Eigen::VectorXd state;
  };
  static constexpr int kPoints = 3;

  const Point& Before(int steps) const {
    return points_[(newest_ + kPoints - steps) % kPoints];
  }
  bool SameKind(const std::vector<PointContact>& contacts,
                Eigen::Index size) const;
  // (u_a - u_0) . (u_b - u_0)
  double Product(const std::vector<PointContact>& a,
                 const std::vector<PointContact>& b) const;

  double length_mm_, force_unit_N_;
  std::array<Point, kPoints> points_;
  int newest_ = 0, count_ = 0;
  double last_square_ = 0;  // of the last step that was not zero
};

}  // namespace finray

#endif  // FINRAY_STATICS_LOAD_TRAIL_H_
