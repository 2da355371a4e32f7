#include "finray/finger/gauge_discrepancy.h"

#include <algorithm>

namespace finray {

void GaugeDiscrepancy::AddTo(double arc_mm, double normal_N,
                             Eigen::MatrixXd* covariance) const {
  const double size = 1 + normal_N * normal_N / (load_N * load_N);
  const auto behind = std::upper_bound(
      places.begin(), places.end(), arc_mm,
      [](double arc, const Place& place) { return arc < place.place_mm; });
  if (behind == places.begin() || behind == places.end()) {
    const Place& end = behind == places.begin() ? *behind : places.back();
    *covariance += size * end.covariance_rad2;
    return;
  }
  const Place& before = *(behind - 1);
  const double share =
      (arc_mm - before.place_mm) / (behind->place_mm - before.place_mm);
  *covariance += size * (1 - share) * before.covariance_rad2;
  *covariance += size * share * behind->covariance_rad2;
}

}  // namespace finray
