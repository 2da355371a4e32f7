#ifndef FINRAY_FINGER_POSSIBLE_READING_H_
#define FINRAY_FINGER_POSSIBLE_READING_H_

#include <cmath>
#include <vector>

#include "finray/finger/finger.h"

namespace finray {

// Which numbers can be readings of a gauge at all. Others come from an open
// cable, a wrong unit or an error code of the electronics.

/// The electronics of no usual gauge give more volts.
constexpr double kLargestReading_V = 1e6;
/// A beam that is bent to a full circle turns all its gauges by this in sum.
/// The gauges of a loaded finger turn by less than a tenth of it.
constexpr double kLargestGaugeAngle_rad = 2 * M_PI;

/// The most by which bending moves the reading of a gauge: the bound of
/// IsPossible without wander_V.
double LargestBending_V(const Gauge& gauge);

/// Says whether a number of volts can be a reading: it is finite, and as far
/// from the offset as the gauge reads at an angle of at most
/// a = kLargestGaugeAngle_rad,
///
///   |V - offset| <= |gain| a (1 + |curvature| a + |flat share|)
///                   (1 + |creep share|) + wander_V,
///
/// where the offset may be `wander_V` from the finger's. A saturated reading
/// (Gauge::min_V, max_V) and a wandering offset go no farther than
/// kLargestReading_V. True for NaN, which stands for no reading.
bool IsPossible(const Gauge& gauge, double volts, double wander_V = 0);

/// Returns the first gauge whose reading in a row is not possible; -1 if there
/// is none. A row with one is bad_input; no other reading of it counts.
int FirstImpossible(const std::vector<Gauge>& gauges,
                    const std::vector<double>& readings_V, double wander_V = 0);
bool ArePossible(const std::vector<Gauge>& gauges,
                 const std::vector<double>& readings_V, double wander_V = 0);

}  // namespace finray

#endif  // FINRAY_FINGER_POSSIBLE_READING_H_
