#ifndef FINRAY_FINGER_GAUGE_PLAY_H_
#define FINRAY_FINGER_GAUGE_PLAY_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "finray/finger/finger.h"

namespace finray {

/// Hysteresis as play: what a gauge reads, p, follows its signal s at a
/// distance of up to w,
///
///   p_k = clamp(p_{k-1}, s_k - w, s_k + w).
///
/// Only the order of the samples counts, not their times. Before the first one
/// p = 0, as in a finger that is free.
class Play {
 public:
  explicit Play(double width) : width_(width) {}
  /// Takes the next s and returns p.
  double Next(double s) {
    at_ = std::min(std::max(at_, s - width_), s + width_);
    return at_;
  }

 private:
  double width_, at_ = 0;
};

/// Std of d for a gauge whose d may be anywhere in [-w, w] before its signal
/// moves by m. Of the places a share of m / 2 w then ends at d = w. 0 once the
/// signal has moved by 2 w.
inline double PlayStd(double width, double moved) {
  const double rest = 1 - std::abs(moved) / (2 * width);
  if (!(width > 0) || !(rest > 0)) return 0;
  const double length = 2 * width * rest;
  return length * std::sqrt(rest * (1 / 12.0 + (1 - rest) / 4));
}

/// What readings with noise say of d = s - p, which lies in [-w, w]. All
/// numbers are in units of the noise's std. Where p rises d = w, where it falls
/// d = -w, and while it stands still s may be anywhere in between.
///
/// The belief is a histogram of d over kCells values d_i, and p ~ N(a, P). Let
/// s change by N(0, t^2) to the next row, whose reading is u, and D = u - a.
/// With the normal density phi and its integral Phi, each d_i goes on
///
///   inside the band, to the cell [l_j, h_j], as likely as
///     phi(D; 1 + P) [Phi((h_j - d_i) / t) - Phi((l_j - d_i) / t)],
///   up, to d = w and another p, as
///     phi(D + w - d_i; t^2 + 1 + P) Phi(x),
///     x = (D t^2 - (w - d_i) (1 + P)) / (t sqrt((1 + P) (t^2 + 1 + P))),
///
/// and down likewise. For touches in any order t is large, so that what was
/// before tells nothing: a gauge that has not moved has d = 0 with a std of w /
/// sqrt(3). A finger that is held keeps its d.
///
/// t is not known. It is what the gauges of the row have changed by, and what
/// this one has, and 2 w more as so much may have been unseen; both only as far
/// as they are beyond noise. kWander is added in each row. Steps that are small
/// against the cells are summed up first. A smooth reversal is noticed only
/// once its steps are seen.
///
/// At a width of 0 and below s never stands still and d = +-w, so that a solver
/// may pass through it. T is double or a ceres::Jet.
template <class T>
class PlayBelief {
 public:
  static constexpr int kCells = 13;
  /// Std of a step that cannot be seen. A finger that is held loses what is
  /// known of its d in some (w / kWander)^2 rows.
  static constexpr double kWander = 0.05;
  /// A change of so many std is beyond noise.
  static constexpr double kMoves = 4;

  explicit PlayBelief(const T& width)
      : width_(width),
        band_(width > 0.0 ? width : T(0.0)),
        cells_(width > 0.0 ? kCells : 1) {}

  /// Takes the next reading u. `moved2` is the mean square of the changes of
  /// all gauges since the row before; it is 2 for noise alone.
  void Next(const T& u, double moved2) {
    using std::abs;
    const T cell = 2.0 * band_ / (kCells - 1.0);
    if (!started_) {
      started_ = true;
      at_ = u;
      at_variance_ = T(1.0);
      step2_ = T(0.0);
      for (T& share : shares_) share = T(1.0 / (kCells - 1.0));
      shares_[0] = shares_[kCells - 1] = T(0.5 / (kCells - 1.0));
      if (cells_ == 1) shares_[0] = T(1.0);
      SetMoments(T(0.0), T(0.0));
      return;
    }
    const T change = u - at_, s2 = 1.0 + at_variance_;
    const T farthest = abs(change) + 2.0 * band_;
    step2_ += kWander * kWander + Beyond(2 * moved2) * moved2 +
              Beyond(change * change / s2) * farthest * farthest;
    const T rests = at_variance_ / s2;
    if (step2_ < cell * cell / 4.0) {
      at_ += rests * change;
      at_variance_ = rests;
      return;
    }
    const T t2 = step2_;
    step2_ = T(0.0);
    const T still = Move(change, s2, t2, cell);
    const T moves = (at_variance_ + t2) / (s2 + t2);
    const T gain = still * rests + (1.0 - still) * moves;
    const T apart = (moves - rests) * change;
    at_variance_ = gain + still * (1.0 - still) * apart * apart;
    at_ += gain * change;
  }
  /// The next reading is the first of another log.
  void Restart() { started_ = false; }
  /// Of d, in the row that Next has taken last.
  const T& mean() const { return mean_; }
  const T& variance() const { return variance_; }

