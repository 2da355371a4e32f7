#ifndef FINRAY_CHAIN_CERES_SENSING_H_
#define FINRAY_CHAIN_CERES_SENSING_H_

#include "finray/chain/sensing.h"

namespace finray {

/// SenseContact with ceres::Solve in place of Newton (18): the same weighted
/// rows as the residual blocks of chain_cost.h, minimised over the full
/// coordinates (theta, F_t, f, l_c, f_c) from the equilibrium under `start`.
/// Gauge rows are whitened by `gauge_std_rad` and the model's rows by the same,
/// which leaves the minimum where SenseContact has it. Bounds as there:
/// l_c on the beam, f_c >= 0.
///
/// `converged` says that Ceres calls the solution usable and that it meets the
/// model.
ChainSensing SenseContactWithCeres(const ChainLayout& layout,
                                   const Eigen::VectorXd& s0,
                                   const ChainContact& start,
                                   double gauge_std_rad = 3e-4,
                                   const ChainSensingOptions& options = {});

}  // namespace finray

#endif  // FINRAY_CHAIN_CERES_SENSING_H_
