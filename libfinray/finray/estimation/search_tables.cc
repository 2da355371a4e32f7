#include "finray/estimation/search_tables.h"

#include "finray/estimation/packed_readings.h"
#include "finray/estimation/row_fit.h"

namespace finray {

SearchTables::SearchTables(const Finger& finger, const Scene& scene,
                           const Discretization& discretization)
    : scene_(scene),
      solver_(finger, discretization),
      table_(&solver_, scene.friction_coefficient, MeasuredRadius(scene),
             scene.force_max_N),
      surface_(RowFit::SurfaceFor(finger, scene, discretization,
                                  table_.heaviest_N())) {}

const PairTable& SearchTables::Pairs() const {
  std::call_once(pairs_made_, [&] {
    pairs_ = std::make_unique<const PairTable>(&solver_, table_.friction());
  });
  return *pairs_;
}

}  // namespace finray
