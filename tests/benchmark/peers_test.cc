#include "finray/benchmark/peers.h"

#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include "finray/io/error.h"
#include "test_finger.h"

namespace finray {
namespace {

using testing::ElementsAre;

TEST(PeersTest, NamesOfPeers) {
  EXPECT_TRUE(ParsePeers("none").empty());
  EXPECT_THAT(ParsePeers("auto"),
              ElementsAre("scipy", "octave", "calculix", "getfem", "mujoco"));
  EXPECT_THAT(ParsePeers("calculix,scipy"), ElementsAre("calculix", "scipy"));
  try {
    ParsePeers("scypi");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'scipy'?"));
  }
}

TEST(PeersTest, TheJobHasFingerLoadsAndReadings) {
  const Finger finger = PaperFinger();
  const std::vector<BenchmarkCase> cases = {
      MakeBenchmarkCase(finger, "one_contact", 2),
      MakeBenchmarkCase(finger, "friction", 2)};
  const YAML::Node job = YAML::Load(PeerJob(finger, cases, true));
  EXPECT_EQ(job["finger"]["ribs"].size(), 5u);
  ASSERT_EQ(job["scenes"].size(), 2u);
  const YAML::Node frame = job["scenes"][1]["frames"][1];
  const int index = cases[1].LeadIn(1, 2) + 1;
  EXPECT_EQ(frame["contact_mm"].as<double>(),
            cases[1].frames[index].contacts[0].arc_mm);
  EXPECT_EQ(frame["friction"].as<double>(), 0.3);
  EXPECT_EQ(frame["measured_rad"].size(), 4u);
  EquilibriumSolver solver(finger, {});
  ASSERT_TRUE(solver.Solve(cases[1].frames[index].contacts));
  EXPECT_NEAR(frame["contact_angle_rad"].as<double>(),
              solver.contact_pose(0)[2], 1e-9);
}

}  // namespace
}  // namespace finray
