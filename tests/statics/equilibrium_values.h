#ifndef FINRAY_TESTS_STATICS_EQUILIBRIUM_VALUES_H_
#define FINRAY_TESTS_STATICS_EQUILIBRIUM_VALUES_H_

#include <Eigen/Core>
#include <vector>

#include "finray/statics/equilibrium.h"

namespace finray {

/// (M, F_x, F_y) in N mm and N that the clamp exerts on a beam's base.
inline Eigen::Vector3d BaseReaction(const EquilibriumSolver& solver,
                                    Side side) {
  return -solver.state().q.segment<3>(3 * LadderModel::Index(side));
}

/// The arc lengths of ends, nodes and contacts, base to tip; the beam is smooth
/// between them.
inline std::vector<double> Stations(const EquilibriumSolver& solver,
                                    const std::vector<PointContact>& contacts,
                                    Side side) {
  const auto spans = solver.Spans(contacts)[LadderModel::Index(side)];
  std::vector<double> stations;
  for (const BeamSpan& span : spans) stations.push_back(span.arc_mm);
  stations.push_back(spans.back().arc_mm + spans.back().length_mm);
  return stations;
}

}  // namespace finray

#endif  // FINRAY_TESTS_STATICS_EQUILIBRIUM_VALUES_H_
