#ifndef FINRAY_FIT_CONTACT_COVARIANCE_H_
#define FINRAY_FIT_CONTACT_COVARIANCE_H_

#include <Eigen/Core>

#include "finray/statics/equilibrium.h"

namespace finray {

/// A covariance or information matrix of (l_c, f_c) of each contact, in mm and
/// N.
using ContactMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                                    2 * kFittedContacts, 2 * kFittedContacts>;

/// The inverse of a Fisher information, the Cramer-Rao bound. All variances are
/// infinite if the data leave a direction undetermined up to rounding.
ContactMatrix CovarianceOf(const ContactMatrix& information);

}  // namespace finray

#endif  // FINRAY_FIT_CONTACT_COVARIANCE_H_
