#ifndef FINRAY_BATCH_ESTIMATION_SUMMARY_H_
#define FINRAY_BATCH_ESTIMATION_SUMMARY_H_

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "finray/io/yaml_emitter.h"
#include "finray/sensing/frame_estimator.h"

namespace finray {

/// How a log, or several, came out. Sums are kept as they are added up, so that
/// a summary that was written and read back goes on to the same result.
struct EstimationSummary {
  static constexpr FrameStatus kStatuses[] = {
      FrameStatus::kOk, FrameStatus::kNoContact, FrameStatus::kUnobservable,
      FrameStatus::kNotConverged, FrameStatus::kBadInput};

  std::size_t frames = 0;
  std::array<std::size_t, 5> by_status{};  ///< indexed by FrameStatus
  /// Solved, but neither the finger as described nor its noise makes such
  /// readings: p-value of chi2 below FrameEstimate::kUnexplained.
  std::size_t unexplained = 0;
  /// Against the log's own force_N, where it has one and the frame is ok or
  /// no_contact.
  std::size_t force_compared = 0;
  double force_squares_N2 = 0;
  double force_max_N = 0;

  std::size_t count(FrameStatus status) const {
    return by_status[static_cast<std::size_t>(status)];
  }
  /// Frames that are not_converged or bad_input.
  std::size_t unsolved() const;
  /// 0 if no force was compared.
  double force_rms_N() const;

  /// Counts one frame; `force_N` is the reference, NaN if there is none.
  /// `friction` is the scene's mu.
  void Add(const FrameEstimate& estimate, double friction, double force_N);
  /// Adds the frames of another one.
  void Add(const EstimationSummary& other);
};

/// On one line, and back; nothing if it is none.
std::string SummaryToText(const EstimationSummary& summary);
std::optional<EstimationSummary> SummaryFromText(const std::string& text);

/// The keys of a summary.yaml, into a mapping that has been begun.
void EmitSummary(const EstimationSummary& summary, YamlEmitter* yaml);

}  // namespace finray

#endif  // FINRAY_BATCH_ESTIMATION_SUMMARY_H_
