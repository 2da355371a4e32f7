#ifndef FINRAY_ESTIMATION_HIDDEN_FORCES_H_
#define FINRAY_ESTIMATION_HIDDEN_FORCES_H_

#include <vector>

#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"
#include "finray/scene/scene.h"

namespace finray {

/// How hard a contact may press at each place while its frame is no_contact.
struct HiddenForces {
  std::vector<double> contact_mm;  ///< From base to tip, l_0 / 56 apart.
  /// The largest force that noise hides there; the largest credible one
  /// (Scene::force_max_N) where noise hides them all.
  std::vector<double> normal_N;
};

/// Finds the forces that noise hides from this finger. A contact at l_c with
/// f_c is so many std from the free finger,
///
///   D(l_c, f_c)^2 = sum_j ((V_j(l_c, f_c) - V_j(free)) / noise_V_j)^2,
///
/// and `contacts: auto` sees it where D plus the noise exceeds
/// sqrt(FrameEstimator::kSignificance). The force that is hidden has
///
///   D = sqrt(kSignificance) + kNoticed,
///
/// so that a larger one is no_contact in fewer than 1 of 20 frames. It depends
/// on finger and scene only. Takes some 20 ms. Throws InputError for a finger
/// without an unloaded equilibrium.
HiddenForces FindHiddenForces(const Finger& finger, const Scene& scene,
                              const Discretization& discretization);

/// The 95 % quantile of the normal distribution.
constexpr double kNoticed = 1.645;

}  // namespace finray

#endif  // FINRAY_ESTIMATION_HIDDEN_FORCES_H_
