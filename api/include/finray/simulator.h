#ifndef FINRAY_SIMULATOR_H_
#define FINRAY_SIMULATOR_H_

#include <cstdint>
#include <memory>
#include <string>

#include "finray/export.h"
#include "finray/finger.h"
#include "finray/scene.h"
#include "finray/table.h"

namespace finray::v1 {

/// How the beam equation is integrated, as --scheme and --resolution.
struct Discretization {
  std::string scheme = "taylor";
  int resolution = 0;  ///< Elements over both beams; 0: the default.
};

struct Simulation {
  /// The rows with gauges, ribs, rib pins, tip, contact poses, force_N and
  /// status filled in.
  Table frames;
  /// Both beams of every row, if asked for: row, beam, arc_mm, x_mm, y_mm,
  /// angle_rad, moment_N_mm.
  Table shapes;
  int contact = 0, free = 0, not_converged = 0;
  std::string
      first_failure;  ///< Why the first row without a solution has none.
};

/// Std of the noise of a simulated log. Gauges have their own noise_V.
struct LogNoise {
  double force_std_N = 0.02;
  double object_std_mm = 0.05;
  double pin_std_mm = 0;  ///< 0: no camera.
  std::uint64_t seed = 1;
};

/// Solves a finger for given contacts or places of an object, as
/// finray_simulate does.
class FINRAY_API Simulator {
 public:
  /// Throws InputError for an unknown scheme.
  explicit Simulator(const Finger& finger, const Scene& scene = Scene(),
                     const Discretization& discretization = {});
  ~Simulator();
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  /// Rows have `contact_<c>_mm`, `normal_<c>_N` and perhaps `friction_<c>`, or
  /// object_x_mm and object_y_mm of the scene's object. Throws InputError at a
  /// row whose load is incomplete, negative or off the beam.
  Simulation Simulate(const Table& frames, bool shapes = false) const;

  /// The log that a lab would record of simulated frames: time_s,
  /// `gauge_<j>_V`, force_N, the object's place; with noise, without the true
  /// contacts.
  Table MakeLog(const Table& simulated, const LogNoise& noise = {}) const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace finray::v1

#endif  // FINRAY_SIMULATOR_H_
