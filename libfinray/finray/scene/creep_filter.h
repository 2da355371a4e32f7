#ifndef FINRAY_SCENE_CREEP_FILTER_H_
#define FINRAY_SCENE_CREEP_FILTER_H_

#include <string>
#include <vector>

#include "finray/finger/finger.h"
#include "finray/finger/gauge_lag.h"
#include "finray/scene/measurements.h"

namespace finray {

/// Takes the creep out of the readings of a log, row by row. Estimators expect
/// readings without creep. The lagging part follows from the readings before
/// (gauge_lag.h), so creep adds no unknown; between rows readings run linearly,
/// and the first row is of a gauge at rest.
class CreepFilter {
 public:
  explicit CreepFilter(const Finger& finger);

  /// Says that no gauge of the finger creeps, so that nothing needs filtering.
  bool empty() const { return empty_; }
  /// Replaces the volts of the next row of the log by those without creep. A
  /// missing or saturated reading stays. A row without time_s counts as
  /// simultaneous with the row before.
  void Remove(Measurements* row);
  /// The next row is the first of another log.
  void Restart();

 private:
  std::vector<Gauge> gauges_;
  std::vector<GaugeLag<double>> lags_;
  bool empty_;
};

/// Throws InputError if gauges of the finger creep but the log's columns, given
/// by name, have no time_s.
void RequireTimeForCreep(const Finger& finger,
                         const std::vector<std::string>& names,
                         const std::string& path);

}  // namespace finray

#endif  // FINRAY_SCENE_CREEP_FILTER_H_
