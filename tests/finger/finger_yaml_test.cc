#include "finray/finger/finger_yaml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "temp_file.h"
#include "test_finger.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

std::string Text(const std::string& beams, const std::string& ribs,
                 const std::string& gauges) {
  return "schema_version: 1\nname: test\n"
         "geometry: {front_length_mm: 140, back_angle_deg: 112}\n"
         "beams:\n" +
         beams + "ribs:\n" + ribs + "gauges:\n" + gauges;
}
const char kBeams[] =
    "  front: {bending_stiffness_N_mm2: 12500}\n"
    "  back: {width_mm: 20, thickness_mm: 0.5, youngs_modulus_GPa: 60}\n";
const char kRib[] = "  - {front_mm: 17, angle_deg: 10}\n";
const char kGauge[] = "  - {beam: back, start_mm: 30, length_mm: 18}\n";

void ExpectError(const std::string& text, const std::string& message) {
  const TempFolder folder;
  const std::string path = folder.Write("f.yaml", text);
  EXPECT_THAT([&] { ReadFinger(path); },
              ThrowsMessage<InputError>(HasSubstr(message)));
}

TEST(FingerYamlTest, ReadsStiffnessOrPlate) {
  const TempFolder folder;
  const Finger finger =
      ReadFinger(folder.Write("f.yaml", Text(kBeams, kRib, kGauge)));
  EXPECT_EQ(finger.front_stiffness_N_mm2, 12500);
  EXPECT_NEAR(finger.back_stiffness_N_mm2, 60e3 * 20 * 0.125 / 12, 1e-9);
  EXPECT_EQ(finger.gauges[0].noise_V, 3e-4);
}

TEST(FingerYamlTest, RoundTripIsExact) {
  Finger finger = PaperFinger();
  finger.name = "odd: name # here";
  finger.back_angle_rad = 1.9547687622336491 + 1e-15;
  finger.ribs[1].length_mm = 38.1 + 1e-13;
  finger.ribs[2].axial_stiffness_N = 1e4 / 3;
  finger.ribs[0].front_hinge_N_mm_per_rad = 40;
  finger.ribs[0].back_hinge_N_mm_per_rad = 40;
  finger.ribs[3].back_hinge_N_mm_per_rad = 10.0 / 3;
  finger.gauges[2].gain_V_per_rad = -2.0 / 3;
  const TempFolder folder;
  const Finger back = ReadFinger(
      folder.Write("f.yaml", FingerToYaml(finger, "two\nlines of comment")));
  EXPECT_EQ(back.name, finger.name);
  EXPECT_EQ(back.back_angle_rad, finger.back_angle_rad);
  EXPECT_EQ(back.front_stiffness_N_mm2, finger.front_stiffness_N_mm2);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(back.ribs[i].front_mm, finger.ribs[i].front_mm);
    EXPECT_EQ(back.ribs[i].back_mm, finger.ribs[i].back_mm);
    EXPECT_EQ(back.ribs[i].length_mm, finger.ribs[i].length_mm);
    EXPECT_EQ(back.ribs[i].axial_stiffness_N, finger.ribs[i].axial_stiffness_N);
    EXPECT_EQ(back.ribs[i].front_hinge_N_mm_per_rad,
              finger.ribs[i].front_hinge_N_mm_per_rad);
    EXPECT_EQ(back.ribs[i].back_hinge_N_mm_per_rad,
              finger.ribs[i].back_hinge_N_mm_per_rad);
  }
  EXPECT_EQ(back.gauges[2].gain_V_per_rad, finger.gauges[2].gain_V_per_rad);
}

TEST(FingerYamlTest, ReadingsAtTheEndsAreSaturated) {
  const TempFolder folder;
  const std::string gauge =
      "  - {beam: back, start_mm: 30, length_mm: 18, min_V: -2.5, max_V: 5}\n";
  const Finger finger =
      ReadFinger(folder.Write("f.yaml", Text(kBeams, kRib, gauge)));
  const Finger back = ReadFinger(folder.Write("g.yaml", FingerToYaml(finger)));
  for (const Finger& read : {finger, back}) {
    EXPECT_TRUE(read.gauges[0].IsMeasured(4.999));
    EXPECT_FALSE(read.gauges[0].IsMeasured(5));
    EXPECT_FALSE(read.gauges[0].IsMeasured(-2.5));
    EXPECT_FALSE(read.gauges[0].IsMeasured(std::nan("")));
  }
  ExpectError(Text(kBeams, kRib,
                   "  - {beam: back, start_mm: 30, length_mm: 18, min_V: 1, "
                   "max_V: 1}\n"),
              "f.yaml:10:54: min_V: expected less than max_V");
}

