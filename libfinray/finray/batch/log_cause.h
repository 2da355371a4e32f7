#ifndef FINRAY_BATCH_LOG_CAUSE_H_
#define FINRAY_BATCH_LOG_CAUSE_H_

#include <cstddef>
#include <string>
#include <vector>

#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/scene/gauge_faults.h"
#include "finray/scene/history_filter.h"
#include "finray/scene/measurements.h"
#include "finray/scene/scene.h"

namespace finray {

/// What is kept of a log to find out why the finger does not fit it: its gauge
/// faults, and pairs of neighbouring rows, evenly spread. Memory does not grow
/// with the log.
class LogEvidence {
 public:
  static constexpr std::size_t kMostRows = 512;

  LogEvidence(const Finger& finger, const Scene& scene);
  /// Takes the next row as it was read.
  void Add(Measurements row);

  const std::vector<Measurements>& rows() const { return rows_; }
  std::vector<GaugeFault> Faults() const { return faults_.Faults(); }

 private:
  GaugeFaultFinder faults_;
  HistoryFilter history_;
  std::vector<Measurements> rows_;
  std::size_t count_ = 0, stride_ = 1;  // of pairs
};

/// Why the finger does not fit a log; both are empty if nobody has looked.
struct LogCause {
  /// "the gauges' offsets have moved", or that no known effect explains it.
  std::string words;
  std::string details;  ///< How far, or where; may be empty.
  std::string remedy;
  bool of_gauges = false;  ///< Gauges are dead, stuck, frozen or clipped.
};

/// Looks for the cause in this order, and without `needed` only for faults of
/// gauges.
///
///  1. Gauges that are dead, stuck, frozen or clipped
///     (GaugeFaultFinder) are the cause.
///     So are coarse ones, if noise of the size of their steps explains the
///     rows, and readings that are 1000 times too small, if they explain them
///     as many times larger.
///  2. Each other cause is tried: the rows are estimated again with it. Its
///     numbers p minimise the sum of chi2 and of the squared errors of forces,
///     over their std, by Gauss and Newton, with contacts eliminated:
///
///       p -= (B'QB)^-1 B'Qr,   B = dr/dp,   Q = I - J (J'J)^-1 J'.
///
///     They are moved offsets, other gains, another stiffness, friction,
///     exchanged or reversed gauges, a larger noise, and a force sensor of
///     another scale or zero.
///  3. A cause is named only if its numbers are possible (a gain or a stiffness
///     within a factor of kMostFactor) and the rows then give rise to no
///     warning: neither unexplained frames nor forces that differ. With a noise
///     that is larger, residuals must not go together in neighbouring rows, nor
///     be larger under load than without.
///  4. Causes that explain the rows as well, within kAsWell of chi2, are named
///     too. If there is none, the words say so, and the details say in which
///     rows the frames are that are not explained: those of high or low loads,
///     places, or times.
LogCause FindLogCause(const LogEvidence& evidence, const Finger& finger,
                      const Scene& scene, const Discretization& discretization,
                      int threads, bool needed);
constexpr double kMostFactor = 3, kAsWell = 12;

}  // namespace finray

#endif  // FINRAY_BATCH_LOG_CAUSE_H_
