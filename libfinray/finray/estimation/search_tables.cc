#include "finray/estimation/search_tables.h"

#include "finray/estimation/packed_readings.h"
#include "finray/estimation/row_fit.h"

namespace finray {

SearchTables::SearchTables(const Scene& scene,
                           const Discretization& discretization,
                           EquilibriumSolver* solver)
    : scene_(scene),
      table_(solver, scene.friction_coefficient, MeasuredRadius(scene),
             scene.force_max_N),
      surface_(RowFit::SurfaceFor(solver->model().finger(), scene,
                                  discretization, table_.heaviest_N())) {}

const PairTable& SearchTables::Pairs(EquilibriumSolver* solver) const {
  std::call_once(pairs_made_, [&] {
    pairs_ = std::make_unique<const PairTable>(solver, table_.friction());
  });
  return *pairs_;
}

}  // namespace finray
