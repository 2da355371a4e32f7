#include "finray/benchmark/runner.h"
#include "finray/sensing/frame_estimator.h"

namespace finray {
namespace {

class Estimator : public SensingRunner {
 public:
  Estimator(const BenchmarkCase& c, const Discretization& discretization,
            EstimatorUse use, FrameMethod method)
      : SensingRunner(c, discretization),
        use_(use),
        estimator_(c.finger, c.scene, discretization, method),
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
    if (use_ == EstimatorUse::kBlock) {
      estimator_.EstimateBlock(&readings_[first],
                               static_cast<std::size_t>(count),
                               estimates_.data());
      return;
    }
    for (int k = 0; k < count; ++k) {
      const Measurements& readings = readings_[first + k];
      estimates_[k] = use_ == EstimatorUse::kLive
                          ? estimator_.Follow(readings)
                          : estimator_.Estimate(readings);
    }
  }

  FrameAnswer Answer(int k) override {
    const FrameEstimate& estimate = estimates_[k];
    FrameAnswer& answer = answers_[k];
    answer.solved = estimate.status != FrameStatus::kNotConverged &&
                    estimate.status != FrameStatus::kBadInput;
    answer.contacts.clear();
    for (int c = 0; c < estimate.contacts; ++c) {
      answer.contacts.push_back({estimate.contact[c].arc_mm,
                                 estimate.contact[c].normal_N,
                                 case_.scene.friction_coefficient});
    }
    answer.tip_pose = estimate.tip_pose;
    answer.iterations = estimate.iterations;
    return SensingRunner::Answer(k);
  }

  int unknowns() const override {
    return model_.unknowns() + 2 * case_.scene.contacts.value_or(0);
  }

 private:
  EstimatorUse use_;
  FrameEstimator estimator_;
  std::vector<Measurements> readings_;
  std::vector<FrameEstimate> estimates_;
};

}  // namespace

RunnerMaker EstimatorRunner(const Discretization& discretization,
                            EstimatorUse use, FrameMethod method) {
  return MakerOf<Estimator>(discretization, use, method);
}

}  // namespace finray
