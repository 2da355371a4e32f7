#ifndef FINRAY_BENCHMARK_NOISE_FLOOR_H_
#define FINRAY_BENCHMARK_NOISE_FLOOR_H_

#include <string>
#include <vector>

#include "finray/benchmark/benchmark_case.h"
#include "finray/io/nan.h"

namespace finray {

/// The errors that the finger's own gauge noise leaves in a scene, however
/// exact the solver is. Errors of a solver far below them are of no use. NaN
/// where the scene has no such value.
struct NoiseFloor {
  std::string scene;
  double gauge_rad = kNaN;   ///< The least std of a gauge's angle.
  double contact_mm = kNaN;  ///< Std of l_c, rms over frames and contacts.
  double normal_N = kNaN;    ///< Std of f_c, likewise.
};

/// Returns the noise floor of a case for the noise of `finger`, which may
/// differ from that of the case:
///
///   C = (J'WJ)^-1,  J = ds/d(l_c, f_c),  W = diag(1 / std^2),
///
/// at the true contacts. The std of a measured object is the scene's. Throws
/// std::runtime_error if a frame has no fit.
NoiseFloor NoiseFloorOf(const Finger& finger, const BenchmarkCase& c);

/// Returns the floor of a scene; all of it is NaN if there is none.
NoiseFloor FloorOf(const std::vector<NoiseFloor>& floors,
                   const std::string& scene);

}  // namespace finray

#endif  // FINRAY_BENCHMARK_NOISE_FLOOR_H_
