// finray_reconstruct and finray_compliance on the command line.

#include "apps/command_line.h"
#include "finray/io/frame_table.h"
#include "perception/simulated_slider.h"
#include "perception/simulated_touches.h"
#include "test_finger.h"

namespace finray {
namespace {

using testing::HasSubstr;

class PerceptionCommandTest : public CommandLineTest {
 protected:
  // Touches and true outline of an ellipse.
  void WriteTouches(int orientations, std::size_t rows) {
    const Outline ellipse(EllipseOutline{20, 15});
    TouchProtocol protocol;
    protocol.orientations = orientations;
    FrameTable table =
        SimulateTouches(PaperFinger(), ellipse, {}, protocol, {true, 0.02, 1});
    table.Truncate(rows);
    table.Write(folder_.Path("touches.csv"));
    const Polygon points = SampledOutline(ellipse, 200);
    FrameTable truth(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      truth.MutableNumbers("x_mm")[i] = points[i].x();
      truth.MutableNumbers("y_mm")[i] = points[i].y();
    }
    truth.Write(folder_.Path("truth.csv"));
  }

  std::string Reconstruct(const std::string& rest) const {
    return "--finger " + paper_ + " --logs %touches.csv --out_dir %out " + rest;
  }
};

TEST_F(PerceptionCommandTest, ReconstructsAnEllipse) {
  WriteTouches(24, 24);
  const Outcome outcome =
      Run("finray_reconstruct", Reconstruct("--truth %truth.csv"));
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("24 of 24 rows usable"));
  EXPECT_THAT(outcome.output, HasSubstr("radial error   mean 0."));
  const FrameTable outline = FrameTable::Read(folder_.Path("out/outline.csv"));
  EXPECT_EQ(outline.rows(), 360u);
  for (const char* file : {"outline.svg", "outline.png", "touches.csv",
                           "beams.csv", "reconstruction.yaml"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_.Path("out/") + file)) << file;
  }
  // A contact may slide along the beam more easily than leave it.
  FrameTable touches = FrameTable::Read(folder_.Path("out/touches.csv"));
  for (std::size_t i = 0; i < touches.rows(); ++i) {
    EXPECT_GT(std::stod(touches.MutableText("along_std_mm")[i]),
              std::stod(touches.MutableText("normal_std_mm")[i]));
  }
}

TEST_F(PerceptionCommandTest, RefusesFewTouchesWithCode2) {
  WriteTouches(24, 7);
  ExpectBadInput("finray_reconstruct", Reconstruct(""),
                 "too few touches: 7 usable in 7 rows");
}

TEST_F(PerceptionCommandTest, RefusesOneSidedTouchesWithCode4) {
  WriteTouches(36, 20);
  const Outcome outcome = Run("finray_reconstruct", Reconstruct(""));
  EXPECT_EQ(outcome.code, 4) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("badly spread touches"));
  EXPECT_FALSE(std::filesystem::exists(folder_.Path("out")));
}

TEST_F(PerceptionCommandTest, BadFlagsAndFiles) {
  WriteTouches(12, 12);
  EXPECT_EQ(Run("finray_reconstruct", Reconstruct("--descriptors 4")).code, 1);
  folder_.Write("bad.csv", "x_mm,y_mm\n1,2\n1,b\n3,4\n");
  ExpectBadInput("finray_reconstruct", Reconstruct("--truth %bad.csv"),
                 "bad.csv:3: y_mm: expected a number, found 'b'");
}

TEST_F(PerceptionCommandTest, DoesNotWriteOverItsInput) {
  WriteTouches(24, 24);
  const Outcome outcome =
      Run("finray_reconstruct",
          "--finger " + paper_ + " --logs %touches.csv --out_dir %");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.output, HasSubstr("would be written over"));
}

TEST_F(PerceptionCommandTest, SortsTwoSprings) {
  for (const double stiffness : {0.5, 2.0}) {
    SimulateSlider(PaperFinger(), [=](double u) { return stiffness * u; }, {},
                   {}, {true, 0.02, 1})
        .Write(folder_.Path(stiffness < 1 ? "soft.csv" : "stiff.csv"));
  }
  folder_.Write("scene.yaml",
                "contacts: 1\nobject: {shape: circle, radius_mm: 10}\n");
  const std::string arguments = "--finger " + paper_ +
                                " --scene %scene.yaml --logs "
                                "%soft.csv,%stiff.csv --out_dir %out ";
  const Outcome outcome =
      Run("finray_compliance", arguments + "--direction_deg 180");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("whole order    right with 100 %"));
  EXPECT_LT(outcome.output.find("\nstiff "), outcome.output.find("\nsoft "));
  EXPECT_TRUE(std::filesystem::exists(folder_.Path("out/compliance.png")));
  const Outcome odd =
      Run("finray_compliance", arguments + "--second_logs %soft.csv");
  EXPECT_EQ(odd.code, 2);
  EXPECT_THAT(odd.output, HasSubstr("--second_logs: has 1 logs, --logs 2"));
}

}  // namespace
}  // namespace finray
