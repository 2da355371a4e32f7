#ifndef FINRAY_BENCHMARK_ANSWERS_H_
#define FINRAY_BENCHMARK_ANSWERS_H_

#include <vector>

#include "finray/benchmark/runner.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// Answers whose memory is there before the clock starts.
inline std::vector<FrameAnswer> RoomForAnswers(const BenchmarkCase& c) {
  FrameAnswer empty;
  empty.contacts.resize(2);
  empty.gauges_rad.resize(static_cast<Eigen::Index>(c.finger.gauges.size()));
  return std::vector<FrameAnswer>(kStretchFrames, empty);
}

/// Gauge angles that contacts which were sensed make in the same model: solvers
/// of gauges do not tell them.
class GaugesAt {
 public:
  GaugesAt(const Finger& finger, const Discretization& discretization)
      : solver_(finger, discretization) {}
  FrameAnswer Completed(FrameAnswer answer) {
    if (answer.solved && solver_.Solve(answer.contacts)) {
      answer.gauges_rad = solver_.outputs().head(solver_.model().gauges());
    } else {
      answer.solved = false;
    }
    return answer;
  }

 private:
  EquilibriumSolver solver_;
};

}  // namespace finray

#endif  // FINRAY_BENCHMARK_ANSWERS_H_
