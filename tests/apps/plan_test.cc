#include "command_line.h"
#include "finray/io/frame_table.h"
#include "shared_case.h"

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

// The plan's gauge_std_V is the noise of means of some hundred readings. A
// frame is one reading, and no calibration makes it better than its noise.
TEST_F(PlanTest, AFrameHasTheNoiseOfOneReading) {
  const std::string folder = SharedCase("plateau_noise/");
  if (folder.empty()) GTEST_SKIP() << "the inputs are not here";
  const Outcome outcome =
      Run("finray_plan",
          "--from " + folder + "rec1.csv," + folder + "rec2.csv --plan " +
              folder + "Pt.yaml --finger " + folder +
              "F.yaml --x_mm -30:15 --y_mm 0:100 --force_max_N 7 "
              "--force_N 3 --region_mm 20:75 --target_force_N 0.02 "
              "--most_frames 40 --noreport --out_dir %d");
  EXPECT_EQ(outcome.code, 4) << outcome.output;
  EXPECT_THAT(outcome.output,
              HasSubstr("the noise of one frame is larger than the target"));
  // finray_design predicts 0.123 N at worst for this finger.
  const std::size_t worst = outcome.output.find("at worst ");
  ASSERT_NE(worst, std::string::npos);
  double mm = 0, N = 0;
  ASSERT_EQ(std::sscanf(outcome.output.c_str() + worst,
                        "at worst %lf mm and %lf N", &mm, &N),
            2);
  EXPECT_NEAR(N, 0.123, 0.012);
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
