#include "finray/benchmark/peers.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "finray/benchmark/json_emitter.h"
#include "finray/benchmark/statistics.h"
#include "finray/finger/geometry.h"
#include "finray/io/atomic_file.h"
#include "finray/io/error.h"
#include "finray/io/message_text.h"
#include "finray/io/python_script.h"
#include "finray/io/yaml_map.h"

namespace finray {
namespace {

const std::vector<std::string> kPeers = {"scipy", "octave", "calculix",
                                         "getfem", "mujoco"};
const char* const kScenes[] = {"one_contact", "friction"};

// Returns the frames of a scene that peers are asked for: the first of some
// stretches.
std::vector<int> PeerFrames(const BenchmarkCase& c, bool quick) {
  const int stretches = std::min(c.stretches(), quick ? 2 : 6);
  std::vector<int> frames;
  for (int k = 0; k < stretches; ++k) {
    frames.push_back(c.LeadIn(k, stretches) + 1);
  }
  return frames;
}

void WriteFinger(const Finger& finger, JsonEmitter* json) {
  *json << YAML::Key << "finger" << YAML::Value << YAML::BeginMap;
  json->Pairs("front_length_mm", finger.front_length_mm, "back_angle_rad",
              finger.back_angle_rad, "front_stiffness_N_mm2",
              finger.front_stiffness_N_mm2, "back_stiffness_N_mm2",
              finger.back_stiffness_N_mm2);
  json->Maps("ribs", finger.ribs, [&](const Rib& rib) {
    json->Pairs("front_mm", rib.front_mm, "back_mm", rib.back_mm, "length_mm",
                rib.length_mm);
  });
  json->Maps("gauges", finger.gauges, [&](const Gauge& gauge) {
    json->Pairs("beam", SideName(gauge.beam), "start_mm", gauge.start_mm,
                "length_mm", gauge.length_mm);
  });
  *json << YAML::EndMap;
}

// Reads one setting of the answer file.
Measurement ReadPeerSetting(const YamlMap& map, const std::string& peer,
                            const std::vector<BenchmarkCase>& cases, bool quick,
                            double yardstick_us) {
  Measurement m;
  m.name = {map.Choice("task", {"forward", "sensing"}),
            map.Choice("scene", {kScenes[0], kScenes[1]}), map.Text("solver"),
            "peer"};
  m.words = map.Text("words");
  m.family = peer;
  m.links = map.Integer("links");
  m.unknowns = map.Integer("unknowns");
  const BenchmarkCase& c = CaseOf(cases, m.name.scene);
  const bool forward = m.name.task == "forward";
  const auto& truth = forward ? c.forward : c.sensed;
  const std::vector<int> frames = PeerFrames(c, quick);
  const std::vector<YamlMap> answers = map.Maps("answers");
  if (answers.size() != frames.size()) {
    map.Fail("answers", "answers: expected " + std::to_string(frames.size()));
  }
  int solved = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (!answers[k].Boolean("solved", false)) continue;
    FrameAnswer answer;
    answer.solved = true;
    answer.contacts = {
        {answers[k].Number("contact_mm"), answers[k].Number("normal_N"), 0}};
    const std::vector<double> gauges = answers[k].Numbers("gauges_rad");
    answer.gauges_rad = Eigen::Map<const Eigen::VectorXd>(
        gauges.data(), static_cast<Eigen::Index>(gauges.size()));
    answer.tip_pose << answers[k].Number("tip_x_mm"),
        answers[k].Number("tip_y_mm"), 0;
    if (answer.gauges_rad.size() == truth[frames[k]].gauges_rad.size() &&
        m.errors.Add(answer, truth[frames[k]], forward)) {
      ++solved;
      m.iterations += answers[k].Number("iterations");
    }
  }
  m.frames = static_cast<int>(frames.size());
  m.iterations /= std::max(solved, 1);
  m.solved_percent = 100. * solved / m.frames;
  m.time_us = map.Numbers("time_us");
  m.yardstick_us.assign(m.time_us.size(), yardstick_us);
  return m;
}

}  // namespace

std::vector<std::string> ParsePeers(const std::string& words) {
  if (words == "none" || words.empty()) return {};
  if (words == "auto") return kPeers;
  std::vector<std::string> peers;
  std::istringstream stream(words);
  for (std::string peer; std::getline(stream, peer, ',');) {
    if (std::find(kPeers.begin(), kPeers.end(), peer) == kPeers.end()) {
      throw InputError(
          "--peers: unknown peer '" + peer + "'" + DidYouMean(peer, kPeers) +
          "; known: none auto scipy octave calculix getfem mujoco");
    }
    peers.push_back(peer);
  }
  return peers;
}

std::string PeerJob(const Finger& finger,
                    const std::vector<BenchmarkCase>& cases, bool quick) {
  JsonEmitter json;
  json << YAML::BeginMap;
  json.Pairs("quick", quick);
  WriteFinger(finger, &json);
  json.Maps("scenes", kScenes, [&](const char* scene) {
    const BenchmarkCase& c = CaseOf(cases, scene);
    EquilibriumSolver solver(c.finger, ReferenceDiscretization(c.finger));
    json.Pairs("scene", scene);
    json.Maps("frames", PeerFrames(c, quick), [&](int frame) {
      const PointContact& load = c.frames[frame].contacts[0];
      const PointContact& before = c.frames[frame - 1].contacts[0];
      solver.Solve({load});
      const Eigen::VectorXd& measured = c.frames[frame].measurement.values;
      // Sensing starts from the frame before, as on a log. Programs without
      // follower loads need the direction of the force.
      json.Pairs("contact_mm", load.arc_mm, "normal_N", load.normal_N,
                 "friction", load.friction, "start_mm", before.arc_mm,
                 "start_N", before.normal_N, "measured_rad",
                 std::vector<double>(measured.begin(), measured.end()),
                 "contact_angle_rad", solver.contact_pose(0)[2]);
    });
  });
  json << YAML::EndMap;
  return json.c_str();
}

void MeasurePeer(const std::string& peer, const std::string& folder,
                 const Finger& finger, const std::vector<BenchmarkCase>& cases,
                 BenchmarkRun* run) {
  PeerStatus status{peer, "", ""};
  const std::string work = folder + "/peer_" + peer;
  MakeFolder(work);
  WriteFileAtomically(work + "/job.json", PeerJob(finger, cases, run->quick));
  const double before = YardstickUs();
  status.skipped = RunPythonScript("scripts/peers/run.py", {peer, work},
                                   "python3-numpy and python3-scipy");
  const double yardstick_us = (before + YardstickUs()) / 2;
  if (status.skipped.empty()) {
    const YamlMap answer = YamlMap::FromFile(work + "/answer.json");
    status.version = answer.Text("version");
    status.skipped = answer.Text("skipped", "");
    for (const YamlMap& map : answer.Maps("settings")) {
      run->settings.push_back(
          ReadPeerSetting(map, peer, cases, run->quick, yardstick_us));
    }
  }
  std::filesystem::remove_all(work);
  run->peers.push_back(status);
}

}  // namespace finray
