#ifndef FINRAY_TESTS_CHAIN_JET_JACOBIAN_H_
#define FINRAY_TESTS_CHAIN_JET_JACOBIAN_H_

#include <ceres/jet.h>

#include <Eigen/Core>
#include <vector>

namespace finray {

using Jet1 = ceres::Jet<double, 1>;
using JetVector = Eigen::Matrix<Jet1, Eigen::Dynamic, 1>;

/// The Jacobian of f: JetVector -> JetVector at x by forward differentiation,
/// one column a pass.
template <typename F>
Eigen::MatrixXd JetJacobian(const F& f, const Eigen::VectorXd& x) {
  Eigen::MatrixXd jacobian;
  for (int j = 0; j < x.size(); ++j) {
    JetVector at(x.size());
    for (int i = 0; i < x.size(); ++i) {
      at[i] = Jet1(x[i]);
      if (i == j) at[i].v[0] = 1;
    }
    const JetVector y = f(at);
    if (j == 0) jacobian.resize(y.size(), x.size());
    for (int i = 0; i < y.size(); ++i) jacobian(i, j) = y[i].v[0];
  }
  return jacobian;
}

/// Largest difference over the largest entry.
inline double RelativeError(const Eigen::MatrixXd& value,
                            const Eigen::MatrixXd& expected) {
  const double scale = expected.cwiseAbs().maxCoeff();
  const double error = (value - expected).cwiseAbs().maxCoeff();
  return scale > 0 ? error / scale : error;
}

}  // namespace finray

#endif  // FINRAY_TESTS_CHAIN_JET_JACOBIAN_H_