TEST(FingerYamlTest, ReadsPiecesAndAxialStiffness) {
  const TempFolder folder;
  const Finger finger = ReadFinger(folder.Write(
      "f.yaml",
      Text("  front:\n"
           "    axial_stiffness_N: 2e4\n"
           "    pieces:\n"
           "      - {end_mm: 60, bending_stiffness_N_mm2: 20000.1}\n"
           "      - {end_mm: 80.5, bending_stiffness_N_mm2: 20000.1}\n"
           "      - {end_mm: 140.0000009, width_mm: 20, thickness_mm: 0.5,"
           " youngs_modulus_GPa: 60}\n"
           "  back:\n"
           "    pieces:\n"
           "      - {end_mm: 60, bending_stiffness_N_mm2: 8000}\n"
           "      - {bending_stiffness_N_mm2: 12000}\n",
           kRib, kGauge)));
  EXPECT_EQ(finger.front_axial_stiffness_N, 2e4);
  EXPECT_TRUE(std::isinf(finger.back_axial_stiffness_N));
  EXPECT_EQ(finger.front_stiffness_N_mm2, 20000.1);
  EXPECT_EQ(finger.back_stiffness_N_mm2, 8000);
  ASSERT_EQ(finger.front_pieces.size(), 3u);
  EXPECT_EQ(finger.front_pieces[0].stiffness_ratio, 1);
  EXPECT_EQ(finger.front_pieces[1].stiffness_ratio, 1);
  EXPECT_EQ(finger.front_pieces[1].end_mm, 80.5);
  EXPECT_NEAR(finger.front_pieces[2].stiffness_ratio,
              60e3 * 20 * 0.125 / 12 / 20000.1, 1e-15);
  EXPECT_EQ(finger.front_pieces[2].end_mm, 140);
  ASSERT_EQ(finger.back_pieces.size(), 2u);
  EXPECT_EQ(finger.back_pieces[1].end_mm, BeamLength(finger, Side::kBack));
  EXPECT_EQ(finger.back_pieces[1].stiffness_ratio, 1.5);
}

TEST(FingerYamlTest, PiecesRoundTripExactly) {
  const TempFolder folder;
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> uniform;
  for (int trial = 0; trial < 200; ++trial) {
    Finger finger = PaperFinger();
    finger.back_angle_rad = 1.7 + uniform(generator);
    finger.ribs.clear();
    finger.gauges.clear();
    finger.front_stiffness_N_mm2 = std::exp(4 + 10 * uniform(generator));
    finger.back_stiffness_N_mm2 = std::exp(4 + 10 * uniform(generator));
    finger.back_axial_stiffness_N = std::exp(20 * uniform(generator));
    for (const Side side : {Side::kFront, Side::kBack}) {
      auto& pieces =
          side == Side::kFront ? finger.front_pieces : finger.back_pieces;
      const double length = BeamLength(finger, side);
      for (int i = 0; i < 6; ++i) {
        // Ratios of every fineness, as a calibration scales all stiffnesses.
        pieces.push_back({(i + uniform(generator)) * length / 6,
                          i == 0 ? 1 : std::exp(4 * uniform(generator) - 2)});
      }
      pieces.back().end_mm = length;
    }
    const std::string text = FingerToYaml(finger);
    const Finger back = ReadFinger(folder.Write("f.yaml", text));
    EXPECT_EQ(back.front_stiffness_N_mm2, finger.front_stiffness_N_mm2);
    EXPECT_EQ(back.back_stiffness_N_mm2, finger.back_stiffness_N_mm2);
    EXPECT_EQ(back.front_axial_stiffness_N, finger.front_axial_stiffness_N);
    EXPECT_EQ(back.back_axial_stiffness_N, finger.back_axial_stiffness_N);
    for (const Side side : {Side::kFront, Side::kBack}) {
      ASSERT_EQ(Pieces(back, side).size(), 6u);
      for (int i = 0; i < 6; ++i) {
        EXPECT_EQ(Pieces(back, side)[i].end_mm, Pieces(finger, side)[i].end_mm);
        EXPECT_EQ(Pieces(back, side)[i].stiffness_ratio,
                  Pieces(finger, side)[i].stiffness_ratio);
      }
    }
    EXPECT_EQ(FingerToYaml(back), text);
  }
}

