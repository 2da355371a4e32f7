#ifndef FINRAY_CHAIN_CHAIN_COST_H_
#define FINRAY_CHAIN_CHAIN_COST_H_

#include <ceres/cost_function.h>

#include "finray/chain/chain_layout.h"

namespace finray {

// The rows of (17) as residual blocks of the weighted full-coordinate problem.
// Parameter blocks, in this order as far as a block needs them:
//
//   theta (n), rad | loads = (F_t, f) (3 + r), N mm and N | (l_c, f_c), mm, N
//
// and residuals, with the units of ChainUnits:
//
//   TipClosureCost   w (y_0, y_1 / l_0, y_2 / l_0)   (4)    theta
//   JointTorqueCost  w tau / (F_0 l_0)               (14)   all three
//   RibDistanceCost  w d / l_0                       (7)    theta, loads
//   GaugeAngleCost   (S_e theta - s_0) / sigma       (16)   theta
//
// `layout` must outlive the cost functions.

class TipClosureCost : public ceres::CostFunction {
 public:
  TipClosureCost(const ChainLayout* layout, double weight);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const ChainLayout* layout_;
  Eigen::Vector3d weights_;
};

class JointTorqueCost : public ceres::CostFunction {
 public:
  JointTorqueCost(const ChainLayout* layout, double weight, double friction);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const ChainLayout* layout_;
  double weight_, friction_;
};

class RibDistanceCost : public ceres::CostFunction {
 public:
  RibDistanceCost(const ChainLayout* layout, double weight);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const ChainLayout* layout_;
  double weight_;
};

class GaugeAngleCost : public ceres::CostFunction {
 public:
  /// `s0` holds m gauge angles in rad, `sigma_rad` their standard deviation.
  GaugeAngleCost(const ChainLayout* layout, const Eigen::VectorXd& s0,
                 double sigma_rad);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const ChainLayout* layout_;
  Eigen::VectorXd s0_;
  double sigma_rad_;
};

}  // namespace finray

#endif  // FINRAY_CHAIN_CHAIN_COST_H_
