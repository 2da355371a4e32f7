#ifndef FINRAY_CALIB_DESIGN_FINGER_DESIGN_H_
#define FINRAY_CALIB_DESIGN_FINGER_DESIGN_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "finray/calib/design/contact_accuracy.h"
#include "finray/calib/design/gauge_placement.h"
#include "finray/calib/problem/plan.h"
#include "finray/io/frame_table.h"

namespace finray {

/// The calibration that a finger will have had when it senses.
struct FutureCalibration {
  std::optional<Plan> plan;  ///< Without one the finger's own is taken.
  std::size_t frames = 200;  ///< SpreadContacts
};

/// Returns the finger with the covariance that the calibration will leave. Its
/// frames reach from 0.1 to 0.9 l_0 and up to 10 EI / l_0^2 or `normal_N`.
Finger AfterCalibration(const Finger& finger,
                        const FutureCalibration& calibration, double normal_N,
                        const Discretization& discretization);

/// Returns those of the heights at which the estimator does not tell a contact
/// of `normal_N` even from exact readings: another contact explains them as
/// well, or the std is too large (FrameEstimator::StatusOf). The linear std
/// says nothing of the first kind.
std::vector<double> UntoldHeights(const Finger& finger,
                                  const std::vector<double>& heights_mm,
                                  double normal_N, double friction,
                                  const Discretization& discretization);

/// A finger with its gauges chosen, and the accuracy that it will have.
struct GaugeChoice {
  Finger finger;   ///< With the covariance of the future calibration.
  WorstStd worst;  ///< Over the task's region, calibration included.
  std::vector<double> untold_mm;  ///< UntoldHeights of the region.
};

/// Places `count` gauges: of the best placements by noise alone (PlaceGauges)
/// the one with the fewest UntoldHeights, and of these the one whose goal is
/// best after the calibration. Empty if so many have no room.
std::optional<GaugeChoice> ChooseGauges(const Finger& finger,
                                        const GaugePlaces& places,
                                        const PlacementTask& task, int count,
                                        const FutureCalibration& calibration,
                                        std::uint64_t seed,
                                        const Discretization& discretization);

/// The predicted std along the whole finger, of one contact of `normal_N` and
/// of two contacts of `normal_N` each where there are four gauges. A row has
/// contact_<c>_mm, normal_<c>_N, the std contact_<c>_std_mm and
/// normal_<c>_std_N with the errors of the calibration, and
/// contact_<c>_noise_mm, normal_<c>_noise_N without them. Empty cells: not
/// determined.
FrameTable AccuracyTable(const Finger& finger, double normal_N, double friction,
                         const Discretization& discretization);

}  // namespace finray

#endif  // FINRAY_CALIB_DESIGN_FINGER_DESIGN_H_
