#ifndef FINRAY_SCENE_GAUGE_FAULTS_H_
#define FINRAY_SCENE_GAUGE_FAULTS_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "finray/finger/finger.h"
#include "finray/scene/gauge_standstill.h"
#include "finray/scene/measurements.h"

namespace finray {

/// What is wrong with the device behind a gauge, seen in its readings alone.
struct GaugeFault {
  enum class Kind {
    kAllStill,  ///< All gauges do not move, or are frozen.
    kStill,     ///< It hardly moves while the others do.
    kClipped,   ///< It ends at a value that many rows share.
    kCoarse,    ///< It has steps far above its noise.
  };
  Kind kind;
  int gauge = 0;      ///< Not of kAllStill.
  double step_V = 0;  ///< Of kCoarse.
  /// "gauge 2 is stuck at 0.123 V from row 31 to 80 while the others move".
  std::string words;
};

/// Looks for faults in the rows of a log without a model of the finger, so that
/// no effect of a finger is blamed for them. Its memory does not grow with the
/// log.
///
/// A gauge j stands still in kStillRows or more rows one after another whose
/// readings are the same number, or, over all rows or kStillBlocks or more of
/// kMostBlocks blocks of rows at the begin or the end of the log, scatter no
/// more than noise: their range is below kNoiseRange noise_V, and half of them
/// have a reading. It is clipped if kClippedRows or more rows share its
/// greatest or its least reading, and more than kPiledUp times as many as share
/// the next one, which a converter's steps alone do not make. Both count only
/// if the others move in these rows: one of them by more than kMoves times the
/// greater of its own noise_V and the step of j, over blocks all of them by
/// half of what they move in the log. It stands still too if it is frozen
/// (GaugeStandstill), has no steps above half its noise_V, and another moves by
/// kNoiseRange in these rows. It is coarse if all of its readings are multiples
/// of a step above kCoarseStep noise_V (StepOf). Rows that repeat all gauges
/// are no fault, unless GaugeStandstill finds that all are frozen. If all stand
/// still, that is the only fault.
class GaugeFaultFinder {
 public:
  static constexpr int kStillRows = 20, kClippedRows = 5, kStillBlocks = 4;
  static constexpr std::size_t kMostBlocks = 64;
  static constexpr double kMoves = 30, kCoarseStep = 2, kPiledUp = 3,
                          kNoiseRange = GaugeStandstill::kNoiseRange;

  explicit GaugeFaultFinder(const Finger& finger);
  /// Takes the next row, which counts from 1.
  void Add(std::size_t row, const Measurements& readings);
  std::vector<GaugeFault> Faults() const;

 private:
  struct Range {
    double low, high;
    std::size_t readings = 0;
    Range();
    void Add(double volts);
    void Add(const Range& other);
    double width() const { return high > low ? high - low : 0; }
  };
  // Rows in which a gauge reads the same, and where all gauges move in them.
  struct Same {
    double volts = 0;
    std::size_t rows = 0, first = 0, last = 0;
    std::vector<Range> all;
  };
  struct Block {
    std::size_t rows = 0, first = 0, last = 0;
    std::vector<Range> all;
  };
  // The least or the greatest reading, and the next one.
  struct Extreme {
    Same at;
    double next_V = 0;
    std::size_t next_rows = 0;
  };
  struct Series {
    Same run, longest;
    Extreme least, greatest;
    std::vector<double> some_V;  // readings for StepOf
  };

  static void Begin(double volts, std::size_t row, Same* same);
  void AddTo(std::size_t row, const std::vector<double>& readings_V,
             Same* same) const;
  // `sign` is -1 for the least one.
  void AddToExtreme(double sign, double volts, std::size_t row,
                    const std::vector<double>& readings_V,
                    Extreme* extreme) const;
  double MovedBy(const std::vector<Range>& all, int gauge, double step_V) const;
  std::optional<double> StepOfGauge(int gauge) const;
  std::optional<GaugeFault> AllStill() const;
  std::optional<GaugeFault> Still(int gauge, double step_V) const;
  std::optional<GaugeFault> StillInBlocks(int gauge) const;
  std::optional<GaugeFault> Clipped(int gauge, double step_V) const;

  GaugeStandstill standstill_;
  std::vector<Gauge> laws_;
  std::vector<double> measured_V_;  // of the last row, NaN where saturated
  std::vector<Series> gauges_;
  std::vector<Range> all_;
  std::vector<Block> blocks_;
  std::size_t rows_of_block_ = 1, rows_ = 0;
};

/// The words of the faults that are steps of converters, or of all others.
std::string WordsOf(const std::vector<GaugeFault>& faults, bool steps);

/// Returns the step of which all differences of these readings are multiples,
/// if there is one above `least`.
std::optional<double> StepOf(std::vector<double> readings_V, double least);

}  // namespace finray

#endif  // FINRAY_SCENE_GAUGE_FAULTS_H_
