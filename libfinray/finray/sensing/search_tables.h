#ifndef FINRAY_SENSING_SEARCH_TABLES_H_
#define FINRAY_SENSING_SEARCH_TABLES_H_

#include <memory>
#include <mutex>

#include "finray/scene/scene.h"
#include "finray/sensing/gauge_surface.h"
#include "finray/sensing/gauge_table.h"
#include "finray/sensing/pair_table.h"

namespace finray {

/// What a ContactSearch knows of a finger and a scene before the first frame.
/// It takes some milliseconds to make, and the searches of all threads share
/// it.
class SearchTables {
 public:
  /// `solver` is as after Reset() then. Throws InputError for a finger without
  /// an unloaded equilibrium.
  SearchTables(const Scene& scene, EquilibriumSolver* solver);

  const GaugeTable& table() const { return table_; }
  const GaugeSurface& surface() const { return surface_; }
  /// Made with `solver`, another one for the same finger, by the first call.
  const PairTable& Pairs(EquilibriumSolver* solver) const;

 private:
  GaugeTable table_;
  GaugeSurface surface_;
  mutable std::once_flag pairs_made_;
  mutable std::unique_ptr<const PairTable> pairs_;
};

}  // namespace finray

#endif  // FINRAY_SENSING_SEARCH_TABLES_H_
