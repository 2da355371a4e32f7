#ifndef FINRAY_BENCHMARK_RUNNERS_H_
#define FINRAY_BENCHMARK_RUNNERS_H_

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "finray/benchmark/setting.h"
#include "finray/chain/forward.h"
#include "finray/chain/sensing.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/estimation/frame_problem.h"
#include "finray/estimation/gauge_table.h"
#include "finray/estimation/row_fit.h"

namespace finray {

/// Solves the ladder for a known load, or for a known object, to a tolerance.
/// `cold`: every frame starts from the undeformed finger.
class LadderForward : public Runner {
 public:
  LadderForward(const BenchmarkCase& c, const Discretization& discretization,
                double tolerance, bool cold)
      : Runner(c), solver_(c.finger, discretization), cold_(cold) {
    solver_.set_tolerance(tolerance);
  }

  int unknowns() const override {
    return solver_.unknowns() + 2 * static_cast<int>(touch_.contacts.size());
  }

 private:
  void StartAt(int /*frame*/) override {
    solver_.Reset();
    touch_ = {};
  }

  void Solve(int frame, FrameAnswer* answer) override {
    const BenchmarkFrame& given = case_.frames[frame];
    if (cold_) solver_.Reset();
    if (case_.scene.object) {
      if (cold_) touch_.contacts.clear();
      touch_ = SolveObjectContact(*case_.scene.object, given.object, 0,
                                  &solver_, touch_.contacts);
      answer->solved = touch_.status == ObjectContactStatus::kContact;
      answer->contacts = touch_.contacts;
    } else {
      answer->solved = solver_.Solve(given.contacts);
      answer->contacts = given.contacts;
    }
    if (!answer->solved) return;
    answer->gauges_rad = solver_.outputs().head(solver_.model().gauges());
    answer->tip_pose = solver_.tip_pose();
    answer->iterations = solver_.iterations();
  }

  EquilibriumSolver solver_;
  bool cold_;
  ObjectContact touch_;
};

/// A runner whose solver finds contacts on a ladder. Answer adds the gauge
/// angles that these contacts cause in the same discretization.
class SensingRunner : public Runner {
 public:
  SensingRunner(const BenchmarkCase& c, const Discretization& discretization)
      : Runner(c), model_(c.finger, discretization) {}

  FrameAnswer Answer(int k) override {
    FrameAnswer answer = answers_[k];
    answer.solved = answer.solved && model_.Solve(answer.contacts);
    if (answer.solved) {
      answer.gauges_rad = model_.outputs().head(model_.model().gauges());
    }
    return answer;
  }

 protected:
  EquilibriumSolver model_;
};

/// Senses contacts frame by frame with RowFit; each frame starts from the one
/// before. `surface`: one contact on a ModelSurface, whose cells are not timed.
class FrameByFrame : public SensingRunner {
 public:
  FrameByFrame(const BenchmarkCase& c, const Discretization& discretization,
               bool surface)
      : SensingRunner(c, discretization) {
    const double most_N = GaugeTable::HeaviestForce_N(c.finger);
    if (surface) {
      surface_.emplace(
          RowFit::SurfaceFor(c.finger, c.scene, discretization, most_N));
    }
    fit_.emplace(c.finger, c.scene, discretization,
                 surface ? &*surface_ : nullptr, most_N);
    if (!surface) return;
    for (std::size_t i = 0; i < c.frames.size(); ++i) {
      const int frame = static_cast<int>(i);
      StartAt(frame);
      Solve(frame, &answers_[0]);
    }
  }

  int unknowns() const override {
    return 2 * last_.count + (surface_ ? 0 : model_.unknowns());
  }

 private:
  void StartAt(int frame) override {
    const auto& contacts = case_.frames[frame].contacts;
    model_.Solve(contacts);
    last_.count = static_cast<int>(contacts.size());
    std::copy(contacts.begin(), contacts.end(), last_.contacts.begin());
    last_.state = model_.state();
  }

  void Solve(int frame, FrameAnswer* answer) override {
    const ContactStart start = {last_.count, last_.contacts, 0, &last_.state};
    fit_->set_row(case_.frames[frame].readings);
    answer->solved = fit_->Fit(
        start, surface_ ? RowFit::Model::kSurface : RowFit::Model::kEquilibria,
        RowFit::kMostEvaluations, &found_);
    answer->iterations = fit_->evaluations();
    if (!answer->solved) return StartAt(frame);
    answer->contacts.assign(found_.contacts.begin(),
                            found_.contacts.begin() + found_.count);
    answer->tip_pose = found_.tip_pose;
    last_.contacts = found_.contacts;
    if (!surface_) std::swap(last_.state, found_.state);
  }

