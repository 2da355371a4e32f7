// The executables as a user meets them: files in, files out, messages, codes.

#include "apps/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>

#include "finray/finger/geometry.h"
#include "finray/io/frame_table.h"
#include "finray/io/versions.h"
#include "test_finger.h"

namespace finray {
namespace {

using testing::HasSubstr;

TEST_F(CommandLineTest, SimulateThenEstimate) {
  folder_.Write("in.csv",
                "contact_1_mm,normal_1_N,note\n50,2,a\n90.5,0.7,b\n,,c\n");
  Outcome outcome =
      Run("finray_simulate",
          "--finger " + paper_ +
              " --frames %in.csv --out %out.csv --shape_out %shape.csv");
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_EQ(outcome.output.substr(0, outcome.output.find('\n')),
            folder_.Path("") + "out.csv");
  EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 6);
  EXPECT_EQ(FrameTable::Read(folder_.Path("shape.csv")).rows(), 3u * 202u);
  folder_.Write("scene.yaml", "contacts: auto\n");
  outcome = Run("finray_estimate",
                "--finger " + paper_ +
                    " --scene %scene.yaml --logs %out.csv --out_dir %est");
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  FrameTable frames = FrameTable::Read(folder_.Path("est/out.frames.csv"));
  EXPECT_NEAR(frames.Numbers("contact_1_mm")[0], 50, 1e-5);
  EXPECT_NEAR(frames.Numbers("normal_1_N")[1], 0.7, 1e-6);
  EXPECT_EQ(frames.MutableText("status")[0], "ok");
  EXPECT_EQ(frames.MutableText("status")[2], "no_contact");
  EXPECT_EQ(frames.MutableText("note")[2], "c");
  const YAML::Node summary = YAML::LoadFile(folder_.Path("est/summary.yaml"));
  EXPECT_EQ(summary["all"]["frames"].as<int>(), 3);
  EXPECT_LT(summary["all"]["force_rms_error_N"].as<double>(), 1e-6);
}

// No other flag is needed to find out.
TEST_F(CommandLineTest, MoreThreadsThanAnyMachineHasAreRefused) {
  for (const char* app :
       {"finray_estimate", "finray_calibrate", "finray_validate", "finray_plan",
        "finray_control", "finray_benchmark"}) {
    for (const char* threads : {"100000", "1025", "-1"}) {
      const Outcome outcome = Run(app, std::string("--threads ") + threads);
      EXPECT_EQ(outcome.code, 1) << app;
      EXPECT_EQ(outcome.output,
                std::string(app) +
                    ": --threads: expected 0 (all cores) to 1024, found " +
                    threads + "; see --help\n");
    }
  }
}

TEST_F(CommandLineTest, CalibrateTheBundledLog) {
  const Outcome outcome = Run(
      "finray_calibrate", "--finger " + paper_ + " --plan " + plan_ +
                              " --logs " + data_ + "train.csv --out_dir %cal");
  ASSERT_EQ(outcome.code, 0) << outcome.output;
  const Finger truth = ReadFinger(data_ + "hidden_finger.yaml");
  const YAML::Node result =
      YAML::LoadFile(folder_.Path("cal/calibration.yaml"));
  EXPECT_EQ(result["verdict"].as<std::string>(), "good");
  int checked = 0;
  for (const YAML::Node& p : result["parameters"]) {
    const std::string name = p["name"].as<std::string>();
    double expected = std::nan("");
    if (name == "front_stiffness_N_mm2") expected = truth.front_stiffness_N_mm2;
    if (name == "back_stiffness_N_mm2") expected = truth.back_stiffness_N_mm2;
    for (int j = 0; j < 4; ++j) {
      const std::string gauge = "gauge_" + std::to_string(j + 1);
      if (name == gauge + "_gain_V_per_rad") {
        expected = truth.gauges[j].gain_V_per_rad;
      }
      if (name == gauge + "_offset_V") expected = truth.gauges[j].offset_V;
    }
    for (int i = 0; i < 5; ++i) {
      if (name == "rib_" + std::to_string(i + 1) + "_length_mm") {
        expected = truth.ribs[i].length_mm;
      }
    }
    if (name.rfind("object_origin_", 0) == 0) expected = 0;
    if (std::isnan(expected)) {
      EXPECT_EQ(p["status"].as<std::string>(), "fixed");
      continue;
    }
    ++checked;
    EXPECT_EQ(p["status"].as<std::string>(), "estimated");
    EXPECT_LT(std::abs(p["value"].as<double>() - expected),
              4 * p["std"].as<double>())
        << name;
  }
  EXPECT_EQ(checked, 17);
  const std::string report = folder_.Read("cal/report.html");
  EXPECT_THAT(report, HasSubstr("All 17 free parameters are determined"));
  EXPECT_THAT(report, testing::Not(HasSubstr("src=\"http")));
  // The table of starts says yes or no, and on a phone the columns in front
  // show.
  EXPECT_THAT(report, HasSubstr("<td>yes</td>"));
  EXPECT_THAT(report, testing::Not(HasSubstr(">True<")));
  EXPECT_THAT(report, HasSubstr("<th>parameter</th><th class=\"text\">status"));
  EXPECT_THAT(report, testing::Not(HasSubstr("prior std off</span>")));

  // A rib that was cut to another length than drawn is marked, and doubtful.
  Finger drawn = ReadFinger(paper_);
  drawn.ribs[2].length_mm -= 5;
  folder_.Write("drawn.yaml", FingerToYaml(drawn));
  EXPECT_EQ(Run("finray_calibrate", "--finger %drawn.yaml --plan " + plan_ +
                                        " --logs " + data_ +
                                        "train.csv --out_dir %far")
                .code,
            4);
  EXPECT_THAT(folder_.Read("far/report.html"),
              HasSubstr("<span class=\"chip far\">10 prior std off</span>"));

  // The result is a finger that every other tool reads.
  const Outcome estimate =
      Run("finray_estimate", "--finger %cal/finger.yaml --logs " + data_ +
                                 "holdout.csv --out_dir %est");
  ASSERT_EQ(estimate.code, 0) << estimate.output;
  const YAML::Node summary = YAML::LoadFile(folder_.Path("est/summary.yaml"));
  EXPECT_LT(summary["all"]["force_rms_error_N"].as<double>(), 0.2);
}

TEST_F(CommandLineTest, AnUndeterminedParameterFailsTheGate) {
  FrameTable log = FrameTable::Read(data_ + "train.csv");
  log.MutableNumbers("force_N").assign(log.rows(), std::nan(""));
  log.Write(folder_.Path("blind.csv"));
  const Outcome outcome =
      Run("finray_calibrate", "--finger " + paper_ + " --plan " + plan_ +
                                  " --logs %blind.csv --out_dir %cal");
  EXPECT_EQ(outcome.code, 4) << outcome.output;
  EXPECT_THAT(outcome.output,
              HasSubstr("front and back stiffness and all forces scale "
                        "together"));
  EXPECT_THAT(folder_.Read("cal/calibration.yaml"),
              HasSubstr("status: unidentifiable"));
}

TEST_F(CommandLineTest, DumpsWhatIsInForce) {
  folder_.Write("in.csv", "contact_1_mm,normal_1_N\n50,2\n");
  const Outcome outcome =
      Run("finray_simulate",
          "--finger " + paper_ + " --frames %in.csv --out %out --dump_config");
  EXPECT_EQ(outcome.code, 0);
  const YAML::Node config = YAML::Load(outcome.output);
  EXPECT_EQ(config["resolution"].as<int>(), 12);
  EXPECT_NEAR(config["finger"]["ribs"][0]["back_mm"].as<double>(), 27.1574,
              1e-4);
  EXPECT_FALSE(std::filesystem::exists(folder_.Path("out")));
}

TEST_F(CommandLineTest, PiecesStretchAndBackContacts) {
  Finger finger = PaperFinger();
  finger.front_pieces = {{60, 1}, {140, 1.25}};
  finger.back_axial_stiffness_N = 2e4;
  folder_.Write("finger.yaml", FingerToYaml(finger));
  folder_.Write("scene.yaml", "contacts: 1\ncontact_beams: [back]\n");
  folder_.Write("in.csv", "contact_1_mm,normal_1_N\n145,2\n");
  const std::string simulate =
      "--finger %finger.yaml --scene %scene.yaml --frames %in.csv --out %out";
  const Outcome dump = Run("finray_simulate", simulate + " --dump_config");
  ASSERT_EQ(dump.code, 0) << dump.output;
  const YAML::Node config = YAML::Load(dump.output);
  EXPECT_EQ(config["contact_beams"][0].as<std::string>(), "back");
  const YAML::Node beams = config["finger"]["beams"];
  EXPECT_EQ(beams["back"]["axial_stiffness_N"].as<double>(), 2e4);
  EXPECT_EQ(beams["front"]["pieces"][1]["bending_stiffness_N_mm2"].as<double>(),
            1.25 * 12500);
  ExpectBadInput("finray_simulate", simulate + " --scheme rigid_chain",
                 "rigid links do not stretch, but the finger has an "
                 "axial_stiffness_N");
  folder_.Write("plan.yaml",
                "schema_version: 1\nscene: scene.yaml\nparameters: {}\n");
  const std::string refused =
      "scene.yaml:2:16: contact_beams: contacts on the back beam can be "
      "simulated only";
  ExpectBadInput("finray_calibrate",
                 "--finger %finger.yaml --plan %plan.yaml --logs " + data_ +
                     "train.csv --out_dir %out",
                 refused);
  ExpectBadInput("finray_estimate",
                 "--finger %finger.yaml --scene %scene.yaml --logs " + data_ +
                     "train.csv --out_dir %out",
                 refused);
  folder_.Write("in.csv", "contact_1_mm,normal_1_N\n152,2\n");
  ExpectBadInput("finray_simulate", simulate,
                 "in.csv:2: contact_1_mm: expected an arc length on the back "
                 "beam");
  folder_.Write("in.csv", "contact_1_mm,normal_1_N\n145,2\n");
  EXPECT_EQ(Run("finray_simulate", simulate).code, 0);
}

TEST_F(CommandLineTest, CalibrationKeepsPiecesAndStretch) {
  Finger finger = PaperFinger();
  finger.back_pieces = {{60, 1}, {BeamLength(finger, Side::kBack), 0.8}};
  finger.front_axial_stiffness_N = 3e4;
  folder_.Write("truth.yaml", FingerToYaml(finger));
  std::string loads = "contact_1_mm,normal_1_N\n";
  for (int i = 0; i < 30; ++i) {
    loads +=
        std::to_string(30 + 3 * i) + "," + std::to_string(1 + i % 5) + "\n";
  }
  folder_.Write("in.csv", loads);
  ASSERT_EQ(Run("finray_simulate",
                "--finger %truth.yaml --frames %in.csv --out %out.csv")
                .code,
            0);
  Finger start = finger;
  start.back_stiffness_N_mm2 *= 1.1;
  folder_.Write("start.yaml", FingerToYaml(start));
  folder_.Write("plan.yaml",
                "schema_version: 1\n"
                "scene: {contacts: 1, contact_beams: [front]}\n"
                "parameters: {back_stiffness: {prior_std_percent: 50}}\n");
  const Outcome outcome =
      Run("finray_calibrate",
          "--finger %start.yaml --plan %plan.yaml --logs %out.csv "
          "--out_dir %cal --report=false");
  // A log without noise: what is stated is too large.
  ASSERT_EQ(outcome.code, 4) << outcome.output;
  const Finger found = ReadFinger(folder_.Path("cal/finger.yaml"));
  EXPECT_NEAR(found.back_stiffness_N_mm2, 12500, 2);
  ASSERT_EQ(found.back_pieces.size(), 2u);
  EXPECT_EQ(found.back_pieces[1].stiffness_ratio, 0.8);
  EXPECT_EQ(found.back_pieces[0].end_mm, 60);
  EXPECT_EQ(found.front_axial_stiffness_N, 3e4);
  const YAML::Node config =
      YAML::LoadFile(folder_.Path("cal/calibration.yaml"))["config"];
  EXPECT_EQ(config["contact_beams"][0].as<std::string>(), "front");
}

// The tool's own flags, what is required first; nothing of the libraries.
TEST_F(CommandLineTest, HelpIsShort) {
  for (const char* flag : {"--help", "-h"}) {
    const Outcome help = Run("finray_calibrate", flag);
    EXPECT_EQ(help.code, 0);
    EXPECT_THAT(help.output, testing::Not(HasSubstr("logtostderr")));
    EXPECT_LT(help.output.find("--plan "), help.output.find("Optional"));
    EXPECT_GT(help.output.find("--threads"), help.output.find("Optional"));
  }
  const Outcome version = Run("finray_calibrate", "--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_THAT(version.output, HasSubstr(FINRAY_VERSION));
}

TEST_F(CommandLineTest, UsageErrorsAreOne) {
  const Outcome missing = Run("finray_simulate", "--out %out");
  EXPECT_EQ(missing.code, 1);
  EXPECT_THAT(missing.output, HasSubstr("--finger is missing; see --help"));
  const Outcome unknown = Run("finray_estimate", "--fingre x");
  EXPECT_EQ(unknown.code, 1);
  EXPECT_THAT(unknown.output,
              HasSubstr("finray_estimate: --fingre is not a flag (did you mean "
                        "'finger'?)"));
  const Outcome scheme =
      Run("finray_simulate",
          "--finger " + paper_ + " --frames %in --out %out --scheme tailor");
  EXPECT_EQ(scheme.code, 1);
  EXPECT_THAT(scheme.output, HasSubstr("did you mean 'taylor'?"));
  const Outcome threads =
      Run("finray_estimate",
          "--finger " + paper_ + " --logs %in --out_dir %out --threads -1");
  EXPECT_EQ(threads.code, 1);
  EXPECT_THAT(threads.output, HasSubstr("--threads: expected 0"));
  EXPECT_EQ(Run("finray_estimate", "stray").code, 1);
}

TEST_F(CommandLineTest, BadInputIsTwoAndOneLine) {
  const std::string simulate =
      "--finger " + paper_ + " --frames %in.csv --out %out";
  const std::string estimate =
      "--finger " + paper_ + " --logs %in.csv --out_dir %out";
  const auto finger = [&](const std::string& from, const std::string& to) {
    std::ostringstream text;
    text << std::ifstream(paper_).rdbuf();
    std::string changed = text.str();
    changed.replace(changed.find(from), from.size(), to);
    folder_.Write("bad.yaml", changed);
    folder_.Write("in.csv", "contact_1_mm,normal_1_N\n50,2\n");
    return std::string("--finger %bad.yaml --frames %in.csv --out %out");
  };
  // unknown key
  ExpectBadInput("finray_simulate", finger("angle_deg: 13", "angel_deg: 13"),
                 "bad.yaml:11:21: unknown key 'angel_deg' in ribs[2] (did you "
                 "mean 'angle_deg'?)");
  // negative stiffness
  ExpectBadInput("finray_simulate", finger("12500", "-12500"),
                 "bad.yaml:7:36: bending_stiffness_N_mm2: expected a number "
                 "above 0, found '-12500'");
  // rib that misses the back beam
  ExpectBadInput("finray_simulate", finger("angle_deg: 22", "angle_deg: -75"),
                 "the rib misses the back beam");
  // gauge off the beam
  ExpectBadInput("finray_simulate", finger("start_mm: 98", "start_mm: 140"),
                 "the gauge ends at 158 mm, off its beam");
  // missing column
  folder_.Write("in.csv", "gauge_1_V,gauge_2_V,gauge_3_V,gauge4_V\n1,1,1,1\n");
  ExpectBadInput("finray_estimate", estimate,
                 "in.csv: no column 'gauge_4_V' (did you mean 'gauge4_V'?)");
  // non-numeric cell
  folder_.Write("in.csv", "contact_1_mm,normal_1_N\n50,2N\n");
  ExpectBadInput("finray_simulate", simulate,
                 "in.csv:2:2: normal_1_N: expected a number, found '2N'");
  // empty log, log without rows, no log
  folder_.Write("in.csv", "");
  ExpectBadInput("finray_estimate", estimate, "in.csv: is empty");
  folder_.Write("in.csv", "gauge_1_V\n");
  ExpectBadInput("finray_estimate", estimate, "has a header but no rows");
  ExpectBadInput("finray_estimate",
                 "--finger " + paper_ + " --logs %none.csv --out_dir %out",
                 "none.csv: cannot be read: No such file or directory");
  ExpectBadInput("finray_estimate",
                 "--finger %none.yaml --logs %in.csv --out_dir %out",
                 "none.yaml: cannot be read");
  // load off the finger, unwritable output
  folder_.Write("in.csv", "contact_1_mm,normal_1_N\n150,2\n");
  ExpectBadInput("finray_simulate", simulate, "in.csv:2: contact_1_mm");
  folder_.Write("in.csv", "contact_1_mm,normal_1_N\n50,2\n");
  ExpectBadInput("finray_simulate",
                 "--finger " + paper_ + " --frames %in.csv --out %no/out",
                 "no/out: cannot be written");
  // plan
  folder_.Write("plan.yaml",
                "schema_version: 1\nparameters: {rib_lenght: {}}\n");
  ExpectBadInput("finray_calibrate",
                 "--finger " + paper_ + " --plan %plan.yaml --logs " + data_ +
                     "train.csv --out_dir %out",
                 "plan.yaml:2:14: unknown key 'rib_lenght' in parameters");
  folder_.Write("plan.yaml",
                "schema_version: 1\n"
                "parameters: {temperature_coefficient: {}}\n");
  ExpectBadInput("finray_calibrate",
                 "--finger " + paper_ + " --plan %plan.yaml --logs " + data_ +
                     "train.csv --out_dir %out",
                 "train.csv: no column 'temperature_C'");
}

// Gauges on the bench: 18 mm long, 2 V/rad; the third one is bent.
TEST_F(CommandLineTest, CalibrateOnTheBench) {
  std::string rows =
      "cylinder_radius_mm,gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V\n";
  int sign = 1;
  for (const char* radius :
       {"inf", "200", "100", "60", "inf", "200", "100", "60"}) {
    const double angle = 18 / std::stod(radius), noise = 1e-4 * (sign = -sign);
    rows += radius;
    for (int j = 0; j < 4; ++j) {
      rows += "," + std::to_string(0.1 + 2 * angle + noise +
                                   (j == 2 ? angle * angle : 0));
    }
    rows += "\n";
  }
  folder_.Write("bench.csv", rows);
  folder_.Write(
      "plan.yaml",
      "schema_version: 1\n"
      "parameters: {gauge_gain: {}, gauge_offset: {per_log: true}}\n");
  const Outcome outcome =
      Run("finray_calibrate", "--finger " + paper_ +
                                  " --plan %plan.yaml --logs %bench.csv "
                                  "--out_dir %bench");
  // A line through the readings of a curved gauge is not to be trusted.
  ASSERT_EQ(outcome.code, 4) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("gauge 3 is not linear"));
  EXPECT_THAT(outcome.output, HasSubstr("gauges with a curved gain"));
  EXPECT_THAT(outcome.output, HasSubstr("8 on the bench"));
  EXPECT_NEAR(
      ReadFinger(folder_.Path("bench/finger.yaml")).gauges[0].gain_V_per_rad, 2,
      2e-3);
  const YAML::Node result =
      YAML::LoadFile(folder_.Path("bench/calibration.yaml"));
  for (int j = 0; j < 4; ++j) {
    EXPECT_EQ(result["bench"][j]["linear"].as<bool>(), j != 2);
  }
  EXPECT_EQ(result["parameters"][6]["name"].as<std::string>(),
            "gauge_1_offset_V[bench.csv]");
}

TEST_F(CommandLineTest, ARowWithoutSolutionIsMarkedAndFails) {
  folder_.Write("in.csv", "contact_1_mm,normal_1_N\n50,2\n70,1e9\n");
  const std::string arguments =
      "--finger " + paper_ + " --frames %in.csv --out %out.csv";
  const Outcome outcome = Run("finray_simulate", arguments);
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.output,
              HasSubstr("in.csv:3: the equilibrium ends at a limit point"));
  FrameTable frames = FrameTable::Read(folder_.Path("out.csv"));
  EXPECT_EQ(frames.MutableText("status")[1], "not_converged");
  EXPECT_TRUE(std::isnan(frames.Numbers("tip_x_mm")[1]));
  EXPECT_EQ(Run("finray_simulate", arguments + " --strict=false").code, 0);
}

}  // namespace
}  // namespace finray
