#include "finray/calib/solve/joint_solve.h"

#include <ceres/ordered_groups.h>
#include <ceres/problem.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "finray/io/number_text.h"
#include "finray/residuals/frame_set.h"
#include "finray/residuals/parameter_prior_residual.h"

namespace finray {
namespace {

// Tells each iteration to who waits.
class TellIteration : public ceres::IterationCallback {
 public:
  TellIteration(const CalibrationProblem* problem, std::size_t frames)
      : problem_(*problem), frames_(frames) {}
  ceres::CallbackReturnType operator()(
      const ceres::IterationSummary& iteration) override {
    problem_.Tell(std::to_string(frames_) + " frames, iteration " +
                  std::to_string(iteration.iteration));
    return ceres::SOLVER_CONTINUE;
  }

 private:
  const CalibrationProblem& problem_;
  std::size_t frames_;
};

class JointProblem {
 public:
  JointProblem(const std::vector<int>& frames, CalibrationProblem* problem,
               ContactStore* contacts)
      : problem_(*problem),
        contacts_(*contacts),
        evaluations_(problem->finger(), problem->discretization(),
                     EquilibriumForm::kReduced, &problem->parameters().shared,
                     problem->threads()),
        loss_(MakeLoss(problem->plan())) {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.evaluation_callback = &evaluations_;
    residuals_ = std::make_unique<ceres::Problem>(options);
    for (const int i : frames) AddFrame(i);
    AddPriors();
    tell_ = std::make_unique<TellIteration>(&problem_, frames.size());
  }

  SolveReport Solve(const JointLimits& limits) {
    ceres::Solver::Options options;
    options.logging_type = ceres::SILENT;
    options.max_num_iterations = limits.iterations;
    // The residuals are whitened, so that Gauss-Newton steps have the right
    // size. A small radius would creep along the weak directions.
    options.initial_trust_region_radius = 1e10;
    options.max_trust_region_radius = 1e16;
    options.function_tolerance = limits.function_tolerance;
    options.parameter_tolerance = 1e-11;
    options.gradient_tolerance = 1e-12;
    options.callbacks.push_back(tell_.get());
    options.linear_solver_type = ceres::DENSE_QR;
    const auto ordering = FixAndOrder();
    if (!contact_blocks_.empty()) {
      options.linear_solver_type = ceres::DENSE_SCHUR;
      options.linear_solver_ordering = ordering;
    }
    ceres::Solver::Summary summary;
    const ClassicNumbers in_messages;
    ceres::Solve(options, residuals_.get(), &summary);
    return ReportOf(summary);
  }

 private:
  void AddFrame(int i) {
    const CalibrationFrame& frame = problem_.frame(i);
    double* contact = frame.contact ? contacts_[i].data() : nullptr;
    FrameEvaluation* evaluation = nullptr;
    if (!frame.IsBench()) {
      evaluation = &evaluations_.Add(
          frame.contact ? 1 : 0, problem_.parameters().friction(), contact,
          !frame.pins.empty(), problem_.plan().MovesGauges());
      const LadderState state = contacts_.StateNear(i);
      if (state.q.size() > 0) evaluation->set_state(state);
    }
    for (FrameBlock& block : problem_.blocks().Of(frame, evaluation, contact)) {
      residuals_->AddResidualBlock(block.cost.release(), loss_.get(),
                                   block.parameters);
    }
    if (contact == nullptr) return;
    contact_blocks_.push_back(contact);
    residuals_->SetParameterLowerBound(contact, 0, 0);
    residuals_->SetParameterUpperBound(contact, 0,
                                       problem_.finger().front_length_mm);
    residuals_->SetParameterLowerBound(contact, 1, 0);
  }

  // Adds a prior for each parameter block. Several parameters may share a block
  // (rib lengths).
  void AddPriors() {
    const auto& all = problem_.parameters().all();
    for (std::size_t i = 0; i < all.size();) {
      std::size_t end = i + 1;
      while (end < all.size() && all[end].block == all[i].block) ++end;
      const auto size = static_cast<Eigen::Index>(end - i);
      const bool any =
          std::any_of(all.begin() + static_cast<std::ptrdiff_t>(i),
                      all.begin() + static_cast<std::ptrdiff_t>(end),
                      [](const auto& p) { return p.prior_std.has_value(); });
      if (all[i].free && any) {
        Eigen::VectorXd mean(size), std(size);
        for (Eigen::Index k = 0; k < size; ++k) {
          mean[k] = all[i + k].initial;
          std[k] = all[i + k].prior_std.value_or(
              std::numeric_limits<double>::infinity());
        }
        residuals_->AddResidualBlock(ParameterPriorResidual::Create(mean, std),
                                     nullptr, all[i].block);
      }
      i = end;
    }
  }

  // Fixes the blocks that are not free, and returns the order of all. The
  // contacts are eliminated first. Each shared block has a group of its own:
  // within a group Ceres orders blocks by address, and results would depend on
  // where the heap has put them.
  std::shared_ptr<ceres::ParameterBlockOrdering> FixAndOrder() {
    auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (double* contact : contact_blocks_) {
      ordering->AddElementToGroup(contact, 0);
    }
    int group = 1;
    for (const int i : problem_.parameters().free()) {
      double* block = problem_.parameters().all()[i].block;
      if (residuals_->HasParameterBlock(block) && !ordering->IsMember(block)) {
        ordering->AddElementToGroup(block, group++);
      }
    }
    std::vector<double*> all;
    residuals_->GetParameterBlocks(&all);
    for (double* block : all) {  // constant blocks come last
      if (ordering->IsMember(block)) continue;
      residuals_->SetParameterBlockConstant(block);
      ordering->AddElementToGroup(block, group);
    }
    return ordering;
  }

  CalibrationProblem& problem_;
  ContactStore& contacts_;
  FrameSet evaluations_;
  std::unique_ptr<ceres::LossFunction> loss_;
  std::unique_ptr<ceres::Problem> residuals_;
  std::vector<double*> contact_blocks_;
  std::unique_ptr<TellIteration> tell_;
};

}  // namespace

SolveReport ReportOf(const ceres::Solver::Summary& summary) {
  return {summary.termination_type == ceres::CONVERGENCE,
          std::max(0, static_cast<int>(summary.iterations.size()) - 1),
          summary.initial_cost, summary.final_cost, summary.message};
}

SolveReport SolveJointly(const std::vector<int>& frames,
                         const JointLimits& limits, CalibrationProblem* problem,
                         ContactStore* contacts) {
  contacts->Guess(frames, ContactGuess::From::kObjectFirst);
  return JointProblem(frames, problem, contacts).Solve(limits);
}

}  // namespace finray
