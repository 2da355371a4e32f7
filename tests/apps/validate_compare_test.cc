// finray_validate and finray_compare as a user, or CI, meets them.

#include <yaml-cpp/yaml.h>

#include <cmath>

#include "apps/command_line.h"
#include "finray/io/frame_table.h"
#include "shared_case.h"

namespace finray {
namespace {

using testing::HasSubstr;

class ValidateCompareTest : public CommandLineTest {
 protected:
  const std::string hidden_ = data_ + "hidden_finger.yaml";
  const std::string validate_ = "--finger " + hidden_ + " --plan " + plan_ +
                                " --logs " + data_ +
                                "holdout.csv --out_dir %out";
};

TEST_F(ValidateCompareTest, TheTrueFingerPasses) {
  const Outcome outcome =
      Run("finray_validate", validate_ + " --baseline " + paper_ +
                                 " --most_force_rms_N 0.1 --most_force_percent "
                                 "3 --most_contact_rms_mm 2 "
                                 "--least_coverage_68_percent 55 "
                                 "--least_coverage_95_percent 90 "
                                 "--least_usable_percent 90");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  // Of seven lines one has the origin, which the bundled plan frees.
  EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 7);
  const YAML::Node result = YAML::LoadFile(folder_.Path("out/validation.yaml"));
  EXPECT_EQ(result["verdict"].as<std::string>(), "passed");
  EXPECT_EQ(result["gates"].size(), 6u);
  const YAML::Node errors = result["errors"];
  EXPECT_EQ(errors["contact"]["frames"].as<int>() +
                errors["free"]["frames"].as<int>(),
            110);
  int frames = 0;
  for (const YAML::Node& region : errors["regions"]) {
    frames += region["frames"].as<int>();
  }
  EXPECT_EQ(frames, errors["contact"]["frames"].as<int>());
  // The drawn finger explains none of the touches.
  EXPECT_EQ(result["baseline"]["contact"]["usable"].as<int>(), 0);

  // The table has what the sums are made of.
  const FrameTable table =
      FrameTable::Read(folder_.Path("out/validation.frames.csv"));
  ASSERT_EQ(table.rows(), 110u);
  EXPECT_EQ(result["inputs"]["logs"].size(), 1u);
}

TEST_F(ValidateCompareTest, AGateThatFailsIsExitCode4) {
  const Outcome outcome =
      Run("finray_validate", validate_ + " --most_force_rms_N 0.001");
  EXPECT_EQ(outcome.code, 4) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("most_force_rms_N 0.001"));
  EXPECT_THAT(outcome.output, HasSubstr("FAILED"));
  EXPECT_THAT(folder_.Read("out/validation.yaml"),
              HasSubstr("verdict: failed"));
}

TEST_F(ValidateCompareTest, StrictCountsErrorsWithoutGates) {
  const std::string drawn = "--finger " + paper_ + " --plan " + plan_ +
                            " --logs " + data_ + "holdout.csv --out_dir %drawn";
  const Outcome outcome = Run("finray_validate", drawn);
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("\nwarning: the finger is not "
                                        "calibrated: "));
  EXPECT_EQ(Run("finray_validate", drawn + " --strict").code, 4);
  EXPECT_EQ(Run("finray_validate", validate_ + " --strict").code, 0);
}

