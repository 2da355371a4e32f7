#include "finray/residuals/reading_history.h"

#include <ceres/jet.h>

#include <cmath>
#include <mutex>

#include "finray/finger/gauge_lag.h"
#include "finray/finger/gauge_play.h"

namespace finray {

void ReadingHistory::Set(int row, double time_s, double volts, double moved2) {
  const auto i = static_cast<std::size_t>(row);
  if (i >= volts_.size()) {
    volts_.resize(i + 1, std::nan(""));
    times_s_.resize(i + 1, std::nan(""));
    signals_V_.resize(i + 1, std::nan(""));
    moved2_.resize(i + 1, 2);
  }
  volts_[i] = volts;
  times_s_[i] = time_s;
  moved2_[i] = moved2;
}

void ReadingHistory::Drive(int row, double signal_V, double moved2) {
  signals_V_[row] = signal_V;
  moved2_[row] = moved2;
  computed_ = false;
}

ReadingHistory::Row ReadingHistory::At(int row, const Values& values) const {
  {
    const std::shared_lock<std::shared_mutex> lock(mutex_);
    if (computed_ && values == at_) return rows_[row];
  }
  const std::unique_lock<std::shared_mutex> lock(mutex_);
  ComputeAt(values);
  return rows_[row];
}

void ReadingHistory::Follow(const Values& values) const {
  const std::unique_lock<std::shared_mutex> lock(mutex_);
  ComputeAt(values);
}

void ReadingHistory::ComputeAt(const Values& values) const {
  if (computed_ && values == at_) return;
  at_ = values;
  computed_ = true;
  Compute();
}

void ReadingHistory::KeepStd(const Values& values) {
  kept_std_V_.resize(volts_.size());
  for (std::size_t row = 0; row < volts_.size(); ++row) {
    kept_std_V_[row] = At(static_cast<int>(row), values).play_std_V;
  }
}

void ReadingHistory::Compute() const {
  using Jet = ceres::Jet<double, 3>;
  const Jet share(at_.share, 0), width(at_.width_V, 2);
  GaugeLag<Jet> lag(share, exp(Jet(at_.ln_time_constant, 1)));
  PlayBelief<Jet> play(width / noise_V_);
  const auto split = [](const Jet& x) {
    return Behind{x.a, x.v[0], x.v[1], x.v[2]};
  };
  rows_.resize(volts_.size());
  Row now{};
  for (std::size_t row = 0; row < volts_.size(); ++row) {
    if (std::isfinite(volts_[row])) {
      const Jet z = lag.Next(times_s_[row], Jet(volts_[row]));
      const Jet signal = std::isfinite(signals_V_[row])
                             ? Jet(signals_V_[row])
                             : volts_[row] - share * z;
      play.Next(signal / noise_V_, moved2_[row]);
      now = {split(z), split(play.mean() * noise_V_),
             noise_V_ * std::sqrt(play.variance().a)};
    }
    rows_[row] = now;
  }
}

}  // namespace finray
