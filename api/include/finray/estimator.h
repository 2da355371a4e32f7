#ifndef FINRAY_ESTIMATOR_H_
#define FINRAY_ESTIMATOR_H_

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "finray/error.h"
#include "finray/export.h"
#include "finray/finger.h"
#include "finray/scene.h"
#include "finray/simulator.h"
#include "finray/table.h"

namespace finray::v1 {

/// What became of a frame (docs/reference/estimation.md).
enum class FrameStatus : unsigned char {
  kOk,
  kNoContact,
  kUnobservable,  ///< Solved, but the readings do not determine the contact.
  kNotConverged,
  kBadInput,
};
/// "ok", "no_contact", "unobservable", "not_converged", "bad_input".
FINRAY_API const char* StatusName(FrameStatus status);

struct EstimateOptions {
  /// "fast", or "ceres": the residual blocks of the calibration, which take
  /// every kind of measurement.
  std::string solver = "fast";
  /// With "ceres": "reduced" or "weighted".
  std::string equilibrium = "reduced";
  /// Solves all frames of a log together, with the scene's gauge_offset_walk
  /// and smoothing.
  bool joint = false;
  int threads = 0;  ///< 0 (all cores) to 1024. Results do not depend on it.
  Discretization discretization;
};

/// Counts over the frames of a log.
struct EstimationSummary {
  std::size_t frames = 0, ok = 0, no_contact = 0, unobservable = 0,
              not_converged = 0, bad_input = 0;
  /// Solved frames that the finger and its noise do not explain, but for those
  /// that a second contact on four gauges may explain.
  std::size_t unexplained = 0;
  /// Frames that were compared with a force of the log, and the errors; NaN
  /// if there is none.
  std::size_t force_compared = 0;
  double force_rms_error_N = 0, force_max_error_N = 0;
};

/// The estimates of a log.
class FINRAY_API Estimation {
 public:
  std::size_t rows() const { return statuses.size(); }
  /// The computed numbers, as finray_estimate writes them: `contact_<c>_mm`,
  /// `contact_<c>_std_mm`, `normal_<c>_N`, ..., chi2, iterations.
  Table numbers;
  std::vector<FrameStatus> statuses;
  EstimationSummary summary;
  /// What makes the estimates doubtful, as in summary.yaml.
  std::vector<Warning> warnings;

  /// The table that finray_estimate writes: the log's columns, and the computed
  /// ones and `status` in place of those of the same name or behind them.
  Table Merged(const Table& log) const;
};

/// Estimates contacts from gauges, as finray_estimate does: the same numbers,
/// bit by bit. Making one takes some milliseconds. One estimator may be used
/// from several threads.
class FINRAY_API Estimator {
 public:
  /// Throws InputError for a scene or a finger that cannot be estimated, and
  /// for an unknown option.
  explicit Estimator(const Finger& finger, const Scene& scene = Scene(),
                     const EstimateOptions& options = {});
  ~Estimator();
  Estimator(Estimator&&) noexcept;
  Estimator& operator=(Estimator&&) noexcept;

  /// Estimates all rows of a log, with a column `gauge_<j>_V` (or
  /// `gauge_<j>_rad`) for each gauge. Columns that are borrowed are not copied.
  /// `stop` is polled from any thread; if it returns true, Interrupted is
  /// thrown.
  Estimation Estimate(const Table& log,
                      const std::function<bool()>& stop = {}) const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace finray::v1

#endif  // FINRAY_ESTIMATOR_H_
