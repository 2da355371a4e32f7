// JointSolve::SolveByProjection.

#include <ceres/crs_matrix.h>

#include <Eigen/QR>
#include <algorithm>
#include <stdexcept>
#include <utility>

#include "finray/calib/solve/information_spectrum.h"
#include "finray/calib/solve/joint_solve.h"

namespace finray {

// With [C E] the derivatives of a frame's residuals r by parameters and
// unknowns, E P = Q [R; 0] (pivoted) splits them: of Q'(r + C dp + E de) the
// lower rows are what the parameters alone can change, and R P' de takes away
// the upper ones.
class JointSolve::Projection {
 public:
  Projection(Rows rows, Eigen::MatrixXd* information, Eigen::VectorXd* gradient)
      : upper_by_parameter_(std::move(rows.by_parameter)),
        upper_residuals_(std::move(rows.residuals)) {
    if (rows.by_unknown.cols() > 0) {
      qr_.compute(rows.by_unknown);
      upper_by_parameter_.applyOnTheLeft(qr_.householderQ().adjoint());
      upper_residuals_.applyOnTheLeft(qr_.householderQ().adjoint());
      rank_ = qr_.rank();
    }
    const Eigen::Index lower = upper_residuals_.size() - rank_;
    const auto c = upper_by_parameter_.bottomRows(lower);
    information->noalias() += c.transpose() * c;
    gradient->noalias() += c.transpose() * upper_residuals_.tail(lower);
    upper_by_parameter_.conservativeResize(rank_, Eigen::NoChange);
    upper_residuals_.conservativeResize(rank_);
  }

  // The unknowns' part of a step; those beyond the rank stay.
  Eigen::VectorXd UnknownStep(const Eigen::VectorXd& parameter_step) const {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(qr_.cols());
    if (rank_ == 0) return step;
    step.head(rank_) =
        -qr_.matrixR()
             .topLeftCorner(rank_, rank_)
             .triangularView<Eigen::Upper>()
             .solve(upper_residuals_ + upper_by_parameter_ * parameter_step);
    return qr_.colsPermutation() * step;
  }

 private:
  Eigen::MatrixXd upper_by_parameter_;
  Eigen::VectorXd upper_residuals_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;
  Eigen::Index rank_ = 0;
};

JointSolve::Rows JointSolve::RowsOf(std::size_t frame) {
  const auto n = static_cast<Eigen::Index>(parameters_.free().size());
  ceres::Problem::EvaluateOptions options;
  options.residual_blocks = blocks_of_[frame];
  std::vector<Eigen::Index> column_of;  // of Ceres' columns
  for (Eigen::Index k = 0; k < n; ++k) {
    const CalibrationParameter& p = parameters_.FreeParameter(k);
    if (!problem_->HasParameterBlock(p.block)) continue;
    column_of.push_back(k);
    if (options.parameter_blocks.empty() ||
        options.parameter_blocks.back() != p.block) {
      options.parameter_blocks.push_back(p.block);
    }
  }
  const auto shared = static_cast<int>(column_of.size());
  if (frames_[frame].unknowns != nullptr) {
    options.parameter_blocks.push_back(frames_[frame].unknowns);
  }
  std::vector<double> residuals;
  ceres::CRSMatrix sparse;
  if (!problem_->Evaluate(options, nullptr, &residuals, nullptr, &sparse)) {
    throw std::runtime_error(
        "the weighted form cannot be evaluated near the solution");
  }
  Rows rows;
  rows.residuals =
      Eigen::Map<Eigen::VectorXd>(residuals.data(), sparse.num_rows);
  rows.by_parameter.setZero(sparse.num_rows, n);
  rows.by_unknown.setZero(sparse.num_rows, sparse.num_cols - shared);
  for (int row = 0; row < sparse.num_rows; ++row) {
    for (int k = sparse.rows[row]; k < sparse.rows[row + 1]; ++k) {
      const int column = sparse.cols[k];
      (column < shared ? rows.by_parameter(row, column_of[column])
                       : rows.by_unknown(row, column - shared)) =
          sparse.values[k];
    }
  }
  return rows;
}

SolveReport JointSolve::SolveByProjection(Eigen::MatrixXd* information) {
  constexpr int kMostSteps = 50;
  constexpr double kNear = 1e-6;  // of a std
  const auto n = static_cast<Eigen::Index>(parameters_.free().size());
  const Eigen::VectorXd prior = parameters_.PriorInformation();
  SolveReport report;
  while (!report.converged && report.iterations < kMostSteps) {
    *information = prior.asDiagonal();
    Eigen::VectorXd gradient(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const CalibrationParameter& p = parameters_.FreeParameter(k);
      gradient[k] = prior[k] * (*p.variable - p.initial);
    }
    std::vector<Projection> frames;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      frames.emplace_back(RowsOf(i), information, &gradient);
    }
    const Eigen::MatrixXd units =
        DeterminedUnits(*information, parameters_.Units());
    const Eigen::VectorXd in_std = -(units.transpose() * gradient);
    const Eigen::VectorXd step = units * in_std;
    for (Eigen::Index k = 0; k < n; ++k) {
      *parameters_.FreeParameter(k).variable += step[k];
    }
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      MoveUnknowns(i, frames[i].UnknownStep(step));
    }
    ++report.iterations;
    report.converged = (in_std.array().abs() < kNear).all();
  }
  return report;
}

// Contacts stay on the beam and do not pull.
void JointSolve::MoveUnknowns(std::size_t frame, const Eigen::VectorXd& step) {
  double* unknowns = frames_[frame].unknowns;
  for (Eigen::Index k = 0; k < step.size(); ++k) unknowns[k] += step[k];
  if (!frames_[frame].frame->contact) return;
  double* contact = unknowns + evaluation_of_[frame]->contact_offset(0);
  contact[0] = std::clamp(contact[0], 0.0, finger_.front_length_mm);
  contact[1] = std::max(0.0, contact[1]);
}

}  // namespace finray