TEST(FingerYamlTest, WritesRatiosRelativeToTheFirstPiece) {
  Finger finger = PaperFinger();
  finger.front_pieces = {{60, 2}, {140, 3}};
  const TempFolder folder;
  const Finger back = ReadFinger(folder.Write("f.yaml", FingerToYaml(finger)));
  EXPECT_EQ(back.front_stiffness_N_mm2, 25000);
  EXPECT_EQ(back.front_pieces[0].stiffness_ratio, 1);
  EXPECT_EQ(back.front_pieces[1].stiffness_ratio, 1.5);
}

TEST(FingerYamlTest, RefusesPiecesThatDoNotFillTheBeam) {
  const auto error = [](const std::string& front, const std::string& message) {
    ExpectError(
        Text("  front: {" + front + "}\n  back: {bending_stiffness_N_mm2: 3}\n",
             kRib, kGauge),
        message);
  };
  const std::string ei = ", bending_stiffness_N_mm2: 3}";
  error("pieces: [{end_mm: 60" + ei + ", {end_mm: 60" + ei + "]",
        "f.yaml:5:71: end_mm: pieces must be listed from base to tip, but the "
        "one before ends at 60 mm, this one at 60 mm");
  error("pieces: [{end_mm: 60" + ei + ", {end_mm: 100" + ei + "]",
        "f.yaml:5:71: end_mm: the last piece must end at the tip, 140 mm, "
        "found 100; without end_mm it does");
  error("pieces: [{end_mm: 140" + ei + ", {end_mm: 150" + ei + "]",
        "f.yaml:5:29: end_mm: expected an end before the tip, which is at 140 "
        "mm, as this is not the last piece");
  error("pieces: [{bending_stiffness_N_mm2: 3}, {end_mm: 140" + ei + "]",
        "f.yaml:5:20: 'end_mm' is missing in pieces[1]");
  error("pieces: [{end_mn: 140" + ei + "]",
        "f.yaml:5:21: unknown key 'end_mn' in pieces[1] (did you mean "
        "'end_mm'?)");
  error("peices: []",
        "f.yaml:5:11: unknown key 'peices' in front (did you mean 'pieces'?)");
  error("pieces: []", "f.yaml:5:19: pieces: expected at least one");
  error("pieces: 3", "f.yaml:5:19: pieces: expected a list, found '3'");
  error("pieces: [{}]", "'bending_stiffness_N_mm2' is missing in pieces[1]");
  error("pieces: [{bending_stiffness_N_mm2: 0}]",
        "f.yaml:5:46: bending_stiffness_N_mm2: expected a number above 0");
  error("pieces: [{width_mm: 3, bending_stiffness_N_mm2: 3}]",
        "either bending_stiffness_N_mm2 or the plate");
  error("bending_stiffness_N_mm2: 3, pieces: [{bending_stiffness_N_mm2: 3}]",
        "f.yaml:5:36: bending_stiffness_N_mm2: give either the "
        "stiffness of the beam or pieces");
  error("pieces: [{bending_stiffness_N_mm2: 3}], thickness_mm: 3",
        "thickness_mm: give either the stiffness of the beam or pieces");
  error("pieces: [{bending_stiffness_N_mm2: 1e-200}]",
        "expected a number of at least 1e-30, found '1e-200'");
  error("pieces: [{bending_stiffness_N_mm2: 1e200}]",
        "expected a number of at most 1e30, found '1e200'");
  error("bending_stiffness_N_mm2: 3, axial_stiffness_N: -1",
        "f.yaml:5:58: axial_stiffness_N: expected a number above 0, found "
        "'-1'");
  error("bending_stiffness_N_mm2: 3, axial_stifness_N: 1",
        "(did you mean 'axial_stiffness_N'?)");
}