  std::optional<ModelSurface> surface_;
  std::optional<RowFit> fit_;
  ContactSolution last_, found_;
};

/// Senses contacts frame by frame with FrameProblem, that is with ceres::Solve
/// on the residual blocks; each frame starts from the one before.
class CeresFrames : public SensingRunner {
 public:
  CeresFrames(const BenchmarkCase& c, EquilibriumForm form)
      : SensingRunner(c, {}),
        form_(form),
        problem_(c.finger, c.scene, {}, form,
                 std::numeric_limits<double>::max()) {}

  int unknowns() const override {
    // Base loads and rib tensions are unknowns of the weighted form alone.
    const int loads = 6 + static_cast<int>(case_.finger.ribs.size());
    return 2 * last_.count + (form_ == EquilibriumForm::kWeighted ? loads : 0);
  }

 private:
  void StartAt(int frame) override {
    const auto& contacts = case_.frames[frame].contacts;
    model_.Solve(contacts);
    last_.count = static_cast<int>(contacts.size());
    std::copy(contacts.begin(), contacts.end(), last_.contacts.begin());
    last_.state = model_.state();
  }

  void Solve(int frame, FrameAnswer* answer) override {
    const ContactStart start = {last_.count, last_.contacts, 0, &last_.state};
    answer->solved = problem_.Fit(start, case_.frames[frame].readings, &found_);
    answer->contacts.assign(found_.contacts.begin(),
                            found_.contacts.begin() + found_.count);
    answer->tip_pose = found_.tip_pose;
    answer->iterations = problem_.iterations();
    if (answer->solved) {
      std::swap(last_, found_);
    } else {
      StartAt(frame);
    }
  }

  EquilibriumForm form_;
  FrameProblem problem_;
  ContactSolution last_, found_;
};

enum class EstimatorUse {
  kBlock,   ///< Blocks of frames, as for logs; only the first is searched.
  kLive,    ///< Frame by frame, as for --follow.
  kSearch,  ///< Every frame is searched on its own.
};

/// Does all that finray_estimate does with a frame, with FrameEstimator.
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
    if (use_ == EstimatorUse::kLive) estimator_.Next(readings_[lead_in]);
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
                          ? estimator_.Next(readings)
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

/// The paper's dense chain of `links` links, with its own Newton methods or
/// with ceres::Solve and `linear_solver`.
class ChainRunner : public Runner {
 public:
  using LinearSolver = std::optional<ceres::LinearSolverType>;

  ChainRunner(const BenchmarkCase& c, int links, LinearSolver linear_solver)
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
  LinearSolver linear_solver_;
};

/// Solves the chain for a known load.
class ChainForward : public ChainRunner {
 public:
  using ChainRunner::ChainRunner;

  void Start(int lead_in) override {
    SolveForward(layout_, LoadOf(lead_in), &state_);
  }

 private:
  void Solve(int frame, FrameAnswer* answer) override {
    // Newton stops after a step below this; the error is of its square.
    constexpr double kLastStep = 1e-3;
    const PointContact load = LoadOf(frame);
    answer->solved =
        linear_solver_
            ? ContinueForwardWithCeres(layout_, load, *linear_solver_, &state_,
                                       &answer->iterations)
            : ContinueForward(layout_, load, kLastStep, &state_,
                              &answer->iterations);
    answer->contacts = case_.frames[frame].contacts;
    Keep(state_, answer);
  }

  ChainState state_;
};

/// Senses a contact on the chain, with the paper's Newton method (18) of
/// chain/sensing.h or with ceres::Solve.
class ChainSenses : public ChainRunner {
 public:
  ChainSenses(const BenchmarkCase& c, int links, LinearSolver linear_solver)
      : ChainRunner(c, links, linear_solver) {
    for (const Gauge& gauge : c.finger.gauges) {
      least_std_rad_ = std::min(least_std_rad_, 1 / gauge.AngleWeight());
    }
  }

  void Start(int lead_in) override { contact_ = LoadOf(lead_in); }
  int unknowns() const override { return ChainRunner::unknowns() + 2; }

 private:
  void Solve(int frame, FrameAnswer* answer) override {
    // Ceres compares costs: under a model weight of 1e6 the share of the gauges
    // has no digits left.
    constexpr double kCeresWeight = 1e3;
    const Eigen::VectorXd& s0 = case_.frames[frame].measurement.values;
    const ChainSensing sensed =
        linear_solver_
            ? SenseContactWithCeres(layout_, s0, contact_, least_std_rad_,
                                    kCeresWeight, *linear_solver_)
            : SenseContact(layout_, s0, contact_);
    answer->solved = sensed.converged;
    answer->iterations = sensed.iterations;
    answer->contacts.assign(1, sensed.contact);
    Keep(sensed.state, answer);
    contact_ = sensed.converged ? sensed.contact : LoadOf(frame);
  }

  double least_std_rad_ = std::numeric_limits<double>::infinity();
  PointContact contact_;
};

}  // namespace finray

#endif  // FINRAY_BENCHMARK_RUNNERS_H_
