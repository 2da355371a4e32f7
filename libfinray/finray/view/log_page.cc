#include "finray/view/log_page.h"

#include <algorithm>
#include <cmath>

#include "finray/io/versions.h"
#include "finray/view/estimate_solver.h"
#include "finray/view/finger_picture.h"
#include "finray/view/json_text.h"

namespace finray {
namespace {

// Returns the channels of a log, packed.
std::string PackedLog(const LogChannels& log, std::size_t frames_per_bin) {
  JsonArray channels;
  for (const Channel& channel : log.channels) {
    channels.Add(ChannelJson(channel, frames_per_bin));
  }
  std::vector<std::uint16_t> status;
  for (std::size_t i = 0; i < log.frames; ++i) {
    if (i % frames_per_bin == 0) status.push_back(0);
    status.back() |= log.status[i];
  }
  return JsonObject()
      .Add("frames_per_bin", std::to_string(frames_per_bin))
      .Add("time", TimeJson(log.time_s, frames_per_bin))
      .Add("status", '"' + PackCodes(status, 8) + '"')
      .Add("channels", channels.str())
      .str();
}

std::string FittingLog(const LogChannels& log, std::size_t most_bytes) {
  std::string packed = PackedLog(log, 1);
  // A bin has two values, so bins of two frames save nothing.
  for (std::size_t bin = 4; packed.size() > most_bytes && bin < 4 * log.frames;
       bin *= 2) {
    packed = PackedLog(log, bin);
  }
  return packed;
}

// Shapes of frames with two contacts.
std::string PairsJson(const LogChannels& log, const Finger& finger,
                      const Discretization& discretization,
                      const PictureNodes& nodes) {
  const std::size_t count = std::min(log.pairs.size(), kMostPairs);
  EstimateSolver solver(finger, discretization);
  const std::vector<double> undeformed = nodes.Undeformed();
  std::vector<std::vector<double>> moves;
  std::vector<double> frames;
  for (std::size_t k = 0; k < count; ++k) {
    const LogChannels::Pair& pair = log.pairs[k * log.pairs.size() / count];
    if (!solver.Solve(pair.contacts)) continue;
    std::vector<double> places = nodes.Places(solver.solver(), pair.contacts);
    for (std::size_t i = 0; i < places.size(); ++i) places[i] -= undeformed[i];
    moves.push_back(std::move(places));
    frames.push_back(static_cast<double>(pair.frame));
  }
  return JsonObject()
      .Add("frames", JsonNumbers(frames))
      .Add("moves", MovesJson(moves))
      .str();
}

}  // namespace

std::string WarningsJson(const std::vector<Warning>& warnings) {
  JsonArray array;
  for (const Warning& warning : warnings) {
    array.Add(JsonObject()
                  .Add("code", JsonText(warning.code))
                  .Add("text", JsonText(warning.text))
                  .Add("remedy", JsonText(warning.remedy))
                  .str());
  }
  return array.str();
}

std::string LogPageJson(const std::vector<PageLog>& logs, const Finger* finger,
                        const Discretization& discretization,
                        std::size_t most_bytes) {
  JsonObject json;
  json.Add("version", JsonText(FINRAY_VERSION));
  std::size_t bytes = 0;
  std::vector<std::string> pairs(logs.size(), "null");
  if (finger != nullptr) {
    const PictureNodes nodes(*finger);
    double most_N = 0;
    double least = logs[0].log->least_friction;
    double most = logs[0].log->most_friction;
    for (std::size_t i = 0; i < logs.size(); ++i) {
      most_N = std::max(most_N, logs[i].log->most_force_N);
      least = std::min(least, logs[i].log->least_friction);
      most = std::max(most, logs[i].log->most_friction);
      pairs[i] = PairsJson(*logs[i].log, *finger, discretization, nodes);
      bytes += pairs[i].size();
    }
    // Without any contact the table has the free finger only.
    const std::string table = ShapeTableJson(MakeShapeTable(
        *finger, discretization, nodes, least, most, std::max(most_N, 1e-3)));
    json.Add("finger", nodes.Json()).Add("table", table);
    bytes += table.size();
  }
  JsonArray array;
  const std::size_t left = most_bytes > bytes ? most_bytes - bytes : 1;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const LogChannels& log = *logs[i].log;
    array.Add(JsonObject()
                  .Add("name", JsonText(log.name))
                  .Add("frames", std::to_string(log.frames))
                  .Add("has_time", log.has_time ? "true" : "false")
                  .Add("warnings", WarningsJson(logs[i].warnings))
                  .Add("packed", FittingLog(log, left / logs.size()))
                  .Add("pairs", pairs[i])
                  .str());
  }
  return json.Add("logs", array.str()).str();
}

}  // namespace finray
