#include "finray/calib/solve/joint_solve.h"

#include <ceres/ordered_groups.h>
#include <ceres/solver.h>

#include <algorithm>
#include <unordered_set>

#include "finray/io/number_text.h"
#include "finray/residuals/parameter_prior_residual.h"

namespace finray {

JointSolve::JointSolve(const Finger& finger,
                       const Discretization& discretization, const Plan& plan,
                       const CalibrationBlocks& blocks,
                       CalibrationParameters* parameters,
                       const std::vector<Frame>& frames, int threads)
    : finger_(finger),
      plan_(plan),
      parameters_(*parameters),
      evaluations_(finger, discretization, EquilibriumForm::kReduced,
                   &parameters->shared, threads),
      frames_(frames),
      loss_(MakeLoss(plan)) {
  ceres::Problem::Options options;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.evaluation_callback = &evaluations_;
  problem_ = std::make_unique<ceres::Problem>(options);
  for (const Frame& frame : frames_) AddFrame(frame, blocks);
  AddPriors();
  FixWhatIsNotFree();
}

void JointSolve::AddFrame(const Frame& frame, const CalibrationBlocks& blocks) {
  FrameEvaluation* evaluation = nullptr;
  if (!frame.frame->IsBench()) {
    evaluation = &evaluations_.Add(frame.frame->contact ? 1 : 0,
                                   plan_.scene.friction_coefficient,
                                   frame.contact, !frame.frame->pins.empty());
    if (frame.state->q.size() > 0) evaluation->set_state(*frame.state);
  }
  evaluation_of_.push_back(evaluation);
  for (FrameBlock& block : blocks.Of(*frame.frame, evaluation, frame.contact)) {
    problem_->AddResidualBlock(block.cost.release(), loss_.get(),
                               block.parameters);
  }
  if (!frame.frame->contact) return;
  problem_->SetParameterLowerBound(frame.contact, 0, 0);
  problem_->SetParameterUpperBound(frame.contact, 0, finger_.front_length_mm);
  problem_->SetParameterLowerBound(frame.contact, 1, 0);
}

void JointSolve::AddPriors() {
  // One block at a time; several parameters may share one (rib lengths).
  const auto& all = parameters_.all();
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i + 1;
    while (end < all.size() && all[end].block == all[i].block) ++end;
    const auto size = static_cast<Eigen::Index>(end - i);
    if (all[i].free && all[i].prior_std) {
      Eigen::VectorXd mean(size), std(size);
      for (Eigen::Index k = 0; k < size; ++k) {
        mean[k] = all[i + k].initial;
        std[k] = *all[i + k].prior_std;
      }
      problem_->AddResidualBlock(ParameterPriorResidual::Create(mean, std),
                                 nullptr, all[i].block);
    }
    i = end;
  }
}

void JointSolve::FixWhatIsNotFree() {
  std::unordered_set<const double*> varied;
  for (const int i : parameters_.free()) {
    varied.insert(parameters_.all()[i].block);
  }
  for (const Frame& frame : frames_) varied.insert(frame.contact);
  std::vector<double*> blocks;
  problem_->GetParameterBlocks(&blocks);
  for (double* block : blocks) {
    if (varied.count(block) == 0) problem_->SetParameterBlockConstant(block);
  }
}

SolveReport JointSolve::Solve(const Limits& limits) {
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = limits.iterations;
  // The residuals are whitened, and the weak directions of a calibration are
  // what it is about: a small radius would creep along them.
  options.initial_trust_region_radius = 1e10;
  options.max_trust_region_radius = 1e16;
  options.function_tolerance = limits.function_tolerance;
  options.parameter_tolerance = 1e-11;
  options.gradient_tolerance = 1e-12;
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (const Frame& frame : frames_) {
    if (frame.contact != nullptr) {
      ordering->AddElementToGroup(frame.contact, 0);
    }
  }
  if (ordering->NumElements() == 0) {
    options.linear_solver_type = ceres::DENSE_QR;
  } else {
    options.linear_solver_type = ceres::DENSE_SCHUR;
    // A group of its own for each shared block: within a group Ceres orders by
    // address, and results would depend on where the heap put things.
    int group = 1;
    for (const int i : parameters_.free()) {
      double* block = parameters_.all()[i].block;
      if (problem_->HasParameterBlock(block) && !ordering->IsMember(block)) {
        ordering->AddElementToGroup(block, group++);
      }
    }
    std::vector<double*> all;
    problem_->GetParameterBlocks(&all);
    for (double* block : all) {  // those that stay as they are
      if (!ordering->IsMember(block)) ordering->AddElementToGroup(block, group);
    }
    options.linear_solver_ordering = ordering;
  }
  ceres::Solver::Summary summary;
  const ClassicNumbers in_messages;
  ceres::Solve(options, problem_.get(), &summary);
  // Its last step may have been taken back.
  evaluations_.PrepareForEvaluation(true, true);
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (evaluation_of_[i] != nullptr) {
      *frames_[i].state = evaluation_of_[i]->state();
    }
  }
  SolveReport report;
  report.converged = summary.termination_type == ceres::CONVERGENCE;
  report.iterations =
      std::max(0, static_cast<int>(summary.iterations.size()) - 1);
  report.initial_cost = summary.initial_cost;
  report.final_cost = summary.final_cost;
  report.message = summary.message;
  return report;
}

}  // namespace finray
