// finray_estimate warns of logs that the finger does not explain. Gates then
// end it with exit code 4.

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <fstream>
#include <random>

#include "apps/batch_fixture.h"
#include "estimation/uncertain_finger.h"
#include "finray/io/frame_table.h"
#include "test_finger.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::Not;

class BatchWarningsTest : public BatchTest {};

// One log whose offsets have moved is 4 % of all frames and loud all the same.
TEST_F(BatchWarningsTest, OneLogWithMovedOffsetsIsLoudAndStrictCountsIt) {
  Finger finger = ReadFinger(paper_);
  for (auto& gauge : finger.gauges) gauge.noise_V = 3e-4;
  finger.calibration = TypicalCovariance(finger);
  finger.calibration->correlations.diagonal().setOnes();
  folder_.Write("finger.yaml", FingerToYaml(finger, ""));
  const auto write = [&](const std::string& name, int frames, double moved_V) {
    std::mt19937 random(5);
    std::normal_distribution<> noise(moved_V, 3e-4);
    std::ofstream log(folder_.Path(name));
    log << "gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V\n";
    for (int i = 0; i < frames; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        log << finger.gauges[j].offset_V + noise(random)
            << (j < 3 ? "," : "\n");
      }
    }
  };
  write("runs/a.csv", 2000, 0);
  const std::string arguments =
      "--finger %finger.yaml --scene %scene.yaml --logs '%runs/*.csv' "
      "--out_dir %out --threads 2 --strict";
  const Outcome good = Run("finray_estimate", arguments);
  EXPECT_EQ(good.code, 0) << good.output;
  EXPECT_THAT(good.output, Not(HasSubstr("warning")));
  EXPECT_THAT(good.output, HasSubstr("force error    not known: no ok or "
                                     "no_contact frame with a force_N\n"));
  write("runs/b.csv", 80, 0.015);
  const Outcome moved = Run("finray_estimate", arguments);
  EXPECT_EQ(moved.code, 4) << moved.output;
  EXPECT_THAT(
      moved.output,
      HasSubstr("\nwarning: likeliest cause: the gauges' offsets have moved; "
                "80 of 80 solved frames of " +
                folder_.Path("runs/b.csv") + " are not explained"));
}

// Gauges that have all moved by as much agree on contacts that are not there:
// chi2 shows nothing, the force sensor does.
TEST_F(BatchWarningsTest, TheShareOfUnexplainedFramesIsAGate) {
  const std::string data = FINRAY_SOURCE_DIR "/datasets/simulated_r15/";
  FrameTable log = FrameTable::Read(data + "holdout.csv");
  log.Write(folder_.Path("good.csv"));
  for (double& volts : log.MutableNumbers("gauge_2_V")) volts += 0.1;
  log.Write(folder_.Path("slipped.csv"));
  const auto run = [&](const std::string& name) {
    return Run("finray_estimate",
               "--finger " + data + "hidden_finger.yaml --logs %" + name +
                   ".csv --out_dir %" + name + " --most_unexplained_percent 2");
  };
  const Outcome good = run("good"), slipped = run("slipped");
  EXPECT_EQ(good.code, 0) << good.output;
  EXPECT_EQ(slipped.code, 4) << slipped.output;
  EXPECT_THAT(slipped.output, HasSubstr("gates          most_unexplained_"
                                        "percent 2 ("));
}

