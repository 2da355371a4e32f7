#ifndef FINRAY_SCENE_HISTORY_FILTER_H_
#define FINRAY_SCENE_HISTORY_FILTER_H_

#include <memory>
#include <string>
#include <vector>

#include "finray/finger/finger.h"
#include "finray/finger/gauge_lag.h"
#include "finray/finger/gauge_play.h"
#include "finray/objects/sliding_friction.h"
#include "finray/scene/measurements.h"
#include "finray/scene/scene.h"

namespace finray {

/// Takes out of the readings of a log, row by row, what depends on the rows
/// before: creep and hysteresis. Estimators expect readings without. Both
/// follow from the readings (gauge_lag.h, gauge_play.h), so they add no
/// unknown. For creep, readings run linearly from row to row, and the first row
/// is of a gauge at rest. For hysteresis, rows are in the order of time.
///
/// Where the scene has a presliding displacement and no smoothing, the filter
/// also says which way friction pulls: from the motion of the object in the
/// rows before (SlidingFriction), which are in the order of time.
class HistoryFilter {
 public:
  /// Without a scene, friction stays as it is.
  explicit HistoryFilter(const Finger& finger, const Scene& scene = {});

  /// Says that no row depends on the rows before, so that nothing needs
  /// filtering.
  bool empty() const { return gauges_.empty() && sliding_ == nullptr; }
  /// Replaces the volts of the next row of the log by those without creep and
  /// hysteresis, and sets its history_std_V and friction. A missing or
  /// saturated reading stays. A row without time_s counts as simultaneous with
  /// the row before.
  void Remove(Measurements* row);
  /// The next row is the first of another log.
  void Restart();

 private:
  struct Sliding {
    EquilibriumSolver solver;
    SlidingFriction friction;
  };
  std::unique_ptr<Sliding> sliding_;  // null without friction of an object
  std::vector<Gauge> gauges_;         // all or none
  std::vector<GaugeLag<double>> lags_;
  std::vector<PlayBelief<double>> plays_;
  RowChange change_;
  bool play_ = false;
};

/// Says whether a gauge of the finger creeps, so that time_s is needed.
bool HasCreep(const Finger& finger);

/// Throws InputError if gauges of the finger creep but the log's columns, given
/// by name, have no time_s.
void RequireTimeForCreep(const Finger& finger,
                         const std::vector<std::string>& names,
                         const std::string& path);

}  // namespace finray

#endif  // FINRAY_SCENE_HISTORY_FILTER_H_
