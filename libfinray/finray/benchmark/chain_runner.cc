// The paper's chain, by its own Newton and by ceres::Solve.

#include <ceres/types.h>

#include <functional>

#include "finray/benchmark/answers.h"
#include "finray/chain/ceres_chain.h"
#include "finray/chain/forward.h"

namespace finray {
namespace {

// Ceres compares costs, in which gauges under a model of weight 1e6 have no
// digits left.
constexpr double kCeresModelWeight = 1e3;
// Newton's last step; the error is of its square.
constexpr double kLastStep = 1e-3;

ceres::LinearSolverType TypeOf(CeresLinearSolver linear_solver) {
  switch (linear_solver) {
    case CeresLinearSolver::kDenseQr:
      return ceres::DENSE_QR;
    case CeresLinearSolver::kDenseNormalCholesky:
      return ceres::DENSE_NORMAL_CHOLESKY;
    case CeresLinearSolver::kSparseNormalCholesky:
      break;
  }
  return ceres::SPARSE_NORMAL_CHOLESKY;
}

PointContact LoadOf(const BenchmarkCase& c, int frame) {
  const auto& contacts = c.frames[frame].contacts;
  if (contacts.empty()) return {c.finger.front_length_mm / 2, 0, 0};
  return contacts[0];
}

// (x, y, theta) of the front beam's end.
Eigen::Vector3d TipPoseOf(const ChainLayout& layout, const ChainState& state) {
  const auto poses = Kinematics(layout.chain, state.theta.data());
  const Pose<double>& end = poses.after[layout.front_joint_mm.size()];
  const Eigen::Vector2d tip = end * Vector2<double>(0, layout.length_unit_mm);
  return {tip.x(), tip.y(), M_PI / 2 + std::atan2(end.s, end.c)};
}

class Chain : public Runner {
 public:
  Chain(const BenchmarkCase& c, int links)
      : case_(c),
        layout_(MakeChainLayout(c.finger, links, GaugeRule::kOverlap)),
        answers_(RoomForAnswers(c)) {}

  FrameAnswer Answer(int k) override { return answers_[k]; }

 protected:
  void Keep(const ChainState& state, FrameAnswer* answer) const {
    answer->gauges_rad = layout_.gauges * state.theta;
    answer->tip_pose = TipPoseOf(layout_, state);
  }

  const BenchmarkCase& case_;
  ChainLayout layout_;
  std::vector<FrameAnswer> answers_;
};

class ChainForward : public Chain {
 public:
  using Solve = std::function<bool(const ChainLayout&, const PointContact&,
                                   ChainState*, int*)>;
  ChainForward(const BenchmarkCase& c, int links, Solve solve)
      : Chain(c, links), solve_(std::move(solve)) {}

  void Start(int lead_in) override {
    SolveForward(layout_, LoadOf(case_, lead_in), &state_);
  }
  void Run(int first, int count) override {
    for (int k = 0; k < count; ++k) {
      FrameAnswer& answer = answers_[k];
      answer.solved = solve_(layout_, LoadOf(case_, first + k), &state_,
                             &answer.iterations);
      answer.contacts = case_.frames[first + k].contacts;
      Keep(state_, &answer);
    }
  }
  int unknowns() const override { return layout_.joints() + layout_.loads(); }

 private:
  Solve solve_;
  ChainState state_;
};

class ChainSenses : public Chain {
 public:
  using Sense = std::function<ChainSensing(
      const ChainLayout&, const Eigen::VectorXd&, const PointContact&)>;
  ChainSenses(const BenchmarkCase& c, int links, Sense sense)
      : Chain(c, links), sense_(std::move(sense)) {}

  void Start(int lead_in) override { contact_ = LoadOf(case_, lead_in); }
  void Run(int first, int count) override {
    for (int k = 0; k < count; ++k) {
      FrameAnswer& answer = answers_[k];
      const ChainSensing sensed =
          sense_(layout_, case_.frames[first + k].measurement.values, contact_);
      answer.solved = sensed.converged;
      answer.iterations = sensed.iterations;
      answer.contacts.assign(1, sensed.contact);
      Keep(sensed.state, &answer);
      contact_ = sensed.converged ? sensed.contact : LoadOf(case_, first + k);
    }
  }
  int unknowns() const override {
    return layout_.joints() + layout_.loads() + 2;
  }

 private:
  Sense sense_;
  PointContact contact_;
};

}  // namespace

std::unique_ptr<Runner> MakePaperForward(const BenchmarkCase& c, int links) {
  return std::make_unique<ChainForward>(
      c, links,
      [](const ChainLayout& layout, const PointContact& contact,
         ChainState* state, int* iterations) {
        return ContinueForward(layout, contact, kLastStep, state, iterations);
      });
}

std::unique_ptr<Runner> MakePaperSensing(const BenchmarkCase& c, int links) {
  return std::make_unique<ChainSenses>(
      c, links,
      [](const ChainLayout& layout, const Eigen::VectorXd& s0,
         const PointContact& start) {
        return SenseContact(layout, s0, start);
      });
}

std::unique_ptr<Runner> MakeCeresForward(const BenchmarkCase& c, int links,
                                         CeresLinearSolver linear_solver) {
  return std::make_unique<ChainForward>(
      c, links,
      [type = TypeOf(linear_solver)](const ChainLayout& layout,
                                     const PointContact& contact,
                                     ChainState* state, int* iterations) {
        return ContinueForwardWithCeres(layout, contact, type, state,
                                        iterations);
      });
}

std::unique_ptr<Runner> MakeCeresSensing(const BenchmarkCase& c, int links,
                                         CeresLinearSolver linear_solver) {
  double least = std::numeric_limits<double>::infinity();
  for (const Gauge& gauge : c.finger.gauges) {
    least = std::min(least, 1 / gauge.AngleWeight());
  }
  return std::make_unique<ChainSenses>(
      c, links,
      [type = TypeOf(linear_solver), least](const ChainLayout& layout,
                                            const Eigen::VectorXd& s0,
                                            const PointContact& start) {
        ChainSensingOptions options;
        options.model_weight = kCeresModelWeight;
        return SenseContactWithCeres(layout, s0, start, least, options, type);
      });
}

}  // namespace finray
