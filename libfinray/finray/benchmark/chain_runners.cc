#include "finray/benchmark/runner.h"
#include "finray/chain/forward.h"
#include "finray/chain/sensing.h"

namespace finray {
namespace {

// Ceres compares costs: under a model weight of 1e6 the share of the gauges has
// no digits left.
constexpr double kCeresModelWeight = 1e3;
// Newton stops after a step below this; the error is of its square.
constexpr double kLastStep = 1e-3;

using LinearSolver = std::optional<ceres::LinearSolverType>;

class Chain : public Runner {
 public:
  Chain(const BenchmarkCase& c, int links, LinearSolver linear_solver)
      : Runner(c),
        layout_(MakeChainLayout(c.finger, links, GaugeRule::kOverlap)),
        linear_solver_(linear_solver) {}

  int unknowns() const override { return layout_.joints() + layout_.loads(); }

 protected:
  PointContact LoadOf(int frame) const {
    const auto& contacts = case_.frames[frame].contacts;
    if (contacts.empty()) return {case_.finger.front_length_mm / 2, 0, 0};
    return contacts[0];
  }

  void Keep(const ChainState& state, FrameAnswer* answer) const {
    answer->gauges_rad = layout_.gauges * state.theta;
    const auto poses = Kinematics(layout_.chain, state.theta.data());
    const Pose<double>& end = poses.after[layout_.front_joint_mm.size()];
    answer->tip_pose << end * Vector2<double>(0, layout_.length_unit_mm),
        M_PI / 2 + std::atan2(end.s, end.c);
  }

  ChainLayout layout_;
  LinearSolver linear_solver_;  // of ceres::Solve; none: the paper's Newton
};

class ChainForward : public Chain {
 public:
  using Chain::Chain;

  void Start(int lead_in) override {
    SolveForward(layout_, LoadOf(lead_in), &state_);
  }

  void Run(int first, int count) override {
    for (int k = 0; k < count; ++k) {
      const PointContact load = LoadOf(first + k);
      FrameAnswer& answer = answers_[k];
      answer.solved =
          linear_solver_
              ? ContinueForwardWithCeres(layout_, load, *linear_solver_,
                                         &state_, &answer.iterations)
              : ContinueForward(layout_, load, kLastStep, &state_,
                                &answer.iterations);
      answer.contacts = case_.frames[first + k].contacts;
      Keep(state_, &answer);
    }
  }

 private:
  ChainState state_;
};

class ChainSenses : public Chain {
 public:
  ChainSenses(const BenchmarkCase& c, int links, LinearSolver linear_solver)
      : Chain(c, links, linear_solver) {
    for (const Gauge& gauge : c.finger.gauges) {
      least_std_rad_ = std::min(least_std_rad_, 1 / gauge.AngleWeight());
    }
    ceres_options_.model_weight = kCeresModelWeight;
  }

  void Start(int lead_in) override { contact_ = LoadOf(lead_in); }

  void Run(int first, int count) override {
    for (int k = 0; k < count; ++k) {
      const Eigen::VectorXd& s0 = case_.frames[first + k].measurement.values;
      const ChainSensing sensed =
          linear_solver_
              ? SenseContactWithCeres(layout_, s0, contact_, least_std_rad_,
                                      ceres_options_, *linear_solver_)
              : SenseContact(layout_, s0, contact_);
      FrameAnswer& answer = answers_[k];
      answer.solved = sensed.converged;
      answer.iterations = sensed.iterations;
      answer.contacts.assign(1, sensed.contact);
      Keep(sensed.state, &answer);
      contact_ = sensed.converged ? sensed.contact : LoadOf(first + k);
    }
  }

  int unknowns() const override { return Chain::unknowns() + 2; }

 private:
  double least_std_rad_ = std::numeric_limits<double>::infinity();
  ChainSensingOptions ceres_options_;
  PointContact contact_;
};

}  // namespace

RunnerMaker ChainForwardRunner(int links, LinearSolver linear_solver) {
  return MakerOf<ChainForward>(links, linear_solver);
}

RunnerMaker ChainSensingRunner(int links, LinearSolver linear_solver) {
  return MakerOf<ChainSenses>(links, linear_solver);
}

}  // namespace finray
