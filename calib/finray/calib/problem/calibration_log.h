#ifndef FINRAY_CALIB_PROBLEM_CALIBRATION_LOG_H_
#define FINRAY_CALIB_PROBLEM_CALIBRATION_LOG_H_

#include <algorithm>
#include <string>
#include <vector>

#include "finray/calib/problem/plan.h"
#include "finray/calib/problem/row_times.h"
#include "finray/io/frame_table.h"
#include "finray/residuals/residual_family.h"
#include "finray/scene/measurements.h"

namespace finray {

/// One row of a log. A saturated gauge reads NaN. Pins and tip are filled in
/// only if the plan gives their std.
struct CalibrationFrame : Measurements {
  int log = 0;  ///< Index of the log.
  int row = 0;  ///< Index of the row in its log.
  /// The finger touches the object. If not, this is a free frame or a row of
  /// the bench.
  bool contact = false;
  /// The force is too small to tell whether the finger touches, and so is the
  /// depth to which the object reaches, or they contradict each other.
  bool undecided = false;
  bool held_out = false;  ///< The fit does not use the frame.
  /// The std of the place, of the object or the contact, and of everything else
  /// count so many times, because the row repeats others (repeated_rows.h).
  double place_std_times = 1, readings_std_times = 1;

  /// How many times the plan's force_std_N is the std of the force in this row,
  /// where the row is a mean and the plan states no std.
  double force_std_times = 1;

  double ForceStd_N(const Plan& plan) const {
    return force_std_times * plan.force_std_N;
  }
  /// How many times the std of a family counts.
  double StdTimes(ResidualFamily family) const {
    return family == ResidualFamily::kObject ||
                   family == ResidualFamily::kContact
               ? place_std_times
               : readings_std_times;
  }
};

/// All logs of a calibration.
struct CalibrationLogs {
  std::vector<std::string> paths;
  /// File names of the logs. If two are the same, they get as much more of
  /// their paths as tells them apart.
  std::vector<std::string> names;
  std::vector<CalibrationFrame> frames;
  /// The std of one reading of each gauge where rows are means of readings: the
  /// root mean square of gauge_<j>_scatter_V. NaN for a gauge without. A row
  /// has it over the root of its gauge_readings, unless the plan states the std
  /// of rows: its frames then count as one reading each.
  std::vector<double> reading_std_V;
  /// How time_s runs in each log; those of the bench need no time.
  std::vector<RowTimes> times;
  /// Says which rows were written twice and are left out (repeated_rows.h);
  /// empty if there are none.
  std::string copies;
  /// The paths of logs of which nothing is left then.
  std::vector<std::string> left_out;

  /// Says for each log whether all its rows are held out.
  std::vector<bool> HeldOut() const;
};

/// Says whether `has` is true for a fitted frame of the log.
template <class Has>
bool AnyFitted(const CalibrationLogs& logs, int log, const Has& has) {
  return std::any_of(logs.frames.begin(), logs.frames.end(),
                     [&](const CalibrationFrame& frame) {
                       return frame.log == log && !frame.held_out && has(frame);
                     });
}

/// What to do about CalibrationLogs::copies.
inline constexpr char kCopiesRemedy[] =
    "look at what writes the log; a row that repeats another tells nothing new";

/// Reads the logs and decides row by row whether the finger touches. The first
/// of these measurements that the row has decides:
///  - a reference force: the finger touches if noise does not explain the force
///    (MeasuredForce::IsWithinNoise);
///  - the centre of the object: it touches if the object reaches into the
///    undeformed finger by more than 3 std;
///  - a contact location: it touches.
///
/// A row with none of them counts as touching. If the offset of the force
/// sensor is unknown, the object comes first, and the noise of the
/// force counts as its std and that of the prior of the offset together. The
/// scene's `contacts: 0` or `1` overrides all that.
///
/// A row whose force is within noise of zero, or not known, is undecided if the
/// object is where it might touch: it reaches in by more than -3 std, and by no
/// more than 3 std if the force is not known. A row whose force is above that,
/// by less than twice, is undecided if the object is further away than that.
///
/// A row with a cylinder_radius_mm belongs to the bench. If the plan needs a
/// time or a temperature that a row lacks, the row gets that of the row before;
/// both change slowly. The function marks the held-out frames. It throws
/// InputError for a missing gauge column (a log without any may have pins
/// instead), for a free parameter whose column is missing, and for logs that
/// are too short to hold anything out.
CalibrationLogs ReadCalibrationLogs(const std::vector<std::string>& paths,
                                    const Finger& finger, const Plan& plan);
/// The same of tables in memory, whose columns have the names of the
/// vocabulary. Their path() is their name.
CalibrationLogs ReadCalibrationLogs(const std::vector<FrameTable>& tables,
                                    const Finger& finger, const Plan& plan);

}  // namespace finray

#endif  // FINRAY_CALIB_PROBLEM_CALIBRATION_LOG_H_