TEST(FingerYamlTest, HingeStiffnessIsOneNumberOrTwo) {
  const TempFolder folder;
  const auto read = [&](const std::string& hinge) {
    return ReadFinger(folder.Write(
        "f.yaml",
        "schema_version: 1\nname: n\n"
        "geometry: {front_length_mm: 140, back_angle_deg: 112}\n"
        "beams: {front: {bending_stiffness_N_mm2: 3}, back: "
        "{bending_stiffness_N_mm2: 3}}\n"
        "ribs: [{front_mm: 17, angle_deg: 10, hinge_stiffness_N_mm_per_rad: " +
            hinge + "}]\n"));
  };
  EXPECT_EQ(read("3").ribs[0].front_hinge_N_mm_per_rad, 3);
  EXPECT_EQ(read("3").ribs[0].back_hinge_N_mm_per_rad, 3);
  EXPECT_EQ(read("[3, 0]").ribs[0].front_hinge_N_mm_per_rad, 3);
  EXPECT_EQ(read("[3, 0]").ribs[0].back_hinge_N_mm_per_rad, 0);
  try {
    read("[3]");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("f.yaml:5:68: hinge_stiffness_N_mm_per_rad: expected a "
                        "number, or two: [front, back]"),
              std::string::npos)
        << error.what();
  }
}

TEST(FingerYamlTest, RibsThatBendRoundTripAndNameTheirErrors) {
  const TempFolder folder;
  const auto read = [&](const std::string& rib) {
    return ReadFinger(
        folder.Write("f.yaml",
                     "schema_version: 1\nname: n\n"
                     "geometry: {front_length_mm: 140, back_angle_deg: 112}\n"
                     "beams: {front: {bending_stiffness_N_mm2: 3}, back: "
                     "{bending_stiffness_N_mm2: 3}}\n"
                     "ribs: [{front_mm: 17, angle_deg: 10, " +
                         rib + "}]\n"));
  };
  // Without a key for hinges the rib is clamped.
  Finger finger =
      read("bending_stiffness_N_mm2: 1000, rigid_ends_mm: [0.5, 1]");
  EXPECT_TRUE(finger.ribs[0].Bends());
  EXPECT_EQ(finger.ribs[0].front_rigid_mm, 0.5);
  EXPECT_EQ(finger.ribs[0].back_rigid_mm, 1);
  EXPECT_TRUE(std::isinf(finger.ribs[0].front_hinge_N_mm_per_rad));
  EXPECT_FALSE(read("axial_stiffness_N: 1e4").ribs[0].HasMoments());
  const Finger sprung =
      read("bending_stiffness_N_mm2: 1e3, hinge_stiffness_N_mm_per_rad: 40");
  for (Finger at : {finger, sprung}) {
    at.ribs[0].bending_stiffness_N_mm2 = 1e3 / 3;
    const Rib back =
        ReadFinger(folder.Write("g.yaml", FingerToYaml(at))).ribs[0];
    EXPECT_EQ(back.bending_stiffness_N_mm2, 1e3 / 3);
    EXPECT_EQ(back.front_rigid_mm, at.ribs[0].front_rigid_mm);
    EXPECT_EQ(back.back_rigid_mm, at.ribs[0].back_rigid_mm);
    EXPECT_EQ(back.back_hinge_N_mm_per_rad, at.ribs[0].back_hinge_N_mm_per_rad);
  }
  const auto expect_error = [&](const std::string& rib,
                                const std::string& message) {
    try {
      read(rib);
      FAIL() << rib;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos)
          << error.what();
    }
  };
  expect_error("rigid_ends_mm: [1, 1]",
               "f.yaml:5:53: rigid_ends_mm: only a rib with "
               "bending_stiffness_N_mm2 bends between its ends");
  expect_error("bending_stiffness_N_mm2: 9, rigid_ends_mm: [1]",
               "rigid_ends_mm: expected two lengths, none below 0");
  expect_error("bending_stiffness_N_mm2: 9, rigid_ends_mm: [30, 30]",
               "shorter than its rigid ends");
  expect_error("bending_stiffness_N_mm2: 0", "bending_stiffness_N_mm2");
  expect_error("bending_stifness_N_mm2: 5", "bending_stiffness_N_mm2");
}

