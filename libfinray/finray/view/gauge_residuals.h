#ifndef FINRAY_VIEW_GAUGE_RESIDUALS_H_
#define FINRAY_VIEW_GAUGE_RESIDUALS_H_

#include <vector>

#include "finray/finger/point_contact.h"
#include "finray/scene/measurements.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// Readings of the gauges less those that the finger has under the estimated
/// contacts, in std of the gauge's noise:
///
///   r_j = (V_j - V_j(angle_j(contacts))) / noise_V_j.
///
/// Frames that follow each other are quick: each solve starts from the one
/// before.
class GaugeResiduals {
 public:
  GaugeResiduals(const Finger& finger, const Discretization& discretization);

  /// `offsets_V` holds the gauges' offsets in this frame; if it is empty they
  /// are the finger's. Writes one residual a gauge; NaN for a reading that is
  /// missing or saturated, and for all if there is no equilibrium.
  void Find(const Measurements& readings,
            const std::vector<PointContact>& contacts,
            const std::vector<double>& offsets_V, float* residuals);
  /// From now on the gauges are these, at the same places.
  void set_gauges(const std::vector<Gauge>& gauges) { gauges_ = gauges; }
  /// The solver, in the state of the last frame.
  const EquilibriumSolver& solver() const { return solver_; }

 private:
  std::vector<Gauge> gauges_;
  EquilibriumSolver solver_;
};

}  // namespace finray

#endif  // FINRAY_VIEW_GAUGE_RESIDUALS_H_
