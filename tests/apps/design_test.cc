#include "command_line.h"
#include "finray/finger/finger_yaml.h"

namespace finray {
namespace {

using testing::HasSubstr;

class DesignTest : public CommandLineTest {};

TEST_F(DesignTest, PredictsAndPlacesGauges) {
  const Outcome outcome =
      Run("finray_design", "--finger " + paper_ + " --plan " + plan_ +
                               " --calibration_frames 60 --force_N 2 "
                               "--region_mm 20:105 --gauges 4 --most_gauges 3 "
                               "--out_dir %d");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("before         place"));
  EXPECT_THAT(outcome.output, HasSubstr("60 frames by"));
  EXPECT_THAT(outcome.output, HasSubstr("3 gauges       place"));
  const Finger finger = ReadFinger(folder_.Path("d/finger.yaml"));
  EXPECT_EQ(finger.gauges.size(), 4u);
  EXPECT_FALSE(finger.calibration.has_value());
  EXPECT_THAT(folder_.Read("d/accuracy.csv"),
              HasSubstr("contact_1_mm,normal_1_N,contact_1_std_mm"));
  EXPECT_THAT(folder_.Read("d/gauges.csv"), HasSubstr("worst_place_std_mm"));
  EXPECT_THAT(folder_.Read("d/finger.svg"), HasSubstr("</svg>"));
}

TEST_F(DesignTest, StartsFromDimensions) {
  const Outcome outcome = Run(
      "finray_design",
      "--front_length_mm 100 --back_angle_deg 110 --ribs 16:13,35:16,54:19 "
      "--width_mm 20 --thickness_mm 1.4 --youngs_modulus_GPa 2.1 --gauges 3 "
      "--gauge_length_mm 8:14 --gauge_beams back,front --out_dir %d");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  const Finger finger = ReadFinger(folder_.Path("d/finger.yaml"));
  EXPECT_EQ(finger.ribs.size(), 3u);
  EXPECT_NEAR(finger.front_stiffness_N_mm2, 2100 * 20 * 1.4 * 1.4 * 1.4 / 12,
              1e-6);
}

TEST_F(DesignTest, WrongUse) {
  const auto expect_usage = [&](const std::string& arguments,
                                const std::string& words) {
    const Outcome outcome = Run("finray_design", arguments + " --out_dir %out");
    EXPECT_EQ(outcome.code, 1) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr(words));
  };
  expect_usage("", "expected one of --finger, --dxf and --front_length_mm");
  expect_usage("--finger " + paper_ + " --gauges 1", "at least 2");
  expect_usage("--finger " + paper_ + " --region_mm 20:150", "--region_mm");
  expect_usage("--finger " + paper_ + " --goal speed", "--goal");
  expect_usage(
      "--front_length_mm 100 --ribs 16 --width_mm 20 --thickness_mm 1 "
      "--youngs_modulus_GPa 2 --gauges 4",
      "front_mm:angle_deg");
  expect_usage("--dxf a.dxf --gauges 4", "--youngs_modulus_GPa");
  ExpectBadInput("finray_design",
                 "--finger " + paper_ + " --gauges 9 --out_dir %out",
                 "have no room");
  ExpectBadInput("finray_design",
                 "--dxf %no.dxf --width_mm 20 --youngs_modulus_GPa 2 "
                 "--gauges 4 --out_dir %out",
                 "no.dxf");
}

}  // namespace
}  // namespace finray
