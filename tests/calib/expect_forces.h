#ifndef FINRAY_TESTS_CALIB_EXPECT_FORCES_H_
#define FINRAY_TESTS_CALIB_EXPECT_FORCES_H_

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "calib/standard_log.h"
#include "finray/batch/batch_estimation.h"
#include "finray/scene/measurement_columns.h"

namespace finray {

/// That Ceres, in both forms, finds the same forces and intervals in a log of
/// `truth` with `found` as the fast solver, and that these intervals hold about
/// as often as they say.
inline void ExpectForces(const Finger& truth, const Finger& found,
                         unsigned seed,
                         const Scene& pressed = StandardScene()) {
  const FrameTable frames = StandardFrames(truth, seed, pressed);
  const FrameTable log = MakeLog(truth, frames, {0, 0, seed});
  const std::vector<Measurements> rows = ReadMeasurements(log, found);
  Scene scene;
  scene.contacts = 1;
  scene.friction_coefficient = pressed.friction_coefficient;
  const std::vector<FrameEstimate> fast =
      EstimateFrames(found, scene, {}, rows, 2);
  const FrameSolver ceres =
      FrameSolvers(found, scene, {}, FrameMethod::kCeresReduced)();
  const FrameSolver weighted =
      FrameSolvers(found, scene, {}, FrameMethod::kCeresWeighted)();
  int usable = 0, within = 0, compared = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double force = frames.Numbers("force_N")[i] /
                         std::hypot(1, scene.friction_coefficient);
    if (fast[i].status != FrameStatus::kOk || force < 0.3) continue;
    const auto& contact = fast[i].contact[0];
    ++usable;
    within += std::abs(contact.normal_N - force) < 1.96 * contact.normal_std_N;
    if (i % 40 != 1) continue;
    ++compared;
    for (const FrameSolver& solver : {ceres, weighted}) {
      FrameEstimate slow;
      solver(&rows[i], 1, &slow);
      EXPECT_NEAR(slow.contact[0].normal_N, contact.normal_N,
                  0.05 * contact.normal_std_N);
      EXPECT_NEAR(slow.contact[0].normal_std_N, contact.normal_std_N,
                  0.03 * contact.normal_std_N);
    }
  }
  EXPECT_GT(usable, 100);
  EXPECT_GT(compared, 1);
  EXPECT_GT(within, 0.85 * usable);
}

}  // namespace finray

#endif  // FINRAY_TESTS_CALIB_EXPECT_FORCES_H_
