#include "command_line.h"
#include "finray/io/frame_table.h"

namespace finray {
namespace {

using testing::HasSubstr;

class PlanTest : public CommandLineTest {
 protected:
  PlanTest() {
    folder_.Write(
        "lab.yaml",
        "schema_version: 1\n"
        "scene: {contacts: auto, object: {shape: circle, radius_mm: 15}}\n"
        "parameters:\n"
        "  front_stiffness: {prior_std_percent: 15}\n"
        "  back_stiffness:  {prior_std_percent: 15}\n"
        "  gauge_gain:      {prior_std_percent: 200}\n"
        "  gauge_offset:    {prior_std_V: 0.5}\n"
        "  rib_length:      {prior_std_mm: 0.3}\n"
        "measurements: {force_std_N: 0.02, object_std_mm: 0.05}\n");
  }
  const std::string stage_ =
      " --plan %lab.yaml --x_mm -30:15 --y_mm 0:150 --force_max_N 8 "
      "--force_N 3 --target_contact_mm 2 --target_force_N 0.3 --most_frames "
      "60 ";
};

TEST_F(PlanTest, WritesARecording) {
  const Outcome outcome =
      Run("finray_plan", "--finger " + paper_ + stage_ +
                             "--confidence_percent 70 --out_dir %d");
  EXPECT_THAT(outcome.output, HasSubstr("target         2 mm and 0.3 N rms"));
  const FrameTable rows = FrameTable::Read(folder_.Path("d/recording.csv"));
  EXPECT_GE(rows.rows(), 20u);
  EXPECT_TRUE(rows.Has("object_x_mm"));
  EXPECT_TRUE(rows.Has("gauge_4_V"));
  EXPECT_THAT(folder_.Read("d/recording.html"), HasSubstr("class=\"free\""));
  // The simulation reads the file as it is.
  EXPECT_EQ(Run("finray_simulate", "--finger " + paper_ +
                                       " --frames %d/recording.csv --out "
                                       "%out.csv --scene " FINRAY_SOURCE_DIR
                                       "/configs/scenes/pulley.yaml")
                .code,
            0);
}

TEST_F(PlanTest, GoesOnFromALog) {
  const Outcome outcome =
      Run("finray_plan", "--finger " + paper_ + stage_ + "--from " + data_ +
                             "train.csv --out_dir %d");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("no further row is needed"));
}

TEST_F(PlanTest, WrongUse) {
  const std::string most =
      "--finger " + paper_ + " --plan %lab.yaml --y_mm 0:150 --force_max_N 8 ";
  EXPECT_EQ(Run("finray_plan", most + "--x_mm -30 --out_dir %out").code, 1);
  const Outcome no_target =
      Run("finray_plan", most + "--x_mm -30:5 --out_dir %out");
  EXPECT_EQ(no_target.code, 1);
  EXPECT_THAT(no_target.output, HasSubstr("--target_contact_mm"));
  ExpectBadInput("finray_plan",
                 most + "--x_mm -3:5 --target_force_N 1 --out_dir %out",
                 "the stage cannot leave the finger");
  folder_.Write("square.yaml",
                "schema_version: 1\nparameters: {front_stiffness: "
                "{prior_std_percent: 10}}\n");
  ExpectBadInput("finray_plan",
                 "--finger " + paper_ +
                     " --plan %square.yaml --x_mm -30:5 --y_mm 0:150 "
                     "--force_max_N 8 --target_force_N 1 --out_dir %out",
                 "shape: circle");
}

}  // namespace
}  // namespace finray
