#include "finray/chain/scaled_equations.h"

#include "finray/chain/finger_equations.h"

namespace finray {

Eigen::VectorXd ScaledEquations::ColumnUnits() const {
  const int n = layout.joints(), r = layout.loads() - 3;
  const double length = layout.length_unit_mm, force = layout.force_unit_N;
  Eigen::VectorXd units(n + 3 + r + 2);
  units << Eigen::VectorXd::Ones(n), force * length, force, force,
      Eigen::VectorXd::Constant(r, force), length, force;
  return units;
}

Eigen::VectorXd ScaledEquations::ModelWeights() const {
  const int n = layout.joints(), r = layout.loads() - 3;
  const double length = layout.length_unit_mm;
  Eigen::VectorXd units(n + 3 + r);
  units << 1, length, length,
      Eigen::VectorXd::Constant(n, layout.force_unit_N * length),
      Eigen::VectorXd::Constant(r, length);
  return model_weight * units.cwiseInverse();
}

Eigen::VectorXd ScaledEquations::Residual(const double* theta,
                                          const double* loads,
                                          const double* contact) const {
  Eigen::VectorXd c(rows());
  c.head(layout.joints() + layout.loads()) =
      FingerEquations<double>(layout, theta, loads, contact, friction)
          .cwiseProduct(ModelWeights());
  if (s0.size() > 0) {
    const Eigen::Map<const Eigen::VectorXd> angles(theta, layout.joints());
    c.tail(s0.size()) = (layout.gauges * angles - s0) / gauge_std_rad;
  }
  return c;
}

Eigen::MatrixXd ScaledEquations::Jacobian(const double* theta,
                                          const double* loads,
                                          const double* contact) const {
  const Eigen::MatrixXd model =
      FingerJacobian(layout, theta, loads, contact, friction);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows(), model.cols());
  jacobian.topRows(model.rows()) = ModelWeights().asDiagonal() * model;
  if (s0.size() > 0) {
    jacobian.bottomLeftCorner(s0.size(), layout.joints()) =
        layout.gauges / gauge_std_rad;
  }
  return jacobian;
}

}  // namespace finray
