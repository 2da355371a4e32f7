#ifndef FINRAY_CONTROL_CONTROL_STATISTICS_H_
#define FINRAY_CONTROL_CONTROL_STATISTICS_H_

#include <cstddef>
#include <limits>

#include "finray/control/control_loop.h"

namespace finray {

/// Sums of errors, to be added up over draws.
struct ErrorSums {
  std::size_t count = 0;
  double sum = 0, squares = 0, most = 0;

  void Add(double error);
  void Add(const ErrorSums& other);
  double mean() const { return sum / static_cast<double>(count); }
  double rms() const;
};

/// How runs of one controller came out, over rows from measure_from_s on.
struct ControlStatistics {
  std::size_t runs = 0, failed_runs = 0, stopped_runs = 0;
  std::size_t periods = 0;     ///< counted ones
  std::size_t controlled = 0;  ///< of them, those in mode control
  ErrorSums control;           ///< true force less set-point
  ErrorSums settled;           ///< the same, settled_after_s behind any step
  /// Estimated force less true force, where every finger is sure.
  ErrorSums estimate;
  double worst_rms_N = 0;  ///< of control, of one run
  double best_rms_N = std::numeric_limits<double>::infinity();

  void Add(const ControlStatistics& other);
};

/// Of one run. Without a controller there is no control error.
ControlStatistics StatisticsOf(const LoopRun& run, const Experiment& experiment,
                               bool controlled);

/// By how much the force lags behind the set-point: the shift in steps of 1 ms
/// from -0.2 to 0.6 s that leaves the least sum of squares over rows from
/// measure_from_s on.
double LagSeconds(const LoopRun& run, const Experiment& experiment);

}  // namespace finray

#endif  // FINRAY_CONTROL_CONTROL_STATISTICS_H_
