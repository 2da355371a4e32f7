#ifndef FINRAY_SENSING_CONTACT_COVARIANCE_H_
#define FINRAY_SENSING_CONTACT_COVARIANCE_H_

#include <Eigen/Core>

#include "finray/statics/equilibrium.h"

namespace finray {

/// Of (l_c, f_c) of each contact, mm and N.
using ContactMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                                    2 * kFittedContacts, 2 * kFittedContacts>;

/// The inverse of a Fisher information, the Cramer-Rao bound. Where the data
/// leave a direction open to rounding, all variances are infinite.
ContactMatrix CovarianceOf(const ContactMatrix& information);

}  // namespace finray

#endif  // FINRAY_SENSING_CONTACT_COVARIANCE_H_
