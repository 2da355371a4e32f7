#include "finray/sensing/search_tables.h"

#include "finray/sensing/packed_readings.h"

namespace finray {

SearchTables::SearchTables(const Scene& scene, EquilibriumSolver* solver)
    : table_(solver, scene.friction_coefficient, MeasuredRadius(scene),
             scene.force_max_N),
      surface_(*solver, scene.friction_coefficient, MeasuredRadius(scene),
               table_.heaviest_N()) {}

const PairTable& SearchTables::Pairs(EquilibriumSolver* solver) const {
  std::call_once(pairs_made_, [&] {
    pairs_ = std::make_unique<const PairTable>(solver, table_.friction());
  });
  return *pairs_;
}

}  // namespace finray