TEST_F(ValidateCompareTest, BadInputOfValidate) {
  EXPECT_EQ(Run("finray_validate", "--finger " + hidden_).code, 1);
  EXPECT_EQ(Run("finray_validate", validate_ + " --scene x.yaml").code, 2);
  EXPECT_EQ(Run("finray_validate", validate_ + " --most_force_rms_N -1").code,
            1);
  // No gate that is silently none, or in the wrong unit.
  Outcome outcome = Run("finray_validate", validate_ + " --most_force_rms_N 0");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.output, HasSubstr("expected a number above 0, found 0"));
  outcome =
      Run("finray_validate", validate_ + " --least_coverage_95_percent 0.95");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.output, HasSubstr("in percent, such as 95"));
  EXPECT_EQ(
      Run("finray_validate", validate_ + " --least_usable_percent 150").code,
      1);
  folder_.Write("gauges.csv",
                "gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V\n1,1,1,1\n");
  const std::string blind =
      "--finger " + hidden_ + " --logs %gauges.csv --out_dir %out";
  ExpectBadInput("finray_validate", blind,
                 "no frame with contact has a reference");
  folder_.Write("force.csv",
                "gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V,force_N\n"
                "0.1,0.1,0.1,0.1,2\n");
  ExpectBadInput("finray_validate",
                 "--finger " + hidden_ +
                     " --logs %force.csv --out_dir %out "
                     "--most_contact_rms_mm 1",
                 "--most_contact_rms_mm needs contact_1_mm");
  folder_.Write("short.csv", "gauge_1_V,force_N\n1,1\n");
  ExpectBadInput("finray_validate",
                 "--finger " + hidden_ + " --logs %short.csv --out_dir %out",
                 "short.csv: no column 'gauge_2_V'");
  ExpectBadInput("finray_validate",
                 validate_ + " --baseline " FINRAY_SOURCE_DIR
                             "/configs/fingers/paper_140mm_eight_gauges.yaml",
                 "8 gauges, but");
}

TEST_F(ValidateCompareTest, SaysWhatItDoesNotApply) {
  folder_.Write("plan.yaml",
                "schema_version: 1\n"
                "scene: {contacts: auto, object: {shape: circle, "
                "radius_mm: 15}}\n"
                "parameters: {gauge_offset: {}, force_scale: {}, "
                "object_origin: {}}\n");
  const Outcome outcome = Run(
      "finray_validate", "--finger " + hidden_ + " --plan %plan.yaml --logs " +
                             data_ + "holdout.csv --out_dir %out");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output,
              HasSubstr("the plan frees force_scale: its value"));
  EXPECT_THAT(outcome.output, HasSubstr("\norigin         "));
  EXPECT_THAT(outcome.output, HasSubstr(" missed), 10 free ("));
}

// A log whose rows are means of many readings is judged by the noise of means:
// intervals of the noise of one reading would hold all errors.
TEST_F(ValidateCompareTest, CoverageOfMeansIsByTheirNoise) {
  const std::string folder = SharedCase("plateau_noise/");
  if (folder.empty()) GTEST_SKIP() << "the inputs are not here";
  const Outcome outcome =
      Run("finray_validate", "--finger " + folder + "finger.yaml --plan " +
                                 folder + "Pt.yaml --logs " + folder +
                                 "rec3.csv --out_dir %out");
  const YAML::Node errors =
      YAML::LoadFile(folder_.Path("out/validation.yaml"))["errors"]["contact"];
  EXPECT_LE(errors["force_coverage_68_percent"].as<double>(), 85);
  EXPECT_GE(errors["force_coverage_68_percent"].as<double>(), 50);
  EXPECT_LE(errors["contact_coverage_68_percent"].as<double>(), 90);
  EXPECT_GE(errors["contact_rms_z"].as<double>(), 0.6);
  EXPECT_LE(errors["contact_rms_z"].as<double>(), 1.6);
}

