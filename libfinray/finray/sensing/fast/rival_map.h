#ifndef FINRAY_SENSING_FAST_RIVAL_MAP_H_
#define FINRAY_SENSING_FAST_RIVAL_MAP_H_

#include <Eigen/Core>
#include <mutex>
#include <vector>

#include "finray/sensing/gauge_surface.h"
#include "finray/sensing/gauge_table.h"

namespace finray {

/// Says where one contact could be mistaken for another. For each node of a
/// gauge table the map holds the chi2 that the best contact elsewhere leaves of
/// the node's own readings. A frame that is followed from the one before needs
/// no search where that chi2 is large: with d = sqrt(chi2) as a distance, no
/// contact elsewhere can explain readings at a distance r from the node's with
/// a chi2 below (d - r)^2. Between nodes d is nearly proportional to the force,
/// and exactly so for light forces.
class RivalMap {
 public:
  /// `weights` are those of a frame with all measurements. Table and surface
  /// are of one finger, without a measured circle, and must outlive this. Nodes
  /// are judged when they are first needed; all threads may use a map at once.
  RivalMap(const GaugeTable& table, const GaugeSurface& surface,
           const Eigen::VectorXd& weights, double most_force_N);

  /// Judges all nodes.
  void Prepare() const;

  /// Says whether no contact elsewhere explains a frame as well as (l_c, f_c)
  /// does, to within `within_noise` of chi2. `chi2` and `arc_std_mm` are those
  /// of the solution at (l_c, f_c). Returns false if the std is not small
  /// against the table's row spacing: so wide a valley may hold two minima.
  bool IsUnique(double arc_mm, double arc_std_mm, double normal_N, double chi2,
                double within_noise) const;

 private:
  // A node of the table, once it is judged.
  struct Node {
    std::once_flag judged;
    double distance_per_N = 0;  // d / f_c
  };
  double DistancePerN(std::size_t row, std::size_t node) const;
  double Judge(const GaugeTable::Node& node, double arc_mm) const;

  const GaugeTable& table_;
  const GaugeSurface& surface_;
  Eigen::VectorXd weights_;
  double most_force_N_;
  mutable std::vector<std::vector<Node>> nodes_;  // without the unloaded ones
};

}  // namespace finray

#endif  // FINRAY_SENSING_FAST_RIVAL_MAP_H_
