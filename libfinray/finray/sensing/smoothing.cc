#include "finray/sensing/smoothing.h"

#include <algorithm>
#include <cmath>

#include "finray/sensing/block_tridiagonal.h"
#include "finray/sensing/log_problem.h"

namespace finray {
namespace {

// Smooths a run of frames with one contact each.
LogPrior SmoothRun(const Finger& finger, const Scene& scene,
                   const Discretization& discretization,
                   const Measurements* readings, std::size_t count,
                   const LogPrior& before, FrameEstimate* estimates) {
  const Eigen::VectorXd offsets_V = GaugeOffsets(finger);
  std::vector<LogFrame> frames(count);
  for (std::size_t t = 0; t < count; ++t) {
    LogFrame& frame = frames[t];
    frame.row = readings[t];
    frame.role = LogFrame::Role::kTouching;
    frame.noise_scale = estimates[t].noise_scale();
    frame.arc_mm = estimates[t].contact[0].arc_mm;
    frame.normal_N = frame.expected_N = estimates[t].contact[0].normal_N;
    frame.offset_V = offsets_V;
  }
  LogProblem problem(finger, scene, discretization, 1, &frames, before);
  problem.Solve();
  if (!problem.converged()) return {};  // the frames remain what they are
  const std::vector<LogMarginal> marginals = problem.Marginals();
  // A frame alone has nothing to be smoothed with, but the next may have.
  for (std::size_t t = 0; t < count && (count > 1 || before.mean.size() > 0);
       ++t) {
    frames[t].CopyTo(marginals[t].covariance, &estimates[t]);
  }
  Eigen::MatrixXd next = marginals.back().covariance;
  next(0, 0) += std::pow(scene.smoothing->contact_mm, 2);
  next(1, 1) += std::pow(scene.smoothing->normal_N, 2);
  return {Eigen::Vector2d(frames.back().arc_mm, frames.back().normal_N),
          InverseInformation(next)};
}

}  // namespace

LogPrior Smooth(const Finger& finger, const Scene& scene,
                const Discretization& discretization,
                const Measurements* readings, std::size_t count,
                const LogPrior& before, FrameEstimate* estimates) {
  LogPrior known = before;
  for (std::size_t begin = 0; begin < count;) {
    std::size_t end = begin;
    while (end < count && estimates[end].contacts == 1) ++end;
    if (end > begin) {
      known = SmoothRun(finger, scene, discretization, readings + begin,
                        end - begin, known, estimates + begin);
    }
    if (end < count) known = {};
    begin = std::max(end, begin + 1);
  }
  return known;
}

}  // namespace finray
