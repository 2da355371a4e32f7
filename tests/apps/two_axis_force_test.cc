#include <algorithm>
#include <regex>

#include "apps/command_line.h"
#include "finray/io/frame_table.h"
#include "shared_case.h"

namespace finray {
namespace {

class TwoAxisForceTest : public CommandLineTest {
 protected:
  void SetUp() override {
    case_ = SharedCase("two_axis_force/");
    if (case_.empty()) GTEST_SKIP() << "the inputs are not here";
  }
  std::string case_;
};

// What an estimate warns of, without the name of its log.
std::string WarningsIn(const std::string& output) {
  const std::size_t at = output.find("warning: ");
  return at == std::string::npos
             ? ""
             : std::regex_replace(output.substr(at),
                                  std::regex("(mag|xy)\\.csv"), "log.csv");
}

// A sensor that reads 25 % too much shows, however its force is written.
TEST_F(TwoAxisForceTest, EstimatesWarnAlikeOfMagnitudeAndAxes) {
  std::string said[2];
  for (const std::string log : {"mag", "xy"}) {
    const Outcome outcome = Run(
        "finray_estimate", "--finger " + case_ + "finger.yaml --logs " + case_ +
                               log + ".csv --strict --out_dir %" + log);
    EXPECT_EQ(outcome.code, 4) << outcome.output;
    said[log == "xy"] = WarningsIn(outcome.output);
  }
  EXPECT_THAT(said[0], testing::HasSubstr("373 of 433 are far off"));
  // Both leave the same residuals.
  EXPECT_THAT(said[0], testing::HasSubstr("force sensor has another scale"));
  EXPECT_THAT(said[0], testing::HasSubstr("stiffness is not the finger's"));
  EXPECT_EQ(said[0], said[1]);
}

// Free rows are those whose object is out of reach: some 1500 of 2357. Noise
// of a free row is neither a touch nor a place of the object that is off.
TEST_F(TwoAxisForceTest, FreeRowsStayFree) {
  const std::pair<std::string, std::string> logs[] = {
      {"P.yaml", "moving.csv.gz"}, {"P1.yaml", "one_axis.csv.gz"}};
  for (const auto& [plan, log] : logs) {
    const std::string folder = case_ + "free_rows/";
    const Outcome outcome =
        Run("finray_calibrate", "--finger " + folder + "F.yaml --plan " +
                                    folder + plan + " --logs " + folder + log +
                                    " --noreport --out_dir %" + plan);
    EXPECT_THAT(outcome.output,
                testing::Not(testing::HasSubstr("object's place is off")));
    const FrameTable rows =
        FrameTable::Read(folder_.Path(plan + "/calibration.frames.csv"));
    const FrameTable input = FrameTable::Read(folder + log);
    int free = 0, touching = 0;
    for (std::size_t i = 0; i < rows.rows(); ++i) {
      if (input.Numbers("object_x_mm")[i] > -13) continue;
      ++free;
      touching += rows.Text("kind")[i] == "contact";
    }
    EXPECT_GT(free, 1000);
    EXPECT_LE(touching, 0.003 * free) << log;
  }
}

}  // namespace
}  // namespace finray
