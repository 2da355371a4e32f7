#ifndef FINRAY_RESIDUALS_READING_HISTORY_H_
#define FINRAY_RESIDUALS_READING_HISTORY_H_

#include <shared_mutex>
#include <vector>

namespace finray {

/// What the readings of a gauge in a log say of its creep (gauge_lag.h) and of
/// its hysteresis (gauge_play.h). The lagging part of V - o, with the share c
/// and the time constant tau, is
///
///   z = F(c, ln tau) - o / (1 + c),
///
/// where F is that of the readings themselves. The gauge lies d volts behind
/// its signal, by what V - c F says with half a loop of w volts. Both at all
/// rows are computed together and kept until a parameter changes; any number of
/// threads may ask.
class ReadingHistory {
 public:
  void set_noise_V(double noise_V) { noise_V_ = noise_V; }
  /// Sets the reading in a row of the log. One that is NaN was not measured.
  /// `moved2` is that of PlayBelief.
  void Set(int row, double time_s, double volts, double moved2);
  /// Lets play in a row follow this signal, in V as the gauge would read it
  /// without creep and play; NaN: the reading. A regressor made of readings
  /// goes with their noise, hence with the residuals that it is to explain.
  /// What a model fits to all measurements does not.
  void Drive(int row, double signal_V, double moved2);

  struct Values {
    double share = 0, ln_time_constant = 0, width_V = 0;
    bool operator==(const Values& other) const {
      return share == other.share &&
             ln_time_constant == other.ln_time_constant &&
             width_V == other.width_V;
    }
  };
  struct Behind {
    double volts, by_share, by_ln_time, by_width;
  };
  struct Row {
    Behind lag;   ///< F
    Behind play;  ///< The mean of d.
    double play_std_V;
  };
  /// A row with its derivatives. It is that of the row before if this one has
  /// no reading.
  Row At(int row, const Values& values) const;
  /// Computes all rows at these values, for At.
  void Follow(const Values& values) const;

  /// Keeps the std of d at these values for KeptStd_V. In a sum of squares a
  /// std that goes with a parameter would pull at it.
  void KeepStd(const Values& values);
  double KeptStd_V(int row) const {
    return kept_std_V_.empty() ? 0 : kept_std_V_[row];
  }

 private:
  // Computes all rows unless they are those at these values.
  void ComputeAt(const Values& values) const;
  void Compute() const;

  double noise_V_ = 1;
  std::vector<double> times_s_, volts_, signals_V_, moved2_, kept_std_V_;
  mutable std::shared_mutex mutex_;
  mutable bool computed_ = false;
  mutable Values at_;  // of rows_
  mutable std::vector<Row> rows_;
};

/// Names the reading of a frame in such a history, and the parameters.
struct HistoryTerm {
  /// Null: the gauge has neither creep nor hysteresis.
  const ReadingHistory* history = nullptr;
  int row = 0;
  double *share = nullptr, *ln_time_constant = nullptr,
         *hysteresis_rad = nullptr;
};

}  // namespace finray

#endif  // FINRAY_RESIDUALS_READING_HISTORY_H_
