#include "finray/chain/chain_cost.h"

#include "finray/chain/finger_jacobian.h"

namespace finray {
namespace {

// Ceres keeps Jacobian blocks by rows.
using RowMajor =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

template <typename Derived>
void Write(const Eigen::MatrixBase<Derived>& value, double* out) {
  if (out == nullptr) return;
  if constexpr (Derived::ColsAtCompileTime == 1) {
    Eigen::Map<Eigen::VectorXd>(out, value.size()) = value;
  } else {
    Eigen::Map<RowMajor>(out, value.rows(), value.cols()) = value;
  }
}

// Tells Ceres to take a smaller step instead of reporting a failure to it.
template <typename Derived>
bool Finite(const Eigen::MatrixBase<Derived>& residual) {
  return residual.allFinite();
}

int Ribs(const ChainLayout* layout) {
  return static_cast<int>(layout->ribs.size());
}

}  // namespace

TipClosureCost::TipClosureCost(const ChainLayout* layout, double weight)
    : layout_(layout) {
  weights_ << 1, 1 / layout->length_unit_mm, 1 / layout->length_unit_mm;
  weights_ *= weight;
  set_num_residuals(3);
  *mutable_parameter_block_sizes() = {layout->joints()};
}

bool TipClosureCost::Evaluate(double const* const* parameters,
                              double* residuals, double** jacobians) const {
  const ElasticChain& chain = layout_->chain;
  const auto poses = Kinematics(chain, parameters[0]);
  const Eigen::Vector3d y = TipDeviation(chain, poses, layout_->target);
  Write(weights_.cwiseProduct(y), residuals);
  if (jacobians) {
    Write(weights_.asDiagonal() *
              TipDeviationJacobian(chain, poses, layout_->target),
          jacobians[0]);
  }
  return Finite(y);
}

JointTorqueCost::JointTorqueCost(const ChainLayout* layout, double weight,
                                 double friction)
    : layout_(layout),
      weight_(weight / (layout->force_unit_N * layout->length_unit_mm)),
      friction_(friction) {
  set_num_residuals(layout->joints());
  *mutable_parameter_block_sizes() = {layout->joints(), layout->loads(), 2};
}

bool JointTorqueCost::Evaluate(double const* const* parameters,
                               double* residuals, double** jacobians) const {
  const auto poses = Kinematics(layout_->chain, parameters[0]);
  const Eigen::VectorXd tau = JointTorques(
      *layout_, poses, parameters[0], parameters[1], parameters[2], friction_);
  Write(weight_ * tau, residuals);
  if (jacobians) {
    const TorqueJacobian by = MakeTorqueJacobian(*layout_, poses, parameters[1],
                                                 parameters[2], friction_);
    Write(weight_ * by.theta, jacobians[0]);
    Write(weight_ * by.loads, jacobians[1]);
    Write(weight_ * by.contact, jacobians[2]);
  }
  return Finite(tau);
}

RibDistanceCost::RibDistanceCost(const ChainLayout* layout, double weight)
    : layout_(layout), weight_(weight / layout->length_unit_mm) {
  set_num_residuals(Ribs(layout));
  *mutable_parameter_block_sizes() = {layout->joints(), layout->loads()};
}

bool RibDistanceCost::Evaluate(double const* const* parameters,
                               double* residuals, double** jacobians) const {
  const auto poses = Kinematics(layout_->chain, parameters[0]);
  const Eigen::VectorXd d = RibDeviations(*layout_, poses, parameters[1]);
  Write(weight_ * d, residuals);
  if (jacobians) {
    Write(weight_ * RibJacobian(*layout_, poses), jacobians[0]);
    Eigen::MatrixXd by_loads =
        Eigen::MatrixXd::Zero(Ribs(layout_), layout_->loads());
    for (int k = 0; k < Ribs(layout_); ++k) {
      by_loads(k, 3 + k) = weight_ * layout_->ribs[k].compliance_mm_per_N;
    }
    Write(by_loads, jacobians[1]);
  }
  return Finite(d);
}

GaugeAngleCost::GaugeAngleCost(const ChainLayout* layout,
                               const Eigen::VectorXd& s0, double sigma_rad)
    : layout_(layout), s0_(s0), sigma_rad_(sigma_rad) {
  set_num_residuals(static_cast<int>(s0.size()));
  *mutable_parameter_block_sizes() = {layout->joints()};
}

bool GaugeAngleCost::Evaluate(double const* const* parameters,
                              double* residuals, double** jacobians) const {
  const Eigen::Map<const Eigen::VectorXd> theta(parameters[0],
                                                layout_->joints());
  const Eigen::VectorXd s = (layout_->gauges * theta - s0_) / sigma_rad_;
  Write(s, residuals);
  if (jacobians) Write(layout_->gauges / sigma_rad_, jacobians[0]);
  return Finite(s);
}

}  // namespace finray
