#include "finray/scene/creep_filter.h"

#include <algorithm>

#include "finray/io/error.h"
#include "finray/io/frame_vocabulary.h"

namespace finray {

CreepFilter::CreepFilter(const Finger& finger)
    : gauges_(finger.gauges),
      empty_(std::all_of(
          gauges_.begin(), gauges_.end(),
          [](const Gauge& gauge) { return gauge.creep_share == 0; })) {
  for (const Gauge& gauge : gauges_) {
    lags_.emplace_back(gauge.creep_share, gauge.creep_time_constant_s);
  }
}

void CreepFilter::Remove(Measurements* row) {
  for (std::size_t j = 0; j < gauges_.size(); ++j) {
    const Gauge& gauge = gauges_[j];
    double& volts = row->gauges_V[j];
    if (gauge.creep_share == 0 || !gauge.IsInRange(volts)) continue;
    volts -=
        gauge.creep_share * lags_[j].Next(row->time_s, volts - gauge.offset_V);
  }
}

void CreepFilter::Restart() {
  for (GaugeLag<double>& lag : lags_) lag.Restart();
}

void RequireTimeForCreep(const Finger& finger,
                         const std::vector<std::string>& names,
                         const std::string& path) {
  if (CreepFilter(finger).empty() ||
      std::find(names.begin(), names.end(), "time_s") != names.end()) {
    return;
  }
  throw InputError(path + ": " + NoColumn("time_s", names) +
                   "; the creep of the finger's gauges needs it");
}

}  // namespace finray
