#ifndef FINRAY_ESTIMATION_WALK_INCREMENTS_H_
#define FINRAY_ESTIMATION_WALK_INCREMENTS_H_

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace finray {

/// Tests a scene's gauge_offset_walk by the increments of the offsets that a
/// solution finds (LogProblem). If the walk is as told, with q V in the square
/// root of a second, the increment d of the offsets over L seconds has the
/// covariance
///
///   E dd' = q^2 L I - V,
///
/// V the covariance that the readings leave of it: what they do not tell, the
/// solution takes for 0. Each eigenvector u of I - V / (q^2 L) with an
/// eigenvalue e above kTold adds (u'd)^2 / (q^2 L e) to a chi2 and a degree of
/// freedom. Sums are kept for lags from 1 / 2^(kLags - 1) of a window to all of
/// it, because
///  - a walk of s q has E chi2 / dof = e s^2 + 1 - e: what the readings tell
///  has
///    their noise too;
///  - a steady drift adds a part that grows with the lag: its increments all
///    go one way, so they are correlated.
/// Sums of windows and of logs add up.
struct WalkIncrements {
  static constexpr std::size_t kLags = 6;
  static constexpr double kTold = 0.3;

  double told_V_per_sqrt_s = 0;
  std::array<double, kLags> chi2{}, dof{};  ///< the shortest lag first
  /// Sums of e^2, and of e (chi2 - 1 + e), so that their ratio is about s^2.
  std::array<double, kLags> weights{}, weighted{};
  /// By gauge, over windows, and the time of these.
  std::vector<double> moved_V;
  double moved_s = 0;

  void Add(std::size_t lag, const Eigen::VectorXd& moved, double seconds,
           const Eigen::MatrixXd& covariance);
  void Add(const WalkIncrements& other);

  enum class Verdict { kFits, kTooLarge, kTooSmall, kDrift };
  /// kTooSmall or kDrift if at some lag chi2 has p < kSignificance and is above
  /// kFactor dof; kDrift if it grows by kFactor^2 from short lags to long ones.
  /// kTooLarge if it is as unlikely and below dof / kFactor^2.
  Verdict Judge() const;
  static constexpr double kSignificance = 1e-6, kFactor = 2;
  /// Says whether offsets move no more than told.
  bool TellsOffsets() const {
    const Verdict verdict = Judge();
    return verdict == Verdict::kFits || verdict == Verdict::kTooLarge;
  }
  /// About what the walk is, in V in the square root of a second, and at least
  /// kLeastShare of what is told.
  double FittingWalk() const;
  static constexpr double kLeastShare = 0.05;
  /// Says whether that is the least: the walk is far smaller, nobody knows how
  /// small.
  bool FitsTheLeast() const {
    return FittingWalk() <= 1.01 * kLeastShare * told_V_per_sqrt_s;
  }

 private:
  // chi2 / dof of the shortest lag that tells enough.
  std::optional<double> ShortLag() const;
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_WALK_INCREMENTS_H_
