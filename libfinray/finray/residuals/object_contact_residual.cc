#include "finray/residuals/object_contact_residual.h"

#include <cmath>

#include "finray/scene/stage_frame.h"

namespace finray {

ObjectContactResidual::ObjectContactResidual(const FrameEvaluation* frame,
                                             int contact,
                                             const Eigen::Vector2d* center_mm,
                                             double std_mm)
    : FrameResidual(frame, 2, {2, 1, 1, 1}),
      contact_(contact),
      center_mm_(*center_mm),
      std_mm_(std_mm) {}

bool ObjectContactResidual::Evaluate(double const* const* parameters,
                                     double* residuals,
                                     double** jacobians) const {
  if (!frame().valid()) return false;
  const int extra = extra_block();
  const StageFrame stage{Eigen::Map<const Eigen::Vector2d>(parameters[extra]),
                         *parameters[extra + 1], *parameters[extra + 2]};
  const double radius_mm = *parameters[extra + 3];
  if (!(radius_mm > 0)) return false;
  const Eigen::Vector2d turned = stage.Turned(
      center_mm_.array().isNaN().select(Eigen::Vector2d::Zero(), center_mm_));
  const int row = frame().contact_row(contact_);
  const Eigen::Vector3d pose = frame().outputs().segment<3>(row);
  const Eigen::Vector2d t(std::cos(pose.z()), std::sin(pose.z()));
  const Eigen::Vector2d n(t.y(), -t.x());
  Eigen::Vector2d weight;
  for (int i = 0; i < 2; ++i) {
    weight[i] = std::isnan(center_mm_[i]) ? 0 : 1 / std_mm_;
    residuals[i] = weight[i] * (pose[i] - radius_mm * n[i] - turned[i] -
                                stage.origin_mm[i]);
  }
  if (jacobians == nullptr) return true;
  const auto d_pose = frame().d_outputs().middleRows<3>(row);
  for (int i = 0; i < 2; ++i) {  // dn = t dtheta
    SpreadRow(i, weight[i] * (d_pose.row(i) - radius_mm * t[i] * d_pose.row(2)),
              jacobians);
  }
  if (double* by_origin = jacobians[extra]) {
    Eigen::Map<Eigen::Matrix2d> block(by_origin);
    block = -weight.asDiagonal().toDenseMatrix();
  }
  const auto set = [&](int block, const Eigen::Vector2d& by_block) {
    if (double* by = jacobians[extra + block]) {
      Eigen::Map<Eigen::Vector2d>(by, 2) = -weight.cwiseProduct(by_block);
    }
  };
  set(1, M_PI / 180 * Eigen::Vector2d(-turned.y(), turned.x()));
  set(2, turned);
  set(3, n);
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
