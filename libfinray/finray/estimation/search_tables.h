#ifndef FINRAY_ESTIMATION_SEARCH_TABLES_H_
#define FINRAY_ESTIMATION_SEARCH_TABLES_H_

#include <memory>
#include <mutex>

#include "finray/estimation/gauge_table.h"
#include "finray/estimation/pair_table.h"
#include "finray/model/model_surface.h"
#include "finray/scene/scene.h"

namespace finray {

/// The tables of a finger and a scene from which a ContactSearch starts. They
/// take some milliseconds to make, and the searches of all threads share them.
class SearchTables {
 public:
  /// Afterwards `solver` is as after Reset(). Throws InputError for a finger
  /// without an unloaded equilibrium.
  SearchTables(const Scene& scene, const Discretization& discretization,
               EquilibriumSolver* solver);

  const Scene& scene() const { return scene_; }
  const GaugeTable& table() const { return table_; }
  const ModelSurface& surface() const { return surface_; }
  /// The first call makes it with `solver`, which must be one of the same
  /// finger; other threads wait. Afterwards `solver` is as after Reset().
  const PairTable& Pairs(EquilibriumSolver* solver) const;

 private:
  Scene scene_;
  GaugeTable table_;
  ModelSurface surface_;
  mutable std::once_flag pairs_made_;
  mutable std::unique_ptr<const PairTable> pairs_;
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_SEARCH_TABLES_H_
