#include "finray/residuals/point_residual.h"

namespace finray {

ceres::CostFunction* PointResidual::CreatePin(const FrameEvaluation* frame,
                                              int rib, Side side,
                                              const Eigen::Vector2d& at_mm,
                                              double std_mm) {
  return new PointResidual(frame, frame->pin_row(rib, side), at_mm, std_mm);
}

ceres::CostFunction* PointResidual::CreateTip(const FrameEvaluation* frame,
                                              const Eigen::Vector2d& at_mm,
                                              double std_mm) {
  return new PointResidual(frame, kTip, at_mm, std_mm);
}

PointResidual::PointResidual(const FrameEvaluation* frame, int row,
                             const Eigen::Vector2d& at_mm, double std_mm)
    : FrameResidual(frame, 2, {2}), row_(row), at_mm_(at_mm), std_mm_(std_mm) {}

bool PointResidual::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
  if (!frame().valid()) return false;
  const int row = row_ == kTip ? frame().tip_row() : row_;
  const Eigen::Map<const Eigen::Vector2d> origin(parameters[extra_block()]);
  Eigen::Map<Eigen::Vector2d>(residuals, 2) =
      (frame().outputs().segment<2>(row) - at_mm_ - origin) / std_mm_;
  if (jacobians == nullptr) return true;
  for (int i = 0; i < 2; ++i) {
    SpreadRow(i, frame().d_outputs().row(row + i) / std_mm_, jacobians);
  }
  if (double* by_origin = jacobians[extra_block()]) {
    Eigen::Map<Eigen::Matrix2d>(by_origin, 2, 2) =
        -Eigen::Matrix2d::Identity() / std_mm_;
  }
  return true;
}

}  // namespace finray