TEST_F(ValidateCompareTest, CompareTwoCalibrations) {
  for (const char* log : {"train", "holdout"}) {
    ASSERT_EQ(Run("finray_calibrate",
                  "--finger " + hidden_ + " --plan " + plan_ + " --logs " +
                      data_ + log + ".csv --report=false --out_dir %" + log)
                  .code,
              0);
  }
  Outcome outcome = Run("finray_compare",
                        "%train %holdout/calibration.yaml --out_dir %out "
                        "--most_sigma 5 --least_p_value 0.001");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 6);
  const YAML::Node result = YAML::LoadFile(folder_.Path("out/comparison.yaml"));
  EXPECT_EQ(result["all"]["dof"].as<int>(), 17);
  EXPECT_EQ(result["shared_logs"].as<int>(), 0);
  for (const char* key : {"only_in_a", "only_in_b", "of_other_logs"}) {
    EXPECT_TRUE(result[key].IsSequence() && result[key].size() == 0) << key;
  }
  // Near the end of the valley one finger may say less than the other.
  EXPECT_LE(result["predicted"]["lost_points"].as<int>(), 1);
  EXPECT_EQ(result["verdict"].as<std::string>(), "passed");
  for (const YAML::Node& p : result["parameters"]) {
    const double a = p["a"].as<double>(), b = p["b"].as<double>();
    EXPECT_EQ(p["difference"].as<double>(), b - a);
  }
  EXPECT_EQ(FrameTable::Read(folder_.Path("out/comparison.csv")).rows(), 36u);

  EXPECT_THAT(outcome.output, HasSubstr(" of 36 points"));
  EXPECT_EQ(Run("finray_compare",
                "%train %holdout --out_dir %out --most_sigma "
                "0")
                .code,
            1);
  outcome = Run("finray_compare",
                "%train %holdout --out_dir %out --most_force_difference_N "
                "0.0001");
  EXPECT_EQ(outcome.code, 4) << outcome.output;
  outcome = Run("finray_compare", "%train %train --out_dir %out");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("1 log in common"));

  std::filesystem::remove_all(folder_.Path("out"));
  EXPECT_EQ(Run("finray_compare", "%train --out_dir %out").code, 1);
  EXPECT_EQ(Run("finray_compare", "%train %holdout").code, 1);
  ExpectBadInput("finray_compare", "%train %none --out_dir %out",
                 "none: cannot be read");
  folder_.Write("bad/calibration.yaml", "");
  std::filesystem::create_directory(folder_.Path("bad"));
  folder_.Write("bad/calibration.yaml",
                "schema_version: 1\nparameters:\n  - {name: x, unit: mm, "
                "value: 1, std: -1, status: estimated}\n");
  ExpectBadInput("finray_compare", "%train %bad --out_dir %out",
                 "calibration.yaml:3:40: std: expected a number of at least 0");
}

TEST_F(ValidateCompareTest, CalibrateChecksItself) {
  folder_.Write("plan.yaml",
                "schema_version: 1\n"
                "scene: {contacts: auto, object: {shape: circle, "
                "radius_mm: 15}}\n"
                "parameters: {gauge_offset: {}, gauge_gain: {}}\n"
                "holdout: {by: block, fraction: 0.2}\n");
  const Outcome outcome = Run(
      "finray_calibrate", "--finger " + hidden_ + " --plan %plan.yaml --logs " +
                              data_ + "train.csv," + data_ +
                              "holdout.csv --report=false --out_dir %cal");
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("\nnext "));
  const YAML::Node result =
      YAML::LoadFile(folder_.Path("cal/calibration.yaml"));
  const YAML::Node held = result["errors"]["held_out"]["after"]["contact"];
  // One definition of the force error, over frames with a usable estimate.
  EXPECT_EQ(held["force_rms_N"].as<double>(),
            result["holdout"]["force_rms_error_after_N"].as<double>());
  EXPECT_LE(result["holdout"]["frames"].as<int>(), held["frames"].as<int>());
  // Nobody has known the gains.
  EXPECT_FALSE(result["holdout"]["force_rms_error_before_N"]);
  EXPECT_LT(held["force_rms_percent"].as<double>(), 3);
  EXPECT_FALSE(result["residual_correlation"]["correlated"].as<bool>());
  // 4 gauges, force and two coordinates of two logs.
  EXPECT_EQ(result["residual_correlation"]["series"].size(), 14u);
  EXPECT_EQ(result["leave_one_log_out"]["groups"].as<int>(), 2);
  EXPECT_EQ(result["leave_one_log_out"]["parameters"].size(), 8u);
  // Both logs determine gains and offsets: enough is recorded.
  EXPECT_THAT(outcome.output, HasSubstr("enough recorded: "));
  const YAML::Node force = result["predicted_force"];
  EXPECT_TRUE(force["enough"].as<bool>());
  EXPECT_LE(force["calibration_N"].as<double>(), force["noise_N"].as<double>());
}

}  // namespace
}  // namespace finray
