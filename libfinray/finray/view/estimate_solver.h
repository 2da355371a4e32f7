#ifndef FINRAY_VIEW_ESTIMATE_SOLVER_H_
#define FINRAY_VIEW_ESTIMATE_SOLVER_H_

#include <vector>

#include "finray/finger/point_contact.h"
#include "finray/scene/measurements.h"
#include "finray/statics/equilibrium.h"

namespace finray {

/// Solves the finger under the estimated contacts of frames. Frames that follow
/// each other are quick: each solve starts from the one before. To find that a
/// load has no equilibrium takes long, so after kPatience such loads it only
/// looks near the state before.
class EstimateSolver {
 public:
  EstimateSolver(const Finger& finger, const Discretization& discretization);

  /// Solves the frame; false if there is no equilibrium.
  bool Solve(const std::vector<PointContact>& contacts);
  /// Solves a frame, and finds the readings of its gauges less those of the
  /// finger in std of their noise:
  ///
  ///   r_j = (V_j - V_j(angle_j(contacts))) / noise_V_j.
  ///
  /// `offsets_V` holds the gauges' offsets in this frame; if it is empty they
  /// are the finger's. Writes one residual a gauge; NaN for a reading that is
  /// missing or saturated, and for all if there is no equilibrium.
  void FindResiduals(const Measurements& readings,
                     const std::vector<PointContact>& contacts,
                     const std::vector<double>& offsets_V, float* residuals);
  /// From now on the gauges are these, at the same places.
  void set_gauges(const std::vector<Gauge>& gauges) { gauges_ = gauges; }
  /// The solver, in the state of the last frame.
  const EquilibriumSolver& solver() const { return solver_; }

  static constexpr int kPatience = 20;

 private:
  std::vector<Gauge> gauges_;
  EquilibriumSolver solver_;
  int failures_ = 0;
};

}  // namespace finray

#endif  // FINRAY_VIEW_ESTIMATE_SOLVER_H_
