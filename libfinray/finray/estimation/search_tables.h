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
  /// Throws InputError for a finger without an unloaded equilibrium.
  SearchTables(const Finger& finger, const Scene& scene,
               const Discretization& discretization);

  const Finger& finger() const { return solver_.model().finger(); }
  const Scene& scene() const { return scene_; }
  const GaugeTable& table() const { return table_; }
  const ModelSurface& surface() const { return surface_; }
  /// The first call makes it; other threads wait.
  const PairTable& Pairs() const;

 private:
  Scene scene_;
  mutable EquilibriumSolver solver_;  // makes the tables
  GaugeTable table_;
  ModelSurface surface_;
  mutable std::once_flag pairs_made_;
  mutable std::unique_ptr<const PairTable> pairs_;
};

}  // namespace finray

#endif  // FINRAY_ESTIMATION_SEARCH_TABLES_H_
