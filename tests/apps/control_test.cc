// finray_control on the command line.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "apps/command_line.h"
#include "finray/io/frame_table.h"

namespace finray {
namespace {

using testing::HasSubstr;

constexpr char kExperiment[] =
    R"(schema_version: 1
name: short
paper: {figure: 25, rms_N: 0.25, max_N: 0.45}
scene: {object: {shape: circle, radius_mm: 15}}
object_start: {y_mm: 80, gap_mm: 1}
object_motion: {type: harmonic, amplitude_mm: 1, period_s: 4}
actuation: {rate_Hz: 30, delay_ms: 130, time_constant_ms: 30, speed_limit_mm_s: 50}
set_point: {type: constant, value_N: 5}
controllers:
  - {type: model}
  - {type: pi}
model_error: {stiffness_std_percent: 1}
run: {duration_s: 5, measure_from_s: 3, draws: 2}
)";

class ControlAppTest : public CommandLineTest {
 protected:
  std::string Arguments(const std::string& more) {
    return "--finger " + paper_ + " --experiment %e.yaml --out_dir %out " +
           more;
  }
};

TEST_F(ControlAppTest, WritesLogsAndSummary) {
  folder_.Write("e.yaml", kExperiment);
  const Outcome outcome = Run("finray_control", Arguments("--strict"));
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_EQ(outcome.output.substr(0, outcome.output.find('\n')),
            folder_.Path("") + "out/summary.yaml");
  const YAML::Node summary = YAML::LoadFile(folder_.Path("out/summary.yaml"));
  const YAML::Node experiment = summary["experiments"][0];
  EXPECT_EQ(experiment["paper"]["rms_N"].as<double>(), 0.25);
  EXPECT_TRUE(experiment["simulated"].as<bool>());
  const YAML::Node model = experiment["controllers"][0];
  EXPECT_EQ(model["runs"].as<int>(), 2);
  EXPECT_LT(model["control_error"]["rms_N"].as<double>(), 0.25);
  EXPECT_TRUE(model["beats_paper_rms"].as<bool>());
  FrameTable log = FrameTable::Read(folder_.Path("out/short.model.csv"));
  EXPECT_EQ(log.rows(), 151u);
  EXPECT_EQ(log.MutableText("mode").back(), "control");
  EXPECT_TRUE(std::filesystem::exists(folder_.Path("out/short.pi.csv")));
}

// A log is a frame table: finray_estimate reads it and finds the same forces.
TEST_F(ControlAppTest, LogsCanBeEstimatedAgain) {
  folder_.Write("e.yaml", kExperiment);
  ASSERT_EQ(Run("finray_control", Arguments("--draws 1")).code, 0);
  folder_.Write("scene.yaml", "contacts: 1\n");
  const Outcome outcome =
      Run("finray_estimate", "--finger " + paper_ +
                                 " --scene %scene.yaml --logs "
                                 "%out/short.model.csv --out_dir %again");
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  const FrameTable log = FrameTable::Read(folder_.Path("out/short.model.csv"));
  const FrameTable again =
      FrameTable::Read(folder_.Path("again/short.model.frames.csv"));
  EXPECT_NEAR(again.Numbers("normal_1_N").back(),
              log.Numbers("normal_1_N").back(), 1e-3);
}

TEST_F(ControlAppTest, ResultsDoNotDependOnThreads) {
  folder_.Write("e.yaml", kExperiment);
  ASSERT_EQ(Run("finray_control", Arguments("")).code, 0);
  const std::string one = folder_.Read("out/summary.yaml");
  ASSERT_EQ(Run("finray_control", Arguments("--threads 2")).code, 0);
  EXPECT_EQ(folder_.Read("out/summary.yaml"), one);
}

// Lost gauges stop the loop, which --strict reports.
TEST_F(ControlAppTest, AStoppedRunFailsTheGate) {
  folder_.Write("e.yaml",
                std::string(kExperiment) +
                    "gauge_loss: {from_s: 2, to_s: 9, gauges: [1, 2, 3]}\n");
  EXPECT_EQ(Run("finray_control", Arguments("--draws 1")).code, 0);
  EXPECT_EQ(Run("finray_control", Arguments("--draws 1 --strict")).code, 4);
}

TEST_F(ControlAppTest, BadInput) {
  folder_.Write("e.yaml", kExperiment);
  const Outcome draws = Run("finray_control", Arguments("--draws 1000000"));
  EXPECT_EQ(draws.code, 2);
  EXPECT_THAT(draws.output, HasSubstr("--draws: expected 0 to 10000"));
  folder_.Write("e.yaml", std::string(kExperiment) + "safty: {}\n");
  ExpectBadInput("finray_control", Arguments(""), "did you mean 'safety'?");
  folder_.Write("e.yaml", kExperiment);
  EXPECT_EQ(Run("finray_control", "--finger " + paper_).code, 1);
  ExpectBadInput(
      "finray_control",
      "--finger " + paper_ + " --experiment %e.yaml,%e.yaml --out_dir %out",
      "another experiment is called 'short'");
  const Outcome config = Run("finray_control", Arguments("--dump_config"));
  EXPECT_EQ(config.code, 0);
  EXPECT_THAT(config.output, HasSubstr("delay_ms: 130"));
  EXPECT_FALSE(std::filesystem::exists(folder_.Path("out")));
}

}  // namespace
}  // namespace finray