TEST(FingerYamlTest, ClampsAndSurfacesRoundTripExactly) {
  const TempFolder folder;
  const auto read = [&](const std::string& front) {
    return ReadFinger(
        folder.Write("f.yaml",
                     "schema_version: 1\nname: n\n"
                     "geometry: {front_length_mm: 140, back_angle_deg: 112}\n"
                     "beams: {front: {bending_stiffness_N_mm2: 3" +
                         front + "}, back: {bending_stiffness_N_mm2: 3}}\n"));
  };
  Finger finger =
      read(", clamp_stiffness_N_mm_per_rad: 4000, surface_offset_mm: 0.235");
  EXPECT_EQ(finger.front_clamp_rad_per_N_mm, 1 / 4000.0);
  EXPECT_EQ(finger.front_surface_mm, 0.235);
  EXPECT_EQ(finger.back_clamp_rad_per_N_mm, 0);
  EXPECT_EQ(read("").front_clamp_rad_per_N_mm, 0);
  std::mt19937_64 generator(8);
  std::uniform_real_distribution<double> uniform(1e-6, 1e-2);
  for (int i = 0; i < 200; ++i) {
    finger.front_clamp_rad_per_N_mm = uniform(generator);
    finger.back_clamp_rad_per_N_mm = uniform(generator);
    finger.back_surface_mm = -uniform(generator);
    const Finger again =
        ReadFinger(folder.Write("g.yaml", FingerToYaml(finger, "")));
    EXPECT_EQ(again.front_clamp_rad_per_N_mm, finger.front_clamp_rad_per_N_mm);
    EXPECT_EQ(again.back_clamp_rad_per_N_mm, finger.back_clamp_rad_per_N_mm);
    EXPECT_EQ(again.front_surface_mm, finger.front_surface_mm);
    EXPECT_EQ(again.back_surface_mm, finger.back_surface_mm);
  }
  // No file holds a negative compliance.
  finger.front_clamp_rad_per_N_mm = -1e-5;
  EXPECT_EQ(ReadFinger(folder.Write("g.yaml", FingerToYaml(finger, "")))
                .front_clamp_rad_per_N_mm,
            0);
  EXPECT_THROW(read(", clamp_stiffness_N_mm_per_rad: 0"), InputError);
  EXPECT_THROW(read(", clamp_stiffness_N_mm_per_rad: -3"), InputError);
  EXPECT_THROW(read(", surface_offset_mm: thick"), InputError);
}

TEST(FingerYamlTest, FlatGaugesAndHysteresisRoundTrip) {
  const TempFolder folder;
  const auto read = [&](const std::string& gauge) {
    return ReadFinger(
        folder.Write("f.yaml",
                     "schema_version: 1\nname: n\n"
                     "geometry: {front_length_mm: 140, back_angle_deg: 112}\n"
                     "beams: {front: {bending_stiffness_N_mm2: 3}, "
                     "back: {bending_stiffness_N_mm2: 3}}\n"
                     "gauges:\n"
                     "  - {beam: back, start_mm: 30, length_mm: 18" +
                         gauge + "}\n"));
  };
  const Finger finger =
      read(", flat: {share: 0.2, width_rad: 0.025}, hysteresis_rad: 0.001");
  EXPECT_EQ(finger.gauges[0].flat_share, 0.2);
  EXPECT_EQ(finger.gauges[0].flat_width_rad, 0.025);
  EXPECT_EQ(finger.gauges[0].hysteresis_rad, 0.001);
  const std::string text = FingerToYaml(finger, "");
  EXPECT_EQ(FingerToYaml(ReadFinger(folder.Write("g.yaml", text)), ""), text);
  EXPECT_EQ(FingerToYaml(read(""), "").find("flat"), std::string::npos);
  EXPECT_THROW(read(", flat: {share: 1, width_rad: 0.02}"), InputError);
  EXPECT_THROW(read(", flat: {share: 0.2, width_rad: 0}"), InputError);
  EXPECT_THROW(read(", flat: {share: 0.2}"), InputError);
  EXPECT_THROW(read(", hysteresis_rad: -0.001"), InputError);
}

TEST(FingerYamlTest, EveryBundledFingerReads) {
  EXPECT_EQ(PaperFinger().ribs.size(), 5u);
  const Finger printed =
      ReadFinger(FINRAY_SOURCE_DIR "/configs/fingers/printed_100mm.yaml");
  EXPECT_EQ(printed.gauges.size(), 3u);
  EXPECT_NEAR(printed.front_stiffness_N_mm2, 9604, 1e-6);
}

