#include "finray/benchmark/answers.h"
#include "finray/sensing/fast/frame_group_fit.h"

namespace finray {
namespace {

class InLanes : public Runner {
 public:
  InLanes(const BenchmarkCase& c, const Discretization& discretization,
          double tolerance)
      : case_(c),
        start_(c.finger, discretization),
        gauges_(c.finger, discretization),
        fit_(c.finger, discretization, c.scene.friction_coefficient),
        angles_(c.finger.gauges.size(), c.frames.size()),
        weights_(c.finger.gauges.size(), c.frames.size()),
        fits_(kStretchFrames) {
    fit_.set_tolerance(tolerance);
    for (std::size_t i = 0; i < c.frames.size(); ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      angles_.col(column) = c.frames[i].measurement.values;
      weights_.col(column) = c.frames[i].measurement.weights;
    }
  }

  void Start(int lead_in) override {
    const PointContact& contact = case_.frames[lead_in].contacts.at(0);
    start_.Solve({contact});
    fit_.Start(start_.state(), contact);
    Run(lead_in, 1);
  }

  void Run(int first, int count) override {
    fit_.Fit(angles_.middleCols(first, count),
             weights_.middleCols(first, count), fits_.data());
  }

  FrameAnswer Answer(int k) override {
    const FrameFit& fit = fits_[k];
    const PointContact contact = {fit.arc_mm, fit.normal_N,
                                  case_.scene.friction_coefficient};
    return gauges_.Completed(
        {fit.converged, {contact}, {}, fit.tip_pose, fit.iterations});
  }
  int unknowns() const override { return start_.unknowns() + 2; }

 private:
  const BenchmarkCase& case_;
  EquilibriumSolver start_;
  GaugesAt gauges_;
  FrameGroupFit fit_;
  Eigen::MatrixXd angles_, weights_;
  std::vector<FrameFit> fits_;
};

}  // namespace

std::unique_ptr<Runner> MakeLanes(const BenchmarkCase& c,
                                  const Discretization& discretization,
                                  double tolerance) {
  return std::make_unique<InLanes>(c, discretization, tolerance);
}

}  // namespace finray
