#include "finray/benchmark/runner.h"

namespace finray {

Runner::Runner(const BenchmarkCase& c) : case_(c), answers_(kStretchFrames) {
  for (FrameAnswer& answer : answers_) {
    answer.contacts.resize(2);
    answer.gauges_rad.resize(static_cast<Eigen::Index>(c.finger.gauges.size()));
  }
}

FrameAnswer SensingRunner::Answer(int k) {
  FrameAnswer answer = answers_[k];
  answer.solved = answer.solved && model_.Solve(answer.contacts);
  if (answer.solved) {
    answer.gauges_rad = model_.outputs().head(model_.model().gauges());
  }
  return answer;
}

}  // namespace finray
