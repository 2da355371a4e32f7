#ifndef FINRAY_SENSING_FAST_RIVAL_MAP_H_
#define FINRAY_SENSING_FAST_RIVAL_MAP_H_

#include <Eigen/Core>
#include <vector>

#include "finray/sensing/fast/contact_fit.h"
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
  /// `weights` are those of a frame with all measurements. `fit` must be for
  /// this finger, without a measured circle; its tolerance is set. The table
  /// must outlive this.
  RivalMap(const GaugeTable& table, const Eigen::VectorXd& weights,
           ContactFit* fit);

  /// Says whether no contact elsewhere explains a frame as well as (l_c, f_c)
  /// does, to within `within_noise` of chi2. `chi2` and `arc_std_mm` are those
  /// of the solution at (l_c, f_c). Returns false if the std is not small
  /// against the table's row spacing: so wide a valley may hold two minima.
  bool IsUnique(double arc_mm, double arc_std_mm, double normal_N, double chi2,
                double within_noise) const;

 private:
  double DistancePerN(const GaugeTable::Node& node, double arc_mm,
                      const Eigen::VectorXd& weights, ContactFit* fit);

  const GaugeTable& table_;
  // d / f_c of the table's nodes, without the unloaded one.
  std::vector<std::vector<double>> distance_per_N_;
  std::vector<ContactStart> profile_, starts_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_FAST_RIVAL_MAP_H_
