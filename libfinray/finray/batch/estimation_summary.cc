#include "finray/batch/estimation_summary.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "finray/io/number_text.h"
#include "finray/io/yaml_emitter.h"

namespace finray {

namespace {

bool TooMany(std::size_t some, std::size_t of) {
  return some >= EstimationSummary::kFewestUnexplained &&
         static_cast<double>(some) >
             EstimationSummary::kMostUnexplained * static_cast<double>(of);
}

// The std of the total force is at most the sum of those of its parts.
double ForceStd(const FrameEstimate& estimate, double friction) {
  double std_N = 0;
  for (int c = 0; c < estimate.contacts; ++c) {
    std_N += std::hypot(1, friction) * estimate.contact[c].normal_std_N;
  }
  return std_N;
}

}  // namespace

std::size_t EstimationSummary::unsolved() const {
  return count(FrameStatus::kNotConverged) + count(FrameStatus::kBadInput);
}

bool EstimationSummary::unexplained_too_many() const {
  return TooMany(unexplained, frames - unsolved());
}

bool EstimationSummary::forces_differ() const {
  return TooMany(force_far, force_judged);
}

bool EstimationSummary::never_free() const {
  return frames - unsolved() >= kManyFrames &&
         count(FrameStatus::kNoContact) == 0 &&
         force_judged < kFewestUnexplained;
}

double EstimationSummary::force_rms_N() const {
  if (force_compared == 0) return 0;
  return std::sqrt(force_squares_N2 / static_cast<double>(force_compared));
}

double EstimationSummary::force_std_N() const {
  if (force_judged == 0) return 0;
  return std::sqrt(force_variances_N2 / static_cast<double>(force_judged));
}

void EstimationSummary::Add(const FrameEstimate& estimate, double friction,
                            const Measurements& readings) {
  const double force_N = readings.force_N;
  if (std::abs(force_N) <= kFreeForce_N &&
      std::all_of(readings.gauges_V.begin(), readings.gauges_V.end(),
                  [](double volts) { return std::isfinite(volts); })) {
    ++free_rows;
    free_sums_V.resize(readings.gauges_V.size());
    for (std::size_t j = 0; j < free_sums_V.size(); ++j) {
      free_sums_V[j] += readings.gauges_V[j];
    }
  }
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
  if (estimate.status != FrameStatus::kOk) return;
  const double std_N = ForceStd(estimate, friction);
  if (!std::isfinite(std_N)) return;
  ++force_judged;
  force_variances_N2 += std_N * std_N;
  force_far += std::abs(error) > kFarStd * std_N &&
               std::abs(error) > kFarShare * std::abs(force_N) &&
               std::abs(error) > kFreeForce_N;
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
  force_judged += other.force_judged;
  force_far += other.force_far;
  force_variances_N2 += other.force_variances_N2;
  free_rows += other.free_rows;
  free_sums_V.resize(std::max(free_sums_V.size(), other.free_sums_V.size()));
  for (std::size_t j = 0; j < other.free_sums_V.size(); ++j) {
    free_sums_V[j] += other.free_sums_V[j];
  }
}

std::string SummaryToText(const EstimationSummary& summary) {
  std::string text = std::to_string(summary.frames);
  for (const std::size_t count : summary.by_status) {
    text += " " + std::to_string(count);
  }
  text += " " + std::to_string(summary.unexplained) + " " +
          std::to_string(summary.force_compared) + " " +
          NumberText(summary.force_squares_N2) + " " +
          NumberText(summary.force_max_N) + " " +
          std::to_string(summary.force_judged) + " " +
          std::to_string(summary.force_far) + " " +
          NumberText(summary.force_variances_N2) + " " +
          std::to_string(summary.free_rows) + " " +
          std::to_string(summary.free_sums_V.size());
  for (const double sum : summary.free_sums_V) text += " " + NumberText(sum);
  return text;
}

std::optional<EstimationSummary> SummaryFromText(const std::string& text) {
  std::istringstream stream(text);
  EstimationSummary summary;
  const auto number = [&](double* value) {
    std::string word;
    stream >> word;
    const std::optional<double> read = ParseNumber(word);
    if (read) *value = *read;
    if (!read) stream.setstate(std::ios::failbit);
  };
  stream >> summary.frames;
  for (std::size_t& count : summary.by_status) stream >> count;
  stream >> summary.unexplained >> summary.force_compared;
  number(&summary.force_squares_N2);
  number(&summary.force_max_N);
  stream >> summary.force_judged >> summary.force_far;
  number(&summary.force_variances_N2);
  std::size_t gauges = 0;
  stream >> summary.free_rows >> gauges;
  for (std::size_t j = 0; stream && j < gauges; ++j) {
    number(&summary.free_sums_V.emplace_back());
  }
  std::string rest;
  if (!stream || stream >> rest) return std::nullopt;
  return summary;
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
              summary.force_max_N, "force_squares_N2", summary.force_squares_N2,
              "force_judged_frames", summary.force_judged, "force_far_frames",
              summary.force_far, "force_variances_N2",
              summary.force_variances_N2);
  }
}

void EmitFreeRows(const EstimationSummary& summary, YamlEmitter* yaml) {
  if (summary.free_rows == 0) return;
  YamlPair(yaml, "free_rows", summary.free_rows);
  *yaml << YAML::Key << "free_sums_V" << YAML::Value << YAML::Flow
        << summary.free_sums_V;
}

}  // namespace finray
