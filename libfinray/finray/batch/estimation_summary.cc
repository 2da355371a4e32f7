#include "finray/batch/estimation_summary.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "finray/io/number_text.h"
#include "finray/io/yaml_emitter.h"

namespace finray {

std::size_t EstimationSummary::unsolved() const {
  return count(FrameStatus::kNotConverged) + count(FrameStatus::kBadInput);
}

bool EstimationSummary::unexplained_too_many() const {
  return unexplained >= kFewestUnexplained &&
         static_cast<double>(unexplained) >
             kMostUnexplained * static_cast<double>(frames - unsolved());
}

double EstimationSummary::force_rms_N() const {
  if (force_compared == 0) return 0;
  return std::sqrt(force_squares_N2 / static_cast<double>(force_compared));
}

void EstimationSummary::Add(const FrameEstimate& estimate, double friction,
                            double force_N) {
  ++frames;
  ++by_status[static_cast<std::size_t>(estimate.status)];
  if (estimate.status == FrameStatus::kNotConverged ||
      estimate.status == FrameStatus::kBadInput) {
    return;
  }
  if (estimate.p_value() < FrameEstimate::kUnexplained) ++unexplained;
  // The contacts of unobservable frames are unreliable, so they are not
  // compared.
  if (estimate.status == FrameStatus::kUnobservable) return;
  if (std::isnan(force_N)) return;
  const double error = EstimatedForce(estimate, friction) - force_N;
  force_squares_N2 += error * error;
  force_max_N = std::max(force_max_N, std::abs(error));
  ++force_compared;
}

void EstimationSummary::Add(const EstimationSummary& other) {
  frames += other.frames;
  for (std::size_t i = 0; i < by_status.size(); ++i) {
    by_status[i] += other.by_status[i];
  }
  unexplained += other.unexplained;
  force_compared += other.force_compared;
  force_squares_N2 += other.force_squares_N2;
  force_max_N = std::max(force_max_N, other.force_max_N);
}

std::string SummaryToText(const EstimationSummary& summary) {
  std::string text = std::to_string(summary.frames);
  for (const std::size_t count : summary.by_status) {
    text += " " + std::to_string(count);
  }
  return text + " " + std::to_string(summary.unexplained) + " " +
         std::to_string(summary.force_compared) + " " +
         NumberText(summary.force_squares_N2) + " " +
         NumberText(summary.force_max_N);
}

std::optional<EstimationSummary> SummaryFromText(const std::string& text) {
  std::istringstream stream(text);
  EstimationSummary summary;
  stream >> summary.frames;
  for (std::size_t& count : summary.by_status) stream >> count;
  std::string squares, largest, rest;
  if (!(stream >> summary.unexplained >> summary.force_compared >> squares >>
        largest) ||
      stream >> rest) {
    return std::nullopt;
  }
  const std::optional<double> sum = ParseNumber(squares);
  const std::optional<double> max = ParseNumber(largest);
  if (!sum || !max) return std::nullopt;
  summary.force_squares_N2 = *sum;
  summary.force_max_N = *max;
  return summary;
}

std::vector<Warning> WarningsOf(const Finger& finger) {
  if (finger.calibration) return {};
  return {
      {"not_calibrated",
       "the finger is not calibrated: its gains and stiffness are as drawn, "
       "and so are the std of its forces",
       "calibrate it with finray_calibrate"}};
}

Warning UnexplainedWarning(const EstimationSummary& summary,
                           const Finger& finger, const std::string& source) {
  return {"unexplained_frames",
          std::string(finger.calibration
                          ? "the gauges' offsets have probably moved since the "
                            "calibration: "
                          : "the gains are probably other ones: ") +
              std::to_string(summary.unexplained) + " of " +
              std::to_string(summary.frames - summary.unsolved()) +
              " solved frames of " + source +
              " are not explained by the finger and its noise",
          finger.calibration
              ? "zero the gauges with finray_zero; then look for more contacts "
                "than the scene has, a changed finger, a wrong noise_V"
              : "calibrate it with finray_calibrate"};
}

void EmitSummary(const EstimationSummary& summary, YamlEmitter* yaml) {
  YamlPair(yaml, "frames", summary.frames);
  *yaml << YAML::Key << "status" << YAML::Value << YAML::BeginMap;
  for (const FrameStatus status : EstimationSummary::kStatuses) {
    YamlPair(yaml, StatusName(status), summary.count(status));
  }
  *yaml << YAML::EndMap;
  YamlPair(yaml, "unexplained_frames", summary.unexplained);
  if (summary.force_compared > 0) {
    YamlPairs(yaml, "force_compared_frames", summary.force_compared,
              "force_rms_error_N", summary.force_rms_N(), "force_max_error_N",
              summary.force_max_N, "force_squares_N2",
              summary.force_squares_N2);
  }
}

}  // namespace finray
