#ifndef FINRAY_BATCH_ESTIMATION_SUMMARY_H_
#define FINRAY_BATCH_ESTIMATION_SUMMARY_H_

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "finray/finger/finger.h"
#include "finray/io/warning.h"
#include "finray/io/yaml_emitter.h"
#include "finray/sensing/frame_estimator.h"

namespace finray {

/// Counts and force errors of one or more logs. It holds plain sums, so that a
/// summary that was written and read back continues to the same result.
struct EstimationSummary {
  static constexpr FrameStatus kStatuses[] = {
      FrameStatus::kOk, FrameStatus::kNoContact, FrameStatus::kUnobservable,
      FrameStatus::kNotConverged, FrameStatus::kBadInput};

  std::size_t frames = 0;
  std::array<std::size_t, 5> by_status{};  ///< indexed by FrameStatus
  /// Solved frames that neither the described finger nor its noise explains:
  /// the p-value of chi2 is below FrameEstimate::kUnexplained.
  std::size_t unexplained = 0;
  /// The comparison with the log's own force_N, over the frames that have it
  /// and are ok or no_contact.
  std::size_t force_compared = 0;
  double force_squares_N2 = 0;
  double force_max_N = 0;

  std::size_t count(FrameStatus status) const {
    return by_status[static_cast<std::size_t>(status)];
  }
  /// Number of frames that are not_converged or bad_input.
  std::size_t unsolved() const;
  /// More than kMostUnexplained of the solved frames are unexplained, and at
  /// least kFewestUnexplained of them: fewer are chance in some of many short
  /// logs.
  bool unexplained_too_many() const;
  static constexpr double kMostUnexplained = 0.05;
  static constexpr std::size_t kFewestUnexplained = 3;
  /// Rms of the force error; 0 if no force was compared.
  double force_rms_N() const;

  /// Counts one frame. `force_N` is the reference force, NaN if there is none;
  /// `friction` is the scene's mu.
  void Add(const FrameEstimate& estimate, double friction, double force_N);
  /// Adds the frames of another summary.
  void Add(const EstimationSummary& other);
};

/// Warns of a finger that nobody has calibrated.
std::vector<Warning> WarningsOf(const Finger& finger);
/// Warns of too many frames of `source` that the finger does not explain. The
/// text begins with the likeliest cause.
Warning UnexplainedWarning(const EstimationSummary& summary,
                           const Finger& finger, const std::string& source);

/// Writes a summary as one line of text, and reads it back. Reading returns
/// nothing if the text is not a summary.
std::string SummaryToText(const EstimationSummary& summary);
std::optional<EstimationSummary> SummaryFromText(const std::string& text);

/// Writes the summary's keys of a summary.yaml into the mapping that `yaml` is
/// in.
void EmitSummary(const EstimationSummary& summary, YamlEmitter* yaml);

}  // namespace finray

#endif  // FINRAY_BATCH_ESTIMATION_SUMMARY_H_
