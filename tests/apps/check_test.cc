#include "command_line.h"

namespace finray {
namespace {

using testing::HasSubstr;

class CheckTest : public CommandLineTest {};

TEST_F(CheckTest, PrintsFiguresAndDraws) {
  const Outcome outcome =
      Run("finray_check", "--finger " + paper_ + " --out %finger.svg");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("finger.svg\nfinger         paper"));
  EXPECT_THAT(outcome.output, HasSubstr("base at x = 56.5637 mm"));
  EXPECT_THAT(outcome.output, HasSubstr("nobody has calibrated"));
  const std::string svg = folder_.Read("finger.svg");
  EXPECT_THAT(svg, HasSubstr("<title>Finger paper_140mm</title>"));
  EXPECT_THAT(svg, HasSubstr("4: 98 to 116"));
}

TEST_F(CheckTest, StrictTurnsWarningsIntoAGate) {
  EXPECT_EQ(Run("finray_check", "--strict --finger " + paper_).code, 4);
}

TEST_F(CheckTest, BadInput) {
  folder_.Write("f.yaml", "schema_version: 1\nname: f\n");
  ExpectBadInput("finray_check", "--finger %f.yaml --out %out", "geometry");
  ExpectBadInput("finray_check", "--finger %none.yaml --out %out", "none.yaml");
  folder_.Write("p.yaml", "");
  const Outcome over =
      Run("finray_check", "--finger " + paper_ + " --out " + paper_);
  EXPECT_EQ(over.code, 2);
  EXPECT_THAT(over.output, HasSubstr("would be written over"));
}

}  // namespace
}  // namespace finray