TEST_F(BatchWarningsTest, EqualShiftsOfAllGaugesAreLoud) {
  const std::string data = FINRAY_SOURCE_DIR "/datasets/simulated_r15/";
  Finger finger = ReadFinger(data + "hidden_finger.yaml");
  finger.calibration = TypicalCovariance(finger);
  finger.calibration->correlations.diagonal().setOnes();
  finger.calibration->std *= 0.1;  // a good calibration
  folder_.Write("finger.yaml", FingerToYaml(finger, ""));
  const FrameTable log = FrameTable::Read(data + "holdout.csv");
  const auto run = [&](double shift_V, const std::string& out) {
    FrameTable shifted = log;
    for (const char* gauge :
         {"gauge_1_V", "gauge_2_V", "gauge_3_V", "gauge_4_V"}) {
      for (double& volts : shifted.MutableNumbers(gauge)) volts += shift_V;
    }
    shifted.Write(folder_.Path("shifted.csv"));
    return Run(
        "finray_estimate",
        "--strict --finger %finger.yaml --logs %shifted.csv --out_dir " + out);
  };
  const Outcome good = run(0, "%good");
  EXPECT_EQ(good.code, 0) << good.output;
  EXPECT_THAT(good.output, Not(HasSubstr("warning")));
  const Outcome moved = run(0.02, "%moved");
  EXPECT_EQ(moved.code, 4) << moved.output;
  EXPECT_THAT(moved.output, Not(HasSubstr("unexplained 0\n")));
  EXPECT_THAT(moved.output,
              HasSubstr("\nwarning: likeliest cause: the gauges' offsets have "
                        "moved; 45 of 110 solved frames"));
  EXPECT_THAT(moved.output, HasSubstr("the gauges read +20, +20, +20, +20 mV"));
  const YAML::Node log_entry =
      YAML::LoadFile(folder_.Path("moved/summary.yaml"))["logs"][0];
  EXPECT_EQ(log_entry["warnings"][1]["code"].as<std::string>(),
            "forces_differ");
  EXPECT_EQ(log_entry["free_rows"].as<int>(), 10);
  const FrameTable table = FrameTable::Read(folder_.Path("moved/summary.csv"));
  EXPECT_EQ(FrameTable(table).MutableText("warnings")[0],
            "unexplained_frames forces_differ");
  // A finished log that is kept tells the same.
  EXPECT_EQ(Run("finray_estimate",
                "--strict --finger %finger.yaml --logs %shifted.csv "
                "--out_dir %moved --resume")
                .code,
            4);
}

// Without a force sensor such a shift shows in two things: frames are not
// explained, and nothing is ever free.
TEST_F(BatchWarningsTest, EqualShiftsWithoutAForceFailStrict) {
  const std::string data = FINRAY_SOURCE_DIR "/datasets/simulated_r15/";
  FrameTable log = FrameTable::Read(data + "holdout.csv");
  for (double& force_N : log.MutableNumbers("force_N")) force_N = std::nan("");
  const auto run = [&](const std::string& out) {
    return Run("finray_estimate",
               "--strict --finger " + data +
                   "hidden_finger.yaml --logs %log.csv --out_dir " + out);
  };
  log.Write(folder_.Path("log.csv"));
  EXPECT_EQ(run("%good").code, 0);
  for (const char* gauge :
       {"gauge_1_V", "gauge_2_V", "gauge_3_V", "gauge_4_V"}) {
    for (double& volts : log.MutableNumbers(gauge)) volts += 0.02;
  }
  log.Write(folder_.Path("log.csv"));
  const Outcome moved = run("%moved");
  EXPECT_EQ(moved.code, 4) << moved.output;
  EXPECT_THAT(moved.output, HasSubstr("zero them with finray_zero"));
}

TEST_F(BatchWarningsTest, TheSummaryCountsEndedSearchesAndNamesHiddenForces) {
  const std::string data = FINRAY_SOURCE_DIR "/datasets/simulated_r15/";
  folder_.Write("limit.yaml", "contacts: 2\nsearch_iteration_limit: 30\n");
  const std::string arguments =
      "--finger " + data + "hidden_finger.yaml --logs " + data + "holdout.csv ";
  const Outcome limited =
      Run("finray_estimate", arguments + "--scene %limit.yaml --out_dir %out");
  ASSERT_EQ(limited.code, 0) << limited.output;
  FrameTable frames = FrameTable::Read(folder_.Path("out/holdout.frames.csv"));
  double ended = 0;
  for (const double one : frames.Numbers("search_ended")) ended += one;
  EXPECT_GT(ended, 0);
  const YAML::Node yaml = YAML::LoadFile(folder_.Path("out/summary.yaml"));
  EXPECT_EQ(yaml["all"]["search_ended_frames"].as<double>(), ended);
  EXPECT_EQ(yaml["logs"][0]["search_ended_frames"].as<double>(), ended);
  EXPECT_THAT(
      limited.output,
      HasSubstr("searches       " + std::to_string(static_cast<int>(ended)) +
                " ended by the scene's limit of 30\n"));
  ASSERT_EQ(Run("finray_estimate", arguments + "--out_dir %out_one").code, 0);
  const YAML::Node one_contact =
      YAML::LoadFile(folder_.Path("out_one/summary.yaml"));
  const YAML::Node hidden = one_contact["hidden_forces"];
  ASSERT_EQ(hidden["contact_mm"].size(), 57u);
  EXPECT_EQ(hidden["contact_mm"][28].as<double>(), 70);
  EXPECT_EQ(hidden["contact_mm"][41].as<double>(), 102.5);
  EXPECT_LT(hidden["normal_N"][28].as<double>(), 0.1);
  EXPECT_GT(hidden["normal_N"][1].as<double>(), 5);
}

}  // namespace
}  // namespace finray
