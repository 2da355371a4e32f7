#ifndef FINRAY_ESTIMATION_CONTACT_SOLUTION_H_
#define FINRAY_ESTIMATION_CONTACT_SOLUTION_H_

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

#include "finray/fit/contact_covariance.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// A start for a fit: contacts from base to tip, a nearby equilibrium, and
/// the approximate chi2 of a fit from there.
struct ContactStart {
  int count = 0;
  std::array<PointContact, kFittedContacts> contacts;
  double chi2 = 0;
  const LadderState* state = nullptr;
  double error = 0;  ///< How far sqrt(chi2) may be wrong, in std.
};

/// A minimum of chi2 over contacts, which are sorted from base to tip.
struct ContactSolution {
  int count = 0;
  std::array<PointContact, kFittedContacts> contacts;
  double chi2 = 0;
  ContactMatrix information;  ///< Fisher's, of (l_c, f_c) of each contact.
  std::array<Eigen::Vector3d, kFittedContacts> poses;  ///< x, y (mm), theta
  Eigen::Vector3d tip_pose;
  std::vector<double> rib_tension_N;
  /// The equilibrium. Fits on a surface leave it out.
  LadderState state;

  /// The lesser force of two.
  double LesserForce_N() const {
    return std::min(contacts[0].normal_N, contacts[count - 1].normal_N);
  }
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_CONTACT_SOLUTION_H_
