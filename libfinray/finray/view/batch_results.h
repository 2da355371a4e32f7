#ifndef FINRAY_VIEW_BATCH_RESULTS_H_
#define FINRAY_VIEW_BATCH_RESULTS_H_

#include <map>
#include <string>
#include <vector>

#include "finray/io/warning.h"

namespace finray {

/// What summary.yaml says of one log.
struct LogResult {
  std::string log, result;  ///< Paths; that of the result exists.
  std::size_t frames = 0;
  std::map<std::string, std::size_t> status;  ///< Frames by status.
  std::size_t unexplained = 0;
  std::size_t force_compared = 0;
  std::size_t force_judged = 0;  ///< Those of them with contact and a std.
  double force_rms_N = 0;
  std::size_t free_rows = 0;
  std::vector<double> free_sums_V;  ///< By gauge.
  std::vector<Warning> warnings;
  /// "2026-03-05", from the path or from time_s as seconds since 1970; "" if
  /// neither tells.
  std::string day;
};

struct BadResult {
  std::string log, reason;
};

/// What summary.yaml says of a batch.
struct BatchResults {
  std::string folder, finger;
  std::vector<Warning> warnings;  ///< Of the finger.
  std::vector<LogResult> logs;
  std::vector<BadResult> bad_logs;
};

/// Reads D/summary.yaml. Results are looked for below the folder, which may
/// have been moved. Throws InputError if it cannot be read or if a result is
/// missing.
BatchResults ReadBatchResults(const std::string& folder);

/// Returns the first date in a path, 2026-03-05 or 20260305; "" if there is
/// none.
std::string DayInPath(const std::string& path);
/// Returns the day of a time in seconds since 1970 (UTC); "" before 2001, which
/// is a time since the start of a log.
std::string DayOfTime(double time_s);

/// What a finger's logs ask for.
struct FingerVerdict {
  enum class Kind { kGood, kUnchecked, kWatch, kZero, kCalibrate, kRepair };
  Kind kind;
  std::string words;
};
const char* VerdictName(FingerVerdict::Kind kind);

/// Judges a finger by the warnings of its latest logs: those of the last day
/// that has any, or all where no day is known.
///  - kRepair: a gauge is dead, stuck or clipped, or gauges are wired wrongly;
///  - kCalibrate: nobody has calibrated it, or frames are unexplained or forces
///    differ and the finger may be the cause;
///  - kZero: the offsets have moved, or a gauge has slipped;
///  - kWatch: another warning or cause, or a stronger one on an earlier day;
///  - kUnchecked: no warning, but no frame with contact has the force of a
///    sensor beside it: free rows show no wrong gain or stiffness;
///  - kGood: none of these.
FingerVerdict Judge(const std::vector<Warning>& of_finger,
                    const std::vector<const LogResult*>& logs);

}  // namespace finray

#endif  // FINRAY_VIEW_BATCH_RESULTS_H_
