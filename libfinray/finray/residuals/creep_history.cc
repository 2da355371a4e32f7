#include "finray/residuals/creep_history.h"

#include <ceres/jet.h>

#include <cmath>
#include <mutex>

#include "finray/finger/gauge_lag.h"

namespace finray {

void CreepHistory::Set(int row, double time_s, double volts) {
  const auto i = static_cast<std::size_t>(row);
  if (i >= volts_.size()) {
    volts_.resize(i + 1, std::nan(""));
    times_s_.resize(i + 1, std::nan(""));
  }
  volts_[i] = volts;
  times_s_[i] = time_s;
}

CreepHistory::Lag CreepHistory::At(int row, double share,
                                   double ln_time_constant) const {
  {
    const std::shared_lock<std::shared_mutex> lock(mutex_);
    if (share == share_ && ln_time_constant == ln_time_constant_) {
      return lags_[row];
    }
  }
  const std::unique_lock<std::shared_mutex> lock(mutex_);
  if (share != share_ || ln_time_constant != ln_time_constant_) {
    share_ = share;
    ln_time_constant_ = ln_time_constant;
    Compute();
  }
  return lags_[row];
}

void CreepHistory::Compute() const {
  using Jet = ceres::Jet<double, 2>;
  GaugeLag<Jet> lag(Jet(share_, 0), exp(Jet(ln_time_constant_, 1)));
  lags_.resize(volts_.size());
  Lag now{};
  for (std::size_t row = 0; row < volts_.size(); ++row) {
    if (std::isfinite(volts_[row])) {
      const Jet z = lag.Next(times_s_[row], Jet(volts_[row]));
      now = {z.a, z.v[0], z.v[1]};
    }
    lags_[row] = now;
  }
}

}  // namespace finray
