#include "finray/residuals/point_residual.h"

namespace finray {

PointResidual::PointResidual(const FrameEvaluation* frame, int row,
                             const Eigen::Vector2d* at_mm, double std_mm)
    : FrameResidual(frame, 2, {2}),
      row_(row),
      at_mm_(*at_mm),
      std_mm_(std_mm) {}

bool PointResidual::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
  if (!frame().valid()) return false;
  const Eigen::Map<const Eigen::Vector2d> origin(parameters[extra_block()]);
  Eigen::Map<Eigen::Vector2d>(residuals, 2) =
      (frame().outputs().segment<2>(row_) - at_mm_ - origin) / std_mm_;
  if (jacobians == nullptr) return true;
  for (int i = 0; i < 2; ++i) {
    SpreadRow(i, frame().d_outputs().row(row_ + i) / std_mm_, jacobians);
  }
  if (double* by_origin = jacobians[extra_block()]) {
    Eigen::Map<Eigen::Matrix2d>(by_origin, 2, 2) =
        -Eigen::Matrix2d::Identity() / std_mm_;
  }
  return true;
}

}  // namespace finray
