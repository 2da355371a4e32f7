#ifndef FINRAY_SCENE_GAUGE_STANDSTILL_H_
#define FINRAY_SCENE_GAUGE_STANDSTILL_H_

#include <cstddef>
#include <string>
#include <vector>

#include "finray/finger/finger.h"

namespace finray {

/// Looks for gauges that do not even show their noise. Its memory does not grow
/// with the log.
///
/// All gauges stand still if in kStandRows or more rows the readings of each
/// have a range of at most kNoiseRange noise_V, and their changes d from one to
/// the next are far below noise, mean d^2 / 2 <= (kNoNoise noise_V)^2. Coarse
/// steps of a converter show a finger at rest alike, so this counts only if
/// force_N varies by more than kTouch_N, or, where no force is read, if all
/// are the same numbers in kLongRows or more rows, or vary and are more than
/// kAway noise_V from an offset.
///
/// All gauges, or one, are frozen in a run of rows with the same numbers that
/// is kLonger times as long as any other: of kStandRows or more rows to the end
/// of the log, or of kLongRows elsewhere. Rows that each repeat as often, as a
/// slow converter makes them, are no fault.
class GaugeStandstill {
 public:
  static constexpr std::size_t kStandRows = 20, kLongRows = 100, kLonger = 10;
  static constexpr char kCauses[] =
      "dead, unplugged, or in another unit (V taken for mV?)";
  static constexpr double kNoiseRange = 9, kNoNoise = 0.05, kTouch_N = 0.5,
                          kAway = 10;

  explicit GaugeStandstill(const Finger& finger);
  /// Takes the next row, which counts from 1; NaN where nothing was read. Each
  /// reading is a mean of `readings`.
  void Add(std::size_t row, const std::vector<double>& readings_V,
           double force_N, double readings);
  /// "gauges 1 to 4 do not move ...", or "" if one of them does.
  std::string StillWords() const;
  /// "all gauges read the same from row 251 to 796 ...", or "".
  std::string FrozenWords() const;
  /// Returns true if a gauge is frozen from this row on.
  bool IsFrozen(int gauge, std::size_t first) const;

 private:
  struct Run {
    std::size_t rows = 0, first = 0, last = 0;
  };
  // The rows at the end that read the same, and such rows before them.
  struct Runs {
    Run now, longest;
    std::size_t next = 0;  // rows of the next longest one
    std::size_t rows = 0;

    void Add(std::size_t row, bool same);
    // The run that freezes, or one of no rows.
    Run Frozen() const;
  };
  struct Series {
    double last_V, low_V, high_V;
    double squares_V2 = 0;  // of changes
    std::size_t changes = 0;
    Runs runs;
  };

  std::vector<Gauge> gauges_;
  std::vector<Series> series_;
  Runs all_;
  double least_force_N_, most_force_N_;
  std::size_t rows_ = 0;
};

}  // namespace finray

#endif  // FINRAY_SCENE_GAUGE_STANDSTILL_H_
