// finray_benchmark, from the command line.

#include <fstream>
#include <iterator>

#include "apps/command_line.h"
#include "finray/benchmark/benchmark_run.h"

namespace finray {
namespace {

using testing::HasSubstr;

class BenchmarkCommandTest : public CommandLineTest {
 protected:
  std::string Content(const std::string& name) {
    std::ifstream file(folder_.Path(name));
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void Write(const std::string& name, const std::string& content) {
    std::ofstream(folder_.Path(name)) << content;
  }
};

TEST_F(BenchmarkCommandTest, WritesFilesThatCompare) {
  const Outcome measured =
      Run("finray_benchmark",
          "--finger " + paper_ +
              " --quick --rounds 3 --threads 1 --out_dir %out --only "
              "sensing/one_contact/taylor8,sensing/one_contact/default,"
              "estimation/one_contact/default");
  ASSERT_EQ(measured.code, 0) << measured.output;
  EXPECT_THAT(measured.output, HasSubstr("out/benchmark.json\n"));
  EXPECT_THAT(
      measured.output,
      HasSubstr("\ndefault        sensing/one_contact/default/surface"));
  EXPECT_THAT(measured.output,
              HasSubstr("\nnoise          0.0003 rad of the gauges leaves"));
  EXPECT_THAT(measured.output,
              HasSubstr(": at your noise (0.0003 rad) order "));
  EXPECT_THAT(Content("out/benchmark.csv"),
              HasSubstr("\nsensing/one_contact/taylor8x1/surface,"));
  const std::string page = Content("out/report.html");
  EXPECT_THAT(page, HasSubstr("Benchmark of paper_140mm"));
  EXPECT_THAT(page, HasSubstr("<svg"));
  EXPECT_THAT(page, HasSubstr("noise of 0.0003 rad: 0."));
  EXPECT_THAT(page, HasSubstr("At your noise (3.0e\u221204 rad) "));
  EXPECT_THAT(page, testing::Not(HasSubstr("src=\"http")));
  // A run against itself; where noise is large it may be undecided.
  const Outcome same =
      Run("finray_benchmark", "--compare %out,%out/benchmark.json");
  EXPECT_EQ(same.code, 0) << same.output;
  EXPECT_THAT(same.output, HasSubstr("0 faster, 0 slower"));
  EXPECT_THAT(same.output, HasSubstr("gate           pass"));
}

// A file with one setting, whose rounds took about `time_us`.
std::string Json(const std::string& time_us, const std::string& cpu) {
  return "{\"schema_version\": 1, \"tool\": \"finray_benchmark\", \"rounds\": "
         "3, \"date\": \"2020\",\n \"finger\": {\"name\": \"f\", \"sha256\": "
         "\"0\"},\n \"machine\": {\"cpu\": \"" +
         cpu +
         "\", \"instruction_set\": \"AVX2\"},\n \"build\": {\"version\": "
         "\"1\", "
         "\"git\": \"a\", \"compiler\": \"g\", \"flags\": \"O\"},\n "
         "\"settings\": [{\"task\": \"sensing\", \"scene\": \"one_contact\", "
         "\"solver\": \"s\", \"how\": \"alone\", \"words\": \"w\", \"family\": "
         "\"taylor\", \"solved_percent\": 100, \"contact_error_mm\": 1e-6, "
         "\"time_us\": [" +
         time_us + "], \"yardstick_us\": [100, 100, 100]}]}\n";
}

TEST_F(BenchmarkCommandTest, AWorseBuildFailsTheGate) {
  Write("a.json", Json("10, 10.1, 9.9", "x"));
  Write("b.json", Json("13, 13.1, 12.9", "x"));
  const Outcome slower = Run("finray_benchmark", "--compare %a.json,%b.json");
  EXPECT_EQ(slower.code, 4) << slower.output;
  EXPECT_THAT(slower.output, HasSubstr("slower\n"));
  EXPECT_EQ(Run("finray_benchmark",
                "--compare %a.json,%b.json --most_slowdown_percent 50")
                .code,
            0);
  const Outcome faster = Run("finray_benchmark", "--compare %b.json,%a.json");
  EXPECT_EQ(faster.code, 0);
  EXPECT_THAT(faster.output, HasSubstr("faster\n"));
  Write("c.json", Json("10, 10.1, 9.9", "y"));
  EXPECT_THAT(Run("finray_benchmark", "--compare %a.json,%c.json").output,
              HasSubstr("the runs differ in machine: x against y"));
}

// Other programs, which share no code with finray: each that is installed finds
// the same equilibria, to what its own model leaves.
TEST_F(BenchmarkCommandTest, SlowPeersAgree) {
  const Outcome measured =
      Run("finray_benchmark",
          "--finger " + paper_ +
              " --quick --rounds 1 --threads 1 --report=false --peers auto "
              "--out_dir %out --only sensing/one_contact/default");
  ASSERT_EQ(measured.code, 0) << measured.output;
  for (const Measurement& m : ReadBenchmark(folder_.Path("out")).settings) {
    if (m.name.how != "peer") continue;
    SCOPED_TRACE(m.name.id());
    EXPECT_EQ(m.solved_percent, 100);
    // An exact beam, solids, or 40 links.
    const bool exact = m.family == "getfem", solids = m.family == "calculix";
    EXPECT_LT(m.errors.gauges_rad, exact ? 1e-6 : solids ? 2e-5 : 3e-3);
    EXPECT_LT(m.errors.tip_mm, exact ? 1e-4 : solids ? 3e-3 : 3e-2);
    if (m.name.task == "sensing") {
      EXPECT_LT(m.errors.contact_mm, exact ? 1e-3 : 1);
      EXPECT_LT(m.errors.normal_percent, exact ? 1e-2 : 3);
    }
  }
}

TEST_F(BenchmarkCommandTest, BadInput) {
  const std::string finger = "--finger " + paper_;
  ExpectBadInput("finray_benchmark", "--finger %none.yaml --out_dir %out",
                 "none.yaml");
  ExpectBadInput("finray_benchmark", finger + " --out_dir %out --peers scypi",
                 "did you mean 'scipy'?");
  ExpectBadInput("finray_benchmark", finger + " --out_dir %out --only nothing",
                 "no setting's id contains 'nothing'");
  Write("bad.json", "{\"tool\": \"finray_benchmark\", \"schema_version\": 2}");
  ExpectBadInput("finray_benchmark", "--compare %bad.json,%bad.json",
                 "bad.json:1:48: schema_version: expected 1");
  EXPECT_EQ(Run("finray_benchmark", finger).code, 1);
  EXPECT_EQ(Run("finray_benchmark", "--compare %bad.json").code, 1);
}

}  // namespace
}  // namespace finray
