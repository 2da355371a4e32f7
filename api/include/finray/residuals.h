#ifndef FINRAY_RESIDUALS_H_
#define FINRAY_RESIDUALS_H_

#include <ceres/cost_function.h>

#include <memory>
#include <vector>

#include "finray/export.h"
#include "finray/finger.h"
#include "finray/scene.h"
#include "finray/simulator.h"

namespace finray::v1 {

/// The finger as cost functions for a ceres::Problem of your own: the state of
/// the finger under contacts, with its derivatives, and the residuals of its
/// gauges. A residual of your own takes the state by
/// ceres::CostFunctionToFunctor or calls its Evaluate
/// (examples/own_residual.cc).
///
/// Equilibrium is solved inside and holds exactly. Its derivatives follow from
/// the implicit function theorem. Parameter blocks:
///
///   [l_c, f_c of each contact (2 contacts, mm and N)], and in the functions
///   `OfParameters` behind it
///   [ln EI front (1) | ln EI back (1) | rib lengths (ribs(), mm; left out if
///   the finger has no ribs)], EI in N mm^2.
///
/// Evaluate() returns false where the finger has no equilibrium; Ceres then
/// takes a smaller step. Let l_c stay within [0, front_length_mm] and f_c >= 0
/// by bounds. A cost function may be evaluated from one thread at a time; make
/// one for each residual block. All of them may outlive this object. The caller
/// owns them, or the ceres::Problem that takes them.
class FINRAY_API FrameResiduals {
 public:
  /// Throws InputError for a finger that the scheme cannot model. The scene
  /// gives the friction coefficient.
  explicit FrameResiduals(const Finger& finger, int contacts = 1,
                          const Scene& scene = Scene(),
                          const Discretization& discretization = {});

  /// Rows of the state:
  ///   [bending angle of each gauge (rad), undeformed 0;
  ///    x, y (mm) and theta (rad) of the front beam at each contact;
  ///    x, y, theta of the tip].
  int state_size() const { return tip_row() + 3; }
  int contact_row(int contact) const { return gauges_ + 3 * contact; }
  int tip_row() const { return gauges_ + 3 * contacts_; }

  ceres::CostFunction* State() const;
  ceres::CostFunction* StateOfParameters() const;

  /// One residual a gauge, whitened by its noise_V:
  ///   r_j = (V_j(alpha_j) - volts_j) / noise_V_j;
  /// a NaN among `volts` (not measured) gives a zero residual. Throws
  /// InputError if there are not as many volts as gauges.
  ceres::CostFunction* Gauges(const std::vector<double>& volts) const;

  /// ln of the finger's EI and its rib lengths, to start from.
  double ln_front_stiffness() const;
  double ln_back_stiffness() const;
  std::vector<double> rib_lengths_mm() const;

  struct Inside;

 private:
  std::shared_ptr<const Inside> inside_;
  int gauges_, contacts_;
};

}  // namespace finray::v1

#endif  // FINRAY_RESIDUALS_H_
