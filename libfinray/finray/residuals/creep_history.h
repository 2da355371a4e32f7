#ifndef FINRAY_RESIDUALS_CREEP_HISTORY_H_
#define FINRAY_RESIDUALS_CREEP_HISTORY_H_

#include <shared_mutex>
#include <vector>

namespace finray {

/// What the readings of a gauge in a log say of its creep (gauge_lag.h). The
/// lagging part of V - o, with the share c and the time constant tau, is
///
///   z = F(c, ln tau) - o / (1 + c),
///
/// where F is that of the readings themselves. F at all rows is computed
/// together and kept until c or tau changes; any number of threads may ask.
class CreepHistory {
 public:
  /// Sets the reading in a row of the log. One that is NaN was not measured.
  void Set(int row, double time_s, double volts);

  struct Lag {
    double volts, by_share, by_ln_time;
  };
  /// F in a row, with its derivatives. It is that of the row before if this one
  /// has no reading.
  Lag At(int row, double share, double ln_time_constant) const;

 private:
  void Compute() const;

  std::vector<double> times_s_, volts_;
  mutable std::shared_mutex mutex_;
  mutable double share_ = -2, ln_time_constant_ = 0;  // of lags_; -2: none
  mutable std::vector<Lag> lags_;
};

/// Names the reading of a frame in such a history, and the parameters.
struct CreepTerm {
  const CreepHistory* history = nullptr;  ///< Null: the gauge does not creep.
  int row = 0;
  double *share = nullptr, *ln_time_constant = nullptr;
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_CREEP_HISTORY_H_
