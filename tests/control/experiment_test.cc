#include "finray/control/experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "finray/io/error.h"
#include "temp_file.h"
#include "test_finger.h"

namespace finray {
namespace {

using testing::HasSubstr;

constexpr char kGoodYaml[] =
    R"(schema_version: 1
name: test
scene: {object: {shape: circle, radius_mm: 15}}
object_start: {y_mm: 80}
actuation: {rate_Hz: 25, delay_ms: 130, speed_limit_mm_s: 50}
set_point: {type: constant, value_N: 6}
controllers:
  - {type: model, preview: true, object_acceleration_mm_s2: 7}
  - {type: pi}
run: {duration_s: 10}
)";

class ExperimentYamlTest : public testing::Test {
 protected:
  Experiment Read(const std::string& text) {
    return ReadExperiment(folder_.Write("e.yaml", text), PaperFinger());
  }

  // Expects this message if `to` replaces `from`.
  void ExpectError(const std::string& from, const std::string& to,
                   const std::string& message) {
    std::string text = kGoodYaml;
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    try {
      Read(text);
      FAIL() << to;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(message)) << to;
      EXPECT_THAT(error.what(), HasSubstr("e.yaml:")) << to;
    }
  }

  TempFolder folder_;
};

TEST_F(ExperimentYamlTest, Reads) {
  const Experiment experiment = Read(kGoodYaml);
  EXPECT_EQ(experiment.name, "test");
  EXPECT_DOUBLE_EQ(experiment.actuation.period_s, 0.04);
  EXPECT_DOUBLE_EQ(experiment.actuation.delay_s, 0.13);
  EXPECT_DOUBLE_EQ(experiment.true_delay_s, 0.13);
  EXPECT_EQ(experiment.scene.most_contacts, 1);
  ASSERT_EQ(experiment.controllers.size(), 2u);
  EXPECT_TRUE(experiment.controllers[0].preview);
  EXPECT_EQ(experiment.controllers[0].prior.acceleration_mm_s2, 7);
  EXPECT_EQ(experiment.controllers[1].name, "pi");
  EXPECT_EQ(experiment.controllers[1].kind, ControllerKind::kPi);
  EXPECT_DOUBLE_EQ(experiment.set_point.At(3), 6);
}

TEST_F(ExperimentYamlTest, ReadsAGripper) {
  std::string text = kGoodYaml;
  text.replace(text.find("speed_limit_mm_s: 50"), 20, "speed_limit_deg_s: 90");
  text +=
      "gripper: {crank_pivot_mm: [0, -75], crank_joint_mm: [0, -15], "
      "rocker_pivot_mm: [40, -75], rocker_joint_mm: [40, -15]}\n";
  const Experiment experiment = Read(text);
  EXPECT_EQ(experiment.mechanism.fingers(), 2);
  EXPECT_NEAR(experiment.actuation.speed_limit, M_PI / 2, 1e-12);
}

TEST_F(ExperimentYamlTest, ExamplesAreGood) {
  for (const char* name :
       {"fixed_harmonic", "fixed_step", "moving_harmonic", "moving_triangular",
        "two_finger", "two_finger_ramped", "sensing_cycles", "gauge_loss",
        "spring_step"}) {
    const Experiment experiment = ReadExperiment(
        std::string(FINRAY_SOURCE_DIR) + "/configs/control/" + name + ".yaml",
        PaperFinger());
    EXPECT_EQ(experiment.name, name);
  }
}

TEST_F(ExperimentYamlTest, NamesWhatIsWrong) {
  ExpectError("delay_ms", "dely_ms", "did you mean 'delay_ms'?");
  ExpectError("duration_s", "duraton_s", "did you mean 'duration_s'?");
  ExpectError("object_acceleration_mm_s2", "object_aceleration_mm_s2",
              "did you mean 'object_acceleration_mm_s2'?");
  ExpectError("type: pi", "type: pid", "'pi'");
  ExpectError("y_mm: 80", "y_mm: 200", "a height between");
  ExpectError("value_N: 6", "value_N: -1", "forces above 0");
  ExpectError("{object: {shape: circle, radius_mm: 15}}", "{contacts: auto}",
              "a control loop needs an object");
  ExpectError("{object:", "{contacts: 2, object:", "contacts: auto");
  ExpectError("- {type: pi}", "- {type: model}",
              "two controllers are called 'model'");
  ExpectError("type: pi}", "type: pi, name: a/b}", "letters, digits");
  ExpectError("duration_s: 10", "duration_s: 3", "less than duration_s");
  ExpectError("rate_Hz: 25", "rate_Hz: 0", "rate_Hz");
  ExpectError("type: constant, value_N: 6",
              "type: steps, levels_N: [3, 4], hold_s: 1, ramp_s: 2",
              "expected hold_s at most");
  ExpectError("run:", "gauge_loss: {from_s: 1, to_s: 2, gauges: [5]}\nrun:",
              "numbers from 1 to 4");
  ExpectError("schema_version: 1", "schema_version: 2", "expected 1");
}

TEST_F(ExperimentYamlTest, RefusesGrippersThatCannotBe) {
  const std::string gripper =
      "gripper: {crank_pivot_mm: [0, 0], crank_joint_mm: [40, 0], "
      "rocker_pivot_mm: [0, 30], rocker_joint_mm: [40, 30]}\nrun:";
  ExpectError("run:", gripper, "does not move the finger");
  const std::string good =
      "gripper: {crank_pivot_mm: [0, -75], crank_joint_mm: [0, -15], "
      "rocker_pivot_mm: [40, -75], rocker_joint_mm: [40, -15]}\n";
  ExpectError("run:", good + "run:", "speed_limit_deg_s");
  ExpectError("run:",
              good +
                  "object_motion: {type: harmonic, amplitude_mm: 1, "
                  "period_s: 2}\nrun:",
              "shifts freely");
}

}  // namespace
}  // namespace finray
