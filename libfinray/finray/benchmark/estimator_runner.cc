#include "finray/benchmark/answers.h"
#include "finray/sensing/frame_estimator.h"

namespace finray {
namespace {

class Estimator : public Runner {
 public:
  Estimator(const BenchmarkCase& c, const Discretization& discretization,
            EstimatorUse use)
      : case_(c),
        use_(use),
        estimator_(c.finger, c.scene, discretization),
        gauges_(c.finger, discretization),
        model_(c.finger, discretization),
        estimates_(kStretchFrames) {
    for (const BenchmarkFrame& frame : c.frames) {
      readings_.push_back(frame.readings);
    }
    model_.Solve(c.frames[0].contacts);
  }

  void Start(int lead_in) override {
    if (use_ == EstimatorUse::kLive) estimator_.Follow(readings_[lead_in]);
  }

  void Run(int first, int count) override {
    switch (use_) {
      case EstimatorUse::kBlock:
        estimator_.EstimateBlock(&readings_[first],
                                 static_cast<std::size_t>(count),
                                 estimates_.data());
        break;
      case EstimatorUse::kLive:
        for (int k = 0; k < count; ++k) {
          estimates_[k] = estimator_.Follow(readings_[first + k]);
        }
        break;
      case EstimatorUse::kSearch:
        for (int k = 0; k < count; ++k) {
          estimates_[k] = estimator_.Estimate(readings_[first + k]);
        }
    }
  }

  FrameAnswer Answer(int k) override {
    const FrameEstimate& estimate = estimates_[k];
    FrameAnswer answer;
    answer.solved = estimate.status != FrameStatus::kNotConverged &&
                    estimate.status != FrameStatus::kBadInput;
    for (int c = 0; c < estimate.contacts; ++c) {
      answer.contacts.push_back({estimate.contact[c].arc_mm,
                                 estimate.contact[c].normal_N,
                                 case_.scene.friction_coefficient});
    }
    answer.tip_pose = estimate.tip_pose;
    answer.iterations = estimate.iterations;
    return gauges_.Completed(answer);
  }
  int unknowns() const override {
    return model_.unknowns() + 2 * case_.scene.contacts.value_or(0);
  }

 private:
  const BenchmarkCase& case_;
  EstimatorUse use_;
  FrameEstimator estimator_;
  GaugesAt gauges_;
  EquilibriumSolver model_;
  std::vector<Measurements> readings_;
  std::vector<FrameEstimate> estimates_;
};

}  // namespace

std::unique_ptr<Runner> MakeEstimator(const BenchmarkCase& c,
                                      const Discretization& discretization,
                                      EstimatorUse use) {
  return std::make_unique<Estimator>(c, discretization, use);
}

}  // namespace finray
