#include "finray/calib/calibration_problem.h"

#include <ceres/ordered_groups.h>
#include <ceres/solver.h>

#include <cmath>
#include <limits>
#include <unordered_set>

#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "finray/residuals/parameter_prior_residual.h"

namespace finray {
namespace {

std::unique_ptr<ceres::LossFunction> MakeLoss(const Plan& plan) {
  switch (plan.loss) {
    case RobustLoss::kNone:
      return nullptr;
    case RobustLoss::kHuber:
      return std::make_unique<ceres::HuberLoss>(plan.loss_scale);
    case RobustLoss::kCauchy:
      return std::make_unique<ceres::CauchyLoss>(plan.loss_scale);
  }
  return nullptr;
}

}  // namespace

const char* ResidualFamilyName(ResidualFamily family) {
  constexpr const char* kNames[] = {"gauge", "force", "object", "contact",
                                    "pin",   "tip",   "bench"};
  return kNames[static_cast<int>(family)];
}

CalibrationProblem::CalibrationProblem(const Finger& finger, const Plan& plan,
                                       const CalibrationLogs& logs,
                                       const Discretization& discretization,
                                       int threads)
    : finger_(finger),
      plan_(plan),
      logs_(logs),
      parameters_(finger, plan, logs),
      discretization_(discretization),
      frames_(finger, discretization, EquilibriumForm::kReduced,
              &parameters_.shared, threads),
      loss_(MakeLoss(plan)) {
  if (parameters_.free().empty()) {
    throw InputError("plan: no parameter is free, so there is nothing to do");
  }
  ceres::Problem::Options options;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.evaluation_callback = &frames_;
  problem_ = std::make_unique<ceres::Problem>(options);
  contact_of_frame_.assign(logs_.frames.size(), -1);
  contacts_.reserve(logs_.frames.size());
  GuessOffsets();
  for (std::size_t i = 0; i < logs_.frames.size(); ++i) {
    if (!logs_.frames[i].held_out) AddFrame(static_cast<int>(i));
  }
  if (blocks_.empty()) {
    throw InputError("logs: no frame has anything to fit");
  }
  AddPriors();
  FixWhatIsNotFree();
}

// Where the measurements put the contact, before the model has been fitted.
void CalibrationProblem::GuessContact(int index, double* contact,
                                      FrameEvaluation* evaluation) {
  const CalibrationFrame& frame = logs_.frames[index];
  const double length = finger_.front_length_mm;
  if (!guess_) {
    guess_ =
        std::make_unique<ContactGuess>(finger_, plan_.scene, discretization_);
  }
  const bool by_object =
      frame.object_mm.allFinite() && plan_.scene.circle_radius_mm();
  const std::optional<ContactGuess::Place> place =
      by_object ? guess_->FromCircle(frame.object_mm) : GuessFromGauges(frame);
  contact[0] = place ? place->arc_mm : length / 2;
  contact[1] = place ? place->normal_N : ForceUnit(finger_);
  if (place) evaluation->set_state(place->state);
  if (std::isfinite(frame.contact_mm)) {
    contact[0] = std::clamp(frame.contact_mm, 0.0, length);
  }
  const double force =
      frame.force_xy_N.allFinite() ? frame.force_xy_N.norm() : frame.force_N;
  if (std::isfinite(force)) contact[1] = std::max(force, 0.0);
}

std::optional<ContactGuess::Place> CalibrationProblem::GuessFromGauges(
    const CalibrationFrame& frame) {
  const auto gauges = static_cast<Eigen::Index>(frame.gauges_V.size());
  Eigen::VectorXd angles = Eigen::VectorXd::Zero(gauges);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(gauges);
  for (Eigen::Index j = 0; j < gauges; ++j) {
    if (!std::isfinite(frame.gauges_V[j])) continue;
    const double gain = parameters_.gains_V_per_rad[j];
    const int gauge = static_cast<int>(j);
    angles[j] =
        (frame.gauges_V[j] - parameters_.readings.Sum(frame, gauge)) / gain;
    weights[j] = std::abs(gain) / gauge_std_V(gauge);
  }
  return guess_->FromGauges(angles, weights);
}

void CalibrationProblem::AddPriors() {
  // One block at a time; several parameters may share one (rib lengths).
  const auto& all = parameters_.all();
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i + 1;
    while (end < all.size() && all[end].block == all[i].block) ++end;
    const auto size = static_cast<Eigen::Index>(end - i);
    // A gauge or beam that no frame involves has no block.
    if (all[i].free && all[i].prior_std &&
        problem_->HasParameterBlock(all[i].block)) {
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

void CalibrationProblem::FixWhatIsNotFree() {
  std::unordered_set<const double*> varied;
  for (const int i : parameters_.free()) {
    varied.insert(parameters_.all()[i].block);
  }
  for (const auto& contact : contacts_) varied.insert(contact.data());
  std::vector<double*> blocks;
  problem_->GetParameterBlocks(&blocks);
  for (double* block : blocks) {
    if (varied.count(block) == 0) problem_->SetParameterBlockConstant(block);
  }
}

CalibrationProblem::SolveReport CalibrationProblem::Solve() {
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 200;
  // The residuals are whitened, and the weak directions of a calibration are
  // what it is about: a small radius would creep along them.
  options.initial_trust_region_radius = 1e10;
  options.max_trust_region_radius = 1e16;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-11;
  options.gradient_tolerance = 1e-12;
  if (contacts_.empty()) {
    options.linear_solver_type = ceres::DENSE_QR;
  } else {
    options.linear_solver_type = ceres::DENSE_SCHUR;
    auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    std::vector<double*> all;
    problem_->GetParameterBlocks(&all);
    // A group of its own for each shared block: within a group Ceres orders by
    // address, and results would depend on where the heap put things.
    int group = 1;
    for (double* block : all) ordering->AddElementToGroup(block, group++);
    for (auto& contact : contacts_) {
      ordering->AddElementToGroup(contact.data(), 0);
    }
    options.linear_solver_ordering = ordering;
  }
  ceres::Solver::Summary summary;
  ceres::Solve(options, problem_.get(), &summary);
  SolveReport report;
  report.converged = summary.termination_type == ceres::CONVERGENCE;
  report.iterations = static_cast<int>(summary.iterations.size()) - 1;
  report.initial_cost = summary.initial_cost;
  report.final_cost = summary.final_cost;
  report.message = summary.message;
  return report;
}

CalibrationProblem::Linearization CalibrationProblem::Linearize(bool robust) {
  // Free parameter blocks first, then the contacts, in order of their frames.
  ceres::Problem::EvaluateOptions options;
  options.residual_blocks = blocks_;
  options.apply_loss_function = robust;
  std::vector<int> parameter_of_column;
  for (std::size_t k = 0; k < parameters_.free().size();) {
    double* block = parameters_.all()[parameters_.free()[k]].variable;
    if (!problem_->HasParameterBlock(block)) {
      ++k;  // an element of a block, or not part of any residual
      continue;
    }
    const int size = problem_->ParameterBlockSize(block);
    options.parameter_blocks.push_back(block);
    for (int i = 0; i < size; ++i) {
      parameter_of_column.push_back(static_cast<int>(k++));
    }
  }
  const int shared_columns = static_cast<int>(parameter_of_column.size());
  for (auto& contact : contacts_) {
    options.parameter_blocks.push_back(contact.data());
  }
  Linearization out;
  std::vector<double> residuals;
  ceres::CRSMatrix jacobian;
  if (!problem_->Evaluate(options, nullptr, &residuals, nullptr, &jacobian)) {
    throw std::runtime_error("the model cannot be evaluated at the solution");
  }
  const auto rows = static_cast<Eigen::Index>(residuals.size());
  out.residuals = Eigen::Map<Eigen::VectorXd>(residuals.data(), rows);
  out.by_parameter.setZero(rows, parameters_.free().size());
  out.by_contact.setZero(rows, 2);
  for (std::size_t block = 0; block < blocks_.size(); ++block) {
    const int size = problem_->GetCostFunctionForResidualBlock(blocks_[block])
                         ->num_residuals();
    for (int i = 0; i < size; ++i) out.rows.push_back(block_info_[block]);
  }
  for (Eigen::Index row = 0; row < rows; ++row) {
    for (int k = jacobian.rows[row]; k < jacobian.rows[row + 1]; ++k) {
      const int column = jacobian.cols[k];
      if (column < shared_columns) {
        out.by_parameter(row, parameter_of_column[column]) = jacobian.values[k];
      } else {
        out.by_contact(row, (column - shared_columns) % 2) = jacobian.values[k];
      }
    }
  }
  return out;
}

std::array<double, 2> CalibrationProblem::contact(int frame) const {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const int index = contact_of_frame_[frame];
  if (index < 0) return {kNaN, kNaN};
  return contacts_[index];
}

}  // namespace finray