 private:
  // From 0 to 1 as a squared change, in squared std, passes kMoves^2.
  template <class Number>
  static Number Beyond(const Number& size) {
    const Number x = size / (kMoves * kMoves);
    if (x > 10.0) return Number(1.0);
    const Number x4 = x * x * x * x;
    return x4 * x4 / (1.0 + x4 * x4);
  }
  static T Phi(const T& x) {
    using std::erfc;
    return 0.5 * erfc(-x * M_SQRT1_2);
  }
  T ValueOf(int i, const T& cell) const {
    return -band_ + static_cast<double>(i) * cell;
  }

  // Takes s by N(0, t2) further. Returns the probability that p stood still.
  T Move(const T& change, const T& s2, const T& t2, const T& cell) {
    using std::exp;
    using std::sqrt;
    const T t = sqrt(t2), far2 = t2 + s2, v = t * sqrt(s2 * far2);
    const T e_still = -0.5 * change * change / s2;
    std::array<T, kCells> up, down;  // exponents, then probabilities
    T most = e_still;
    for (int i = 0; i < cells_; ++i) {
      const T above = width_ - ValueOf(i, cell);
      const T below = width_ + ValueOf(i, cell);
      up[i] = -0.5 * (change + above) * (change + above) / far2;
      down[i] = -0.5 * (change - below) * (change - below) / far2;
      most = std::max(most, std::max(up[i], down[i]));
    }
    // Phi at the edges between cells, (k + 1/2) cells away.
    std::array<T, 2 * kCells> edges;
    for (int k = 1; k < 2 * cells_ - 1; ++k) {
      edges[k] = Phi((k - cells_ + 0.5) * cell / t);
    }
    const T inside = exp(e_still - most) / sqrt(s2);
    std::array<T, kCells> next;
    next.fill(T(0.0));
    T rises(0.0), falls(0.0), stays(0.0);
    for (int i = 0; i < cells_; ++i) {
      const T above = width_ - ValueOf(i, cell);
      const T below = width_ + ValueOf(i, cell);
      T low = Phi((-band_ - ValueOf(i, cell)) / t);
      for (int j = 0; j < cells_; ++j) {
        const T high = j + 1 < cells_ ? edges[j - i + cells_]
                                      : Phi((band_ - ValueOf(i, cell)) / t);
        const T share = shares_[i] * inside * (high - low);
        next[j] += share;
        stays += share;
        low = high;
      }
      rises += shares_[i] * exp(up[i] - most) / sqrt(far2) *
               Phi((change * t2 - above * s2) / v);
      falls += shares_[i] * exp(down[i] - most) / sqrt(far2) *
               Phi((-change * t2 - below * s2) / v);
    }
    const T total = stays + rises + falls;
    if (!(total > 1e-300)) return T(1.0);  // beyond what doubles tell
    for (int i = 0; i < cells_; ++i) shares_[i] = next[i] / total;
    SetMoments(falls / total, rises / total);
    shares_[0] += falls / total;
    shares_[cells_ - 1] += rises / total;
    return stays / total;
  }

  // Of the shares inside the band and those that have moved down and up.
  void SetMoments(const T& down, const T& up) {
    const T cell = 2.0 * band_ / (kCells - 1.0);
    mean_ = width_ * (up - down);
    variance_ = width_ * width_ * (up + down);
    for (int i = 0; i < cells_; ++i) {
      const T d = ValueOf(i, cell);
      mean_ += shares_[i] * d;
      variance_ += shares_[i] * d * d;
    }
    variance_ -= mean_ * mean_;
    if (variance_ < 0.0) variance_ = T(0.0);
  }

  T width_, band_;
  int cells_;  // at a width of 0 and below all cells are one
  bool started_ = false;
  T at_{}, at_variance_{}, step2_{}, mean_{}, variance_{};
  std::array<T, kCells> shares_{};
};

/// How much the gauges of a row have changed since each was read last: the mean
/// of their squared changes in units of their noise, which is 2 for noise
/// alone.
class RowChange {
 public:
  explicit RowChange(const std::vector<Gauge>& gauges)
      : gauges_(gauges), last_V_(gauges.size(), std::nan("")) {}
  /// Takes the next row; NaN is a missing reading.
  double Next(const std::vector<double>& readings_V) {
    double sum = 0;
    int count = 0;
    for (std::size_t j = 0; j < gauges_.size(); ++j) {
      if (!gauges_[j].IsInRange(readings_V[j])) continue;
      const double change = (readings_V[j] - last_V_[j]) / gauges_[j].noise_V;
      last_V_[j] = readings_V[j];
      if (std::isnan(change)) continue;
      sum += change * change;
      ++count;
    }
    return count > 0 ? sum / count : 2;
  }
  /// The next row is the first of another log.
  void Restart() { last_V_.assign(gauges_.size(), std::nan("")); }

 private:
  std::vector<Gauge> gauges_;
  std::vector<double> last_V_;
};

}  // namespace finray

#endif  // FINRAY_FINGER_GAUGE_PLAY_H_
