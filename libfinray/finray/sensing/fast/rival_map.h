#ifndef FINRAY_SENSING_FAST_RIVAL_MAP_H_
#define FINRAY_SENSING_FAST_RIVAL_MAP_H_

#include <Eigen/Core>
#include <vector>

#include "finray/sensing/fast/contact_fit.h"
#include "finray/sensing/gauge_table.h"

namespace finray {

/// Where one contact could be mistaken for another: for each node of a gauge
/// table, the chi2 that the best contact elsewhere leaves of the node's own
/// readings. A frame that is followed from the one before needs no search where
/// that is large: with d = sqrt(chi2) a distance, a contact elsewhere explains
/// readings at a distance r from the node's by no less than (d - r)^2. Between
/// nodes d goes with the force, nearly, and for light forces exactly.
class RivalMap {
 public:
  /// `weights` of a frame with all measurements. `fit` is for contacts of this
  /// finger, without a measured circle.
  RivalMap(const GaugeTable& table, const Eigen::VectorXd& weights,
           ContactFit* fit);

  /// Whether no contact elsewhere explains a frame within `within_noise` of
  /// chi2 as well as (l_c, f_c) does, which leaves `chi2` and has a std of l_c.
  /// False where that is not small against the table's rows: in a valley that
  /// wide there may be two minima.
  bool IsUnique(double arc_mm, double arc_std_mm, double normal_N, double chi2,
                double within_noise) const;

 private:
  double DistancePerN(const GaugeTable::Node& node, double arc_mm,
                      const Eigen::VectorXd& weights, ContactFit* fit);

  const GaugeTable& table_;
  // d over f_c of the table's nodes, without the unloaded one.
  std::vector<std::vector<double>> distance_per_N_;
  std::vector<ContactStart> starts_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_FAST_RIVAL_MAP_H_
