#ifndef FINRAY_CALIB_DESIGN_RECORDING_SHORTFALL_H_
#define FINRAY_CALIB_DESIGN_RECORDING_SHORTFALL_H_

#include <cstddef>
#include <string>

namespace finray {

/// Why a recording does not suffice, from as many rows at its places as
/// kMostTimes its own: what they leave no averaging reduces.
struct RecordingShortfall {
  static constexpr int kMostTimes = 64;

  /// About so many rows would suffice; 0 if no number does.
  std::size_t rows = 0;
  /// The share that meets the target with kMostTimes the rows.
  double met = 0;
  /// The number of drawn fingers; of these, the number that misses the target
  /// with so many rows, the number whose noise of one frame is larger than it,
  /// and the number that does not touch within force_max_N in most rows.
  int draws = 0, missing = 0, noisy = 0, out_of_reach = 0;
  /// What the rows leave unknown in the other ones, most often.
  std::string parameter;

  /// Says what helps.
  std::string Remedy() const;
};

}  // namespace finray

#endif  // FINRAY_CALIB_DESIGN_RECORDING_SHORTFALL_H_
