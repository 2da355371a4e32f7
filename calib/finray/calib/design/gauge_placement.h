#ifndef FINRAY_CALIB_DESIGN_GAUGE_PLACEMENT_H_
#define FINRAY_CALIB_DESIGN_GAUGE_PLACEMENT_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "finray/finger/discretization.h"
#include "finray/finger/finger.h"

namespace finray {

/// Which number of a contact the gauges should tell best.
enum class PlacementGoal { kPlace, kForce };

/// Where gauges may be, and for which contacts they are placed.
struct PlacementTask {
  /// Noise, gain and range of every gauge. A strain gauge reads the mean strain
  /// below it, so one of length w has the gain gain * length / w per rad of
  /// bending.
  Gauge gauge;
  std::vector<Side> beams;
  double least_length_mm, most_length_mm;
  /// A gauge keeps so far from hinges, from other gauges and from both ends of
  /// its beam.
  double clearance_mm;
  double from_mm, to_mm;  ///< The region of the contacts.
  double normal_N;
  double friction = 0;
  PlacementGoal goal = PlacementGoal::kPlace;
};

/// Places on whole mm where a gauge may be, and what it feels there.
class GaugePlaces {
 public:
  /// Throws InputError if there is no place, and if the finger cannot carry the
  /// force in the region.
  GaugePlaces(const Finger& finger, const PlacementTask& task,
              const Discretization& discretization);

  std::size_t size() const { return gauges_.size(); }
  const Gauge& gauge(int place) const { return gauges_[place]; }
  bool MayBeTogether(int a, int b) const;
  /// The worst std over the region that gauges at these places leave, by their
  /// noise: of l_c in mm or f_c in N. Infinite where they do not determine it.
  double WorstStd(const std::vector<int>& places) const;

 private:
  struct Bending;
  static Bending BendingOf(const Finger& finger, const PlacementTask& task,
                           Side side, const std::vector<double>& heights,
                           const Discretization& discretization);
  void Add(const Finger& finger, const PlacementTask& task, Side side,
           int length_mm, const Bending& bending);

  PlacementGoal goal_;
  double clearance_mm_;
  std::vector<Gauge> gauges_;
  // Of each gauge: rows (d/dl_c, d/df_c) of the reading in std, a column for
  // each height of the region.
  std::vector<Eigen::Matrix2Xd> feels_;
};

/// A set of gauges and the worst std that their noise leaves.
struct Placement {
  std::vector<Gauge> gauges;  ///< By beam, from base to tip.
  double worst_std;
};

/// Returns the best placements found, the best one first. From each of many
/// random starts gauges are exchanged one by one for the best place of all
/// (Fedorov's exchange), until no exchange lowers the worst std. Empty if so
/// many gauges have no room.
std::vector<Placement> PlaceGauges(const GaugePlaces& places, int count,
                                   std::uint64_t seed);

}  // namespace finray

#endif  // FINRAY_CALIB_DESIGN_GAUGE_PLACEMENT_H_