TEST(FingerYamlTest, RefusesWhatCannotBeBuilt) {
  ExpectError(
      Text(kBeams, "  - {front_mm: 17, angle_deg: 10, lenght_mm: 3}\n", kGauge),
      "f.yaml:8:35: unknown key 'lenght_mm' in ribs[1] (did you mean "
      "'length_mm'?)");
  ExpectError(
      Text("  front: {bending_stiffness_N_mm2: -3}\n"
           "  back: {bending_stiffness_N_mm2: 3}\n",
           kRib, kGauge),
      "f.yaml:5:36: bending_stiffness_N_mm2: expected a number above 0, "
      "found '-3'");
  ExpectError(
      Text(kBeams, "  - {front_mm: 17, angle_deg: -40}\n", kGauge),
      "f.yaml:8:31: the rib misses the back beam: it would meet it at ");
  ExpectError(Text(kBeams, "  - {front_mm: 150, angle_deg: 10}\n", kGauge),
              "the rib leaves the front beam, which is 140 mm long");
  ExpectError(
      Text(kBeams, kRib, "  - {beam: back, start_mm: 140, length_mm: 18}\n"),
      "f.yaml:10:28: the gauge ends at 158 mm, off its beam, which is "
      "150.995 mm long");
  ExpectError(
      Text(kBeams, kRib, "  - {beam: side, start_mm: 1, length_mm: 2}\n"),
      "beam: expected one of front, back, found 'side'");
  ExpectError(
      Text(kBeams, std::string("  - {front_mm: 39, angle_deg: 13}\n") + kRib,
           kGauge),
      "ribs must be listed from base to tip");
  ExpectError(Text(kBeams,
                   "  - {front_mm: 17, back_mm: 60}\n"
                   "  - {front_mm: 39, back_mm: 50}\n",
                   kGauge),
              "ribs 1 and 2 cross");
  ExpectError(
      Text(kBeams, "  - {front_mm: 17, back_mm: 60, angle_deg: 3}\n", kGauge),
      "either angle_deg or back_mm");
  ExpectError(Text("  front: {bending_stiffness_N_mm2: 3, width_mm: 1}\n"
                   "  back: {bending_stiffness_N_mm2: 3}\n",
                   kRib, kGauge),
              "either bending_stiffness_N_mm2 or the plate");
  ExpectError("schema_version: 2\n", "f.yaml:1:17: schema_version: expected 1");
  ExpectError(
      "schema_version: 1\nname: x\n"
      "geometry: {front_length_mm: 140, back_angle_deg: 80}\n",
      "back_angle_deg: expected an angle between 90 and 180");
}

TEST(FingerYamlTest, RefusesRibsThatTheLadderCannotClimb) {
  // At the tip, where both beams are.
  ExpectError(Text(kBeams, "  - {front_mm: 140, angle_deg: 10}\n", kGauge),
              "f.yaml:8:16: front_mm: the rib leaves the front beam, which is "
              "140 mm long");
  ExpectError(Text(kBeams, "  - {front_mm: 130, back_mm: 151}\n", kGauge),
              "f.yaml:8:30: the rib misses the back beam: it would meet it at "
              "151 mm, expected between 0 and 150.995 mm");
  ExpectError(Text(kBeams, "  - {front_mm: 0, back_mm: 10}\n", kGauge),
              "f.yaml:8:16: front_mm: expected a number above 0, found '0'");
  ExpectError(
      Text(kBeams, "  - {front_mm: 17, back_mm: 20, length_mm: 0}\n", kGauge),
      "f.yaml:8:44: length_mm: expected a number above 0, found '0'");
  ExpectError(Text(kBeams,
                   "  - {front_mm: 17, back_mm: 60}\n"
                   "  - {front_mm: 39, back_mm: 50}\n",
                   kGauge),
              "f.yaml:9:16: ribs 1 and 2 cross: they meet the back beam at 60 "
              "and 50 mm");
  ExpectError(Text(kBeams,
                   "  - {front_mm: 17, back_mm: 60}\n"
                   "  - {front_mm: 17, back_mm: 70}\n",
                   kGauge),
              "f.yaml:9:16: front_mm: ribs must be listed from base to tip");
}

}  // namespace
}  // namespace finray
