#ifndef FINRAY_BATCH_ESTIMATION_SUMMARY_H_
#define FINRAY_BATCH_ESTIMATION_SUMMARY_H_

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "finray/estimation/frame_estimator.h"
#include "finray/estimation/walk_increments.h"
#include "finray/finger/finger.h"
#include "finray/io/yaml_emitter.h"
#include "finray/io/yaml_map.h"
#include "finray/scene/measurements.h"

namespace finray {

/// Counts and force errors of one or more logs. It holds plain sums, so that a
/// summary that was written and read back continues to the same result.
struct EstimationSummary {
  static constexpr FrameStatus kStatuses[] = {
      FrameStatus::kOk, FrameStatus::kNoContact, FrameStatus::kUnobservable,
      FrameStatus::kNotConverged, FrameStatus::kBadInput};

  std::size_t frames = 0;
  /// Rows that were left out as bad; they are no frames.
  std::size_t bad_rows = 0;
  std::array<std::size_t, 5> by_status{};  ///< indexed by FrameStatus
  /// Solved frames that neither the described finger nor its noise explains
  /// (FrameEstimate::IsUnexplained), but for those that two contacts may
  /// explain (FrameEstimator::kUntoldSignificance).
  std::size_t unexplained = 0;
  /// Frames whose search Scene::search_iteration_limit has ended.
  std::size_t search_ended = 0;
  /// The comparison with the log's own force (Measurements::Force), over the
  /// frames that have it and are ok or no_contact.
  std::size_t force_compared = 0;
  double force_squares_N2 = 0;
  double force_max_N = 0;
  /// The number of ok frames among the compared ones, the sum of the variances
  /// that they claim, and the number of them that it contradicts. An error
  /// contradicts if it exceeds kFarStd of the std, kFarShare of it, and
  /// kFreeForce_N. The std of two forces together is at most their sum.
  std::size_t force_judged = 0, force_far = 0;
  double force_variances_N2 = 0;
  static constexpr double kFarStd = 5, kFarShare = 0.1;
  /// Frames that are bad_input for a reading that no gauge gives (IsPossible),
  /// and the first such reading: the row of the result and the gauge, both from
  /// 1, and its volts as text, since they may be inf.
  std::size_t impossible = 0;
  std::size_t impossible_row = 0, impossible_gauge = 0;
  std::string impossible_V = "0";
  /// Rows that the sensor shows to be free of contact, by a magnitude of at
  /// most kFreeForce_N whatever its axes, since nobody states its noise here;
  /// and the sums of their readings by gauge.
  std::size_t free_rows = 0;
  std::vector<double> free_sums_V;
  static constexpr double kFreeForce_N = 0.06;  // 3 std of a usual sensor
  /// Of whole logs whose offsets wander (LogEstimator).
  WalkIncrements walk;
  /// Frames of whole logs that were estimated one by one.
  std::size_t alone = 0;
  /// Sums of FrameEstimate::change_chi2 and change_dof.
  double change_chi2 = 0, change_dof = 0;

  std::size_t count(FrameStatus status) const {
    return by_status[static_cast<std::size_t>(status)];
  }
  bool any_bad_rows() const { return bad_rows > 0; }
  bool any_impossible() const { return impossible > 0; }
  bool any_alone() const { return alone > 0; }
  /// Contacts change kFarChange times as much from frame to frame as the
  /// scene's smoothing says, or more, and not by chance.
  bool changes_differ() const;
  static constexpr double kFarChange = 1.5;
  bool offsets_move_otherwise() const {
    const WalkIncrements::Verdict verdict = walk.Judge();
    // Short windows that converge say little of a log that mostly does not.
    return verdict != WalkIncrements::Verdict::kFits &&
           (verdict != WalkIncrements::Verdict::kTooLarge ||
            2 * alone < frames);
  }
  /// Number of frames that are not_converged or bad_input.
  std::size_t unsolved() const;
  /// More than kMostUnexplained of the solved frames are unexplained, and at
  /// least kFewestUnexplained of them: fewer are chance in some of many short
  /// logs.
  bool unexplained_too_many() const;
  static constexpr double kMostUnexplained = 0.05;
  /// Not that many, but more than kSomeUnexplained of them.
  bool unexplained_some() const;
  static constexpr double kSomeUnexplained = 0.01;
  static constexpr std::size_t kFewestUnexplained = 3;
  /// More than kMostUnexplained of the judged frames are contradicted by
  /// the sensor, and at least kFewestUnexplained of them.
  bool forces_differ() const;
  /// No frame of at least kManyFrames is without a contact, and hardly any
  /// estimate can be compared with a force.
  bool never_free() const;
  static constexpr std::size_t kManyFrames = 50;
  /// As many rows are free as must be before one speaks of them.
  bool any_free_rows() const { return free_rows >= kFewestUnexplained; }
  /// Rms of the force error; 0 if no force was compared.
  double force_rms_N() const;
  /// Rms of the std that the judged estimates claim.
  double force_std_N() const;

  /// Counts one frame; `coefficient` is the scene's mu, for a frame whose
  /// friction is not told by the object's motion.
  void Add(const FrameEstimate& estimate, double coefficient,
           const Measurements& readings, const Finger& finger);
  /// Adds the frames of another summary.
  void Add(const EstimationSummary& other);
};

/// Writes a summary as one line of text, without what only whole logs have,
/// which do not resume, and reads it back. Reading returns nothing if the text
/// is not a summary.
std::string SummaryToText(const EstimationSummary& summary);
std::optional<EstimationSummary> SummaryFromText(const std::string& text);

/// Writes the keys of a summary.yaml that tell how scenes fit the changes from
/// frame to frame, if there are any, and reads them back.
void EmitChanges(const EstimationSummary& summary, YamlEmitter* yaml);
void ReadChanges(const YamlMap& yaml, EstimationSummary* summary);

/// Writes the summary's keys of a summary.yaml into the mapping that `yaml` is
/// in, except those of EmitRowsOfLog.
void EmitSummary(const EstimationSummary& summary, YamlEmitter* yaml);
/// Writes the keys that speak of the rows of one log: the first reading that no
/// gauge gives, and the free rows, if there are any.
void EmitRowsOfLog(const EstimationSummary& summary, YamlEmitter* yaml);

}  // namespace finray

#endif  // FINRAY_BATCH_ESTIMATION_SUMMARY_H_
