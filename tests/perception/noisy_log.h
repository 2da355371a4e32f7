#ifndef FINRAY_TESTS_PERCEPTION_NOISY_LOG_H_
#define FINRAY_TESTS_PERCEPTION_NOISY_LOG_H_

#include <Eigen/Core>
#include <cstdint>
#include <random>

#include "finray/io/frame_table.h"
#include "finray/scene/clean_readings.h"
#include "finray/scene/frame_columns.h"

namespace finray {

/// Noise of a simulated log.
struct LogNoise {
  bool gauges = true;       ///< Every gauge has its own noise_V.
  double stage_std_mm = 0;  ///< of object_x_mm and object_y_mm
  std::uint64_t seed = 1;
};

/// A log with gauge_<j>_V, object_x_mm, object_y_mm and force_N, written row by
/// row. The force has no noise.
class NoisyLog {
 public:
  NoisyLog(int rows, const LogNoise& noise, std::uint64_t seed)
      : table_(static_cast<std::size_t>(rows)),
        noise_(noise),
        generator_(seed) {}

  /// Writes the gauges of the solver's equilibrium and the object's place.
  void Write(int row, const EquilibriumSolver& solver,
             const Eigen::Vector2d& place_mm, double force_N) {
    const std::vector<double> volts = CleanReadings(solver).gauges_V;
    for (int j = 0; j < static_cast<int>(volts.size()); ++j) {
      const Gauge& gauge = solver.model().finger().gauges[j];
      table_.MutableNumbers(GaugeVolts(j))[row] =
          volts[j] + Error(noise_.gauges ? gauge.noise_V : 0);
    }
    table_.MutableNumbers("object_x_mm")[row] =
        place_mm.x() + Error(noise_.stage_std_mm);
    table_.MutableNumbers("object_y_mm")[row] =
        place_mm.y() + Error(noise_.stage_std_mm);
    table_.MutableNumbers("force_N")[row] = force_N;
  }

  FrameTable& table() { return table_; }

 private:
  double Error(double std) { return std > 0 ? std * normal_(generator_) : 0.0; }

  FrameTable table_;
  LogNoise noise_;
  std::mt19937_64 generator_;
  std::normal_distribution<double> normal_;
};

}  // namespace finray

#endif  // FINRAY_TESTS_PERCEPTION_NOISY_LOG_H_
