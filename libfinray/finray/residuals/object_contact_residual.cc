#include "finray/residuals/object_contact_residual.h"

#include <cmath>

namespace finray {

ObjectContactResidual::ObjectContactResidual(const FrameEvaluation* frame,
                                             int contact,
                                             const Eigen::Vector2d& center_mm,
                                             double radius_mm, double std_mm)
    : FrameResidual(frame, 2, {2}),
      contact_(contact),
      center_mm_(center_mm),
      radius_mm_(radius_mm),
      std_mm_(std_mm) {}

bool ObjectContactResidual::Evaluate(double const* const* parameters,
                                     double* residuals,
                                     double** jacobians) const {
  if (!frame().valid()) return false;
  const Eigen::Map<const Eigen::Vector2d> origin(parameters[extra_block()]);
  const int row = frame().contact_row(contact_);
  const Eigen::Vector3d pose = frame().outputs().segment<3>(row);
  const Eigen::Vector2d t(std::cos(pose.z()), std::sin(pose.z()));
  const Eigen::Vector2d n(t.y(), -t.x());
  Eigen::Vector2d weight;
  for (int i = 0; i < 2; ++i) {
    weight[i] = std::isnan(center_mm_[i]) ? 0 : 1 / std_mm_;
    residuals[i] = weight[i] == 0 ? 0
                                  : weight[i] * (pose[i] - radius_mm_ * n[i] -
                                                 center_mm_[i] - origin[i]);
  }
  if (jacobians == nullptr) return true;
  const auto d_pose = frame().d_outputs().middleRows<3>(row);
  for (int i = 0; i < 2; ++i) {  // dn = t dtheta
    SpreadRow(i,
              weight[i] * (d_pose.row(i) - radius_mm_ * t[i] * d_pose.row(2)),
              jacobians);
  }
  if (double* by_origin = jacobians[extra_block()]) {
    Eigen::Map<Eigen::Matrix2d> block(by_origin);
    block = -weight.asDiagonal().toDenseMatrix();
  }
  return true;
}

ContactLocationResidual::ContactLocationResidual(const FrameEvaluation* frame,
                                                 int contact, double arc_mm,
                                                 double std_mm)
    : position_(frame->contact_offset(contact)),
      arc_mm_(arc_mm),
      std_mm_(std_mm) {
  set_num_residuals(1);
  mutable_parameter_block_sizes()->push_back(frame->frame_size());
}

bool ContactLocationResidual::Evaluate(double const* const* parameters,
                                       double* residuals,
                                       double** jacobians) const {
  residuals[0] = (parameters[0][position_] - arc_mm_) / std_mm_;
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    Eigen::Map<Eigen::VectorXd> by_frame(jacobians[0],
                                         parameter_block_sizes()[0]);
    by_frame.setZero();
    by_frame[position_] = 1 / std_mm_;
  }
  return true;
}

}  // namespace finray
