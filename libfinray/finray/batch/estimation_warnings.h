#ifndef FINRAY_BATCH_ESTIMATION_WARNINGS_H_
#define FINRAY_BATCH_ESTIMATION_WARNINGS_H_

#include <string>
#include <vector>

#include "finray/batch/estimation_summary.h"
#include "finray/batch/log_cause.h"
#include "finray/finger/finger.h"
#include "finray/io/warning.h"
#include "finray/scene/scene.h"

namespace finray {

/// The summary of a log, its name, and why the finger does not fit it.
struct LogSummary {
  const EstimationSummary* summary;
  std::string log;
  const LogCause* cause = nullptr;  ///< Null: nobody has looked.
};

/// Warns of a finger that nobody has calibrated, and of what FrictionWarnings
/// finds.
std::vector<Warning> WarningsOf(const Finger& finger, const Scene& scene);

/// Warns where the finger was calibrated with another friction than the scene
/// has: they are more than 0.02 apart, more than the std of a friction that the
/// calibration has found, and more than twice the scene's friction_std. Warns
/// of a presliding_mm that does nothing.
std::vector<Warning> FrictionWarnings(const Finger& finger, const Scene& scene);

/// Says what makes the estimates of logs doubtful, one warning a code. It names
/// the worst log and counts the others:
///  - gauge_fault: gauges are dead, stuck, frozen or clipped, whatever frames
///    show;
///  - unexplained_frames: the finger and its noise do not explain too many
///    frames;
///  - some_unexplained_frames: not so many, but more than chance makes;
///  - forces_differ: force_N contradicts too many forces, or shows free rows
///    where every frame has a contact;
///  - offset_walk: the offsets wander more than the scene says, or drift
///    steadily;
///  - wide_offset_walk: they wander less;
///  - smoothing: contacts change more from frame to frame than the scene says;
///  - not_joint: frames of a whole log were estimated one by one;
///  - bad_rows: rows were left out as bad input;
///  - impossible_readings: rows are bad_input for a reading that no gauge
///  gives;
///    it names the first one, and what the gauge gives at most;
///  - never_free: every frame has a contact and no force_N says otherwise.
/// Offsets that have moved alike make all gauges consistent with contacts that
/// are not there, so chi2 does not show them. Where force_N marks free rows,
/// the text has the shift of each gauge there,
///
///   mean V_j - (offset_j + gain_j angle_j(free finger)).
///
/// Those of frames and forces begin with the log's cause, if somebody has
/// looked for it (log_cause.h).
std::vector<Warning> WarningsOf(const std::vector<LogSummary>& logs,
                                const Finger& finger);

/// Says whether one of these warnings but gauge_fault needs FindLogCause.
bool NeedsCause(const EstimationSummary& summary);

/// Says whether --strict fails with one of these warnings: gauge_fault,
/// unexplained_frames, forces_differ, offset_walk, smoothing, and never_free
/// unless the scene states the number of contacts of every frame, so that it is
/// meant.
bool FailsStrict(const std::vector<Warning>& warnings, const Scene& scene);

}  // namespace finray

#endif  // FINRAY_BATCH_ESTIMATION_WARNINGS_H_
