#include "finray/batch/estimation_summary.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "finray/estimation/frame_estimator.h"
#include "finray/finger/possible_reading.h"
#include "finray/io/number_text.h"

namespace finray {

namespace {

bool TooMany(std::size_t some, std::size_t of,
             double most = EstimationSummary::kMostUnexplained) {
  return some >= EstimationSummary::kFewestUnexplained &&
         static_cast<double>(some) > most * static_cast<double>(of);
}

// Adds to each sum, which grows with the first row.
void AddAll(const std::vector<double>& more, std::vector<double>* sums) {
  sums->resize(std::max(sums->size(), more.size()));
  for (std::size_t j = 0; j < more.size(); ++j) (*sums)[j] += more[j];
}

}  // namespace

std::size_t EstimationSummary::unsolved() const {
  return count(FrameStatus::kNotConverged) + count(FrameStatus::kBadInput);
}

bool EstimationSummary::unexplained_too_many() const {
  return TooMany(unexplained, frames - unsolved());
}

bool EstimationSummary::unexplained_some() const {
  return !unexplained_too_many() &&
         TooMany(unexplained, frames - unsolved(), kSomeUnexplained);
}

bool EstimationSummary::forces_differ() const {
  return TooMany(force_far, force_judged);
}

bool EstimationSummary::never_free() const {
  return frames - unsolved() >= kManyFrames &&
         count(FrameStatus::kNoContact) == 0 &&
         force_judged < kFewestUnexplained;
}

bool EstimationSummary::changes_differ() const {
  // A sum of squares that expects n has a variance of 2 n at most.
  constexpr double kSure = 5;
  return change_chi2 > kFarChange * kFarChange * change_dof &&
         change_chi2 - change_dof > kSure * std::sqrt(2 * change_dof);
}

double EstimationSummary::force_rms_N() const {
  if (force_compared == 0) return 0;
  return std::sqrt(force_squares_N2 / static_cast<double>(force_compared));
}

double EstimationSummary::force_std_N() const {
  if (force_judged == 0) return 0;
  return std::sqrt(force_variances_N2 / static_cast<double>(force_judged));
}

void EstimationSummary::Add(const FrameEstimate& estimate, double coefficient,
                            const Measurements& readings,
                            const Finger& finger) {
  const double friction = readings.FrictionOr(coefficient);
  const double force_N = readings.Force().magnitude_N;
  const bool all_read =
      std::all_of(readings.gauges_V.begin(), readings.gauges_V.end(),
                  [](double volts) { return std::isfinite(volts); });
  if (std::abs(force_N) <= kFreeForce_N && all_read &&
      estimate.status != FrameStatus::kBadInput) {
    ++free_rows;
    AddAll(readings.gauges_V, &free_sums_V);
  }
  ++frames;
  change_chi2 += estimate.change_chi2;
  change_dof += estimate.change_dof;
  search_ended += estimate.search_ended;
  ++by_status[static_cast<std::size_t>(estimate.status)];
  if (estimate.status == FrameStatus::kBadInput) {
    const int gauge = FirstImpossible(finger.gauges, readings.gauges_V);
    if (gauge >= 0 && impossible++ == 0) {
      impossible_row = frames;
      impossible_gauge = static_cast<std::size_t>(gauge) + 1;
      impossible_V =
          NumberText(readings.gauges_V[static_cast<std::size_t>(gauge)]);
    }
  }
  if (estimate.status == FrameStatus::kNotConverged ||
      estimate.status == FrameStatus::kBadInput) {
    return;
  }
  // Two contacts may explain the frames that they make unobservable.
  unexplained +=
      estimate.IsUnexplained() &&
      !(estimate.may_be_two &&
        estimate.explained_chi2() >= FrameEstimator::kUntoldSignificance);
  // The contacts of unobservable frames are unreliable, so they are not
  // compared.
  if (estimate.status == FrameStatus::kUnobservable) return;
  if (std::isnan(force_N)) return;
  const double error = EstimatedForce(estimate, friction) - force_N;
  force_squares_N2 += error * error;
  force_max_N = std::max(force_max_N, std::abs(error));
  ++force_compared;
  if (estimate.status != FrameStatus::kOk) return;
  const double std_N = EstimatedForceStd(estimate, friction);
  if (!std::isfinite(std_N)) return;
  ++force_judged;
  force_variances_N2 += std_N * std_N;
  force_far += std::abs(error) > kFarStd * std_N &&
               std::abs(error) > kFarShare * std::abs(force_N) &&
               std::abs(error) > kFreeForce_N;
}

void EstimationSummary::Add(const EstimationSummary& other) {
  if (impossible == 0 && other.impossible > 0) {
    impossible_row = frames + other.impossible_row;
    impossible_gauge = other.impossible_gauge;
    impossible_V = other.impossible_V;
  }
  impossible += other.impossible;
  frames += other.frames;
  bad_rows += other.bad_rows;
  for (std::size_t i = 0; i < by_status.size(); ++i) {
    by_status[i] += other.by_status[i];
  }
  unexplained += other.unexplained;
  search_ended += other.search_ended;
  force_compared += other.force_compared;
  force_squares_N2 += other.force_squares_N2;
  force_max_N = std::max(force_max_N, other.force_max_N);
  force_judged += other.force_judged;
  force_far += other.force_far;
  force_variances_N2 += other.force_variances_N2;
  free_rows += other.free_rows;
  AddAll(other.free_sums_V, &free_sums_V);
  walk.Add(other.walk);
  alone += other.alone;
  change_chi2 += other.change_chi2;
  change_dof += other.change_dof;
}

std::string SummaryToText(const EstimationSummary& summary) {
  std::string text =
      std::to_string(summary.frames) + " " + std::to_string(summary.bad_rows);
  for (const std::size_t count : summary.by_status) {
    text += " " + std::to_string(count);
  }
  text += " " + std::to_string(summary.unexplained) + " " +
          std::to_string(summary.search_ended) + " " +
          std::to_string(summary.force_compared) + " " +
          NumberText(summary.force_squares_N2) + " " +
          NumberText(summary.force_max_N) + " " +
          std::to_string(summary.force_judged) + " " +
          std::to_string(summary.force_far) + " " +
          NumberText(summary.force_variances_N2) + " " +
          std::to_string(summary.free_rows) + " " +
          std::to_string(summary.impossible) + " " +
          std::to_string(summary.impossible_row) + " " +
          std::to_string(summary.impossible_gauge) + " " +
          summary.impossible_V + " " + NumberText(summary.change_chi2) + " " +
          NumberText(summary.change_dof) + " " +
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
  stream >> summary.frames >> summary.bad_rows;
  for (std::size_t& count : summary.by_status) stream >> count;
  stream >> summary.unexplained >> summary.search_ended >>
      summary.force_compared;
  number(&summary.force_squares_N2);
  number(&summary.force_max_N);
  stream >> summary.force_judged >> summary.force_far;
  number(&summary.force_variances_N2);
  stream >> summary.free_rows >> summary.impossible >> summary.impossible_row >>
      summary.impossible_gauge >> summary.impossible_V;
  number(&summary.change_chi2);
  number(&summary.change_dof);
  std::size_t gauges = 0;
  stream >> gauges;
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
  YamlPairs(yaml, "unexplained_frames", summary.unexplained,
            "search_ended_frames", summary.search_ended);
  if (summary.bad_rows > 0) YamlPair(yaml, "bad_rows", summary.bad_rows);
  if (summary.impossible > 0) {
    YamlPair(yaml, "impossible_rows", summary.impossible);
  }
  if (summary.force_compared > 0) {
    // Readers refuse inf, which is no error of a force: its key is left out.
    const auto finite = [yaml](const char* key, double value) {
      if (value <= kLargestYamlNumber) YamlPair(yaml, key, value);
    };
    YamlPair(yaml, "force_compared_frames", summary.force_compared);
    finite("force_rms_error_N", summary.force_rms_N());
    finite("force_max_error_N", summary.force_max_N);
    finite("force_squares_N2", summary.force_squares_N2);
    YamlPairs(yaml, "force_judged_frames", summary.force_judged,
              "force_far_frames", summary.force_far);
    finite("force_variances_N2", summary.force_variances_N2);
  }
}

void EmitChanges(const EstimationSummary& summary, YamlEmitter* yaml) {
  if (summary.alone > 0) YamlPair(yaml, "alone_frames", summary.alone);
  if (summary.change_dof > 0) {
    YamlPairs(yaml, "change_chi2", summary.change_chi2, "change_dof",
              summary.change_dof);
  }
  const WalkIncrements& walk = summary.walk;
  if (!(walk.moved_s > 0)) return;
  *yaml << YAML::Key << "gauge_offset_walk" << YAML::Value << YAML::BeginMap;
  YamlPair(yaml, "told_V_per_sqrt_s", walk.told_V_per_sqrt_s);
  *yaml << YAML::Key << "chi2" << YAML::Value << YAML::Flow
        << std::vector<double>(walk.chi2.begin(), walk.chi2.end());
  *yaml << YAML::Key << "dof" << YAML::Value << YAML::Flow
        << std::vector<double>(walk.dof.begin(), walk.dof.end());
  *yaml << YAML::Key << "weights" << YAML::Value << YAML::Flow
        << std::vector<double>(walk.weights.begin(), walk.weights.end());
  *yaml << YAML::Key << "weighted" << YAML::Value << YAML::Flow
        << std::vector<double>(walk.weighted.begin(), walk.weighted.end());
  *yaml << YAML::Key << "moved_V" << YAML::Value << YAML::Flow << walk.moved_V;
  YamlPair(yaml, "moved_s", walk.moved_s);
  *yaml << YAML::EndMap;
}

void ReadChanges(const YamlMap& yaml, EstimationSummary* summary) {
  if (yaml.Has("alone_frames")) {
    summary->alone =
        static_cast<std::size_t>(yaml.NonNegativeNumber("alone_frames"));
  }
  if (yaml.Has("change_dof")) {
    summary->change_chi2 = yaml.NonNegativeNumber("change_chi2");
    summary->change_dof = yaml.NonNegativeNumber("change_dof");
  }
  if (!yaml.Has("gauge_offset_walk")) return;
  const YamlMap map = yaml.Map("gauge_offset_walk");
  WalkIncrements& walk = summary->walk;
  walk.told_V_per_sqrt_s = map.PositiveNumber("told_V_per_sqrt_s");
  const auto read = [&map](const char* key, auto* to) {
    const std::vector<double> numbers = map.Numbers(key);
    std::copy_n(numbers.begin(), std::min(numbers.size(), to->size()),
                to->begin());
  };
  read("chi2", &walk.chi2);
  read("dof", &walk.dof);
  read("weights", &walk.weights);
  read("weighted", &walk.weighted);
  walk.moved_V = map.Numbers("moved_V");
  walk.moved_s = map.PositiveNumber("moved_s");
}

void EmitRowsOfLog(const EstimationSummary& summary, YamlEmitter* yaml) {
  if (summary.impossible > 0) {
    YamlPair(yaml, "impossible_row", summary.impossible_row);
    YamlPair(yaml, "impossible_gauge", summary.impossible_gauge);
    YamlPair(yaml, "impossible_V", summary.impossible_V);
  }
  if (summary.free_rows == 0 ||
      !std::all_of(
          summary.free_sums_V.begin(), summary.free_sums_V.end(),
          [](double sum) { return std::abs(sum) <= kLargestYamlNumber; })) {
    return;
  }
  YamlPair(yaml, "free_rows", summary.free_rows);
  *yaml << YAML::Key << "free_sums_V" << YAML::Value << YAML::Flow
        << summary.free_sums_V;
}

}  // namespace finray
