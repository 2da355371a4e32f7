#include "finray/benchmark/benchmark_run.h"

#include <gmock/gmock.h>

#include "benchmark/made_run.h"
#include "finray/io/atomic_file.h"
#include "finray/io/error.h"
#include "temp_file.h"

namespace finray {
namespace {

using testing::HasSubstr;

TEST(BenchmarkFilesTest, ReadsBackWhatItWrites) {
  BenchmarkRun run = MadeRun(10, 0.1, 1);
  run.quick = true;
  run.finger = {{"name", "a \"finger\" \\ with signs"}};
  run.settings[0].errors.normal_N = std::nan("");
  TempFolder folder;
  WriteFileAtomically(folder.Path("benchmark.json"), BenchmarkJson(run));
  const BenchmarkRun read = ReadBenchmark(folder.Path(""));
  EXPECT_TRUE(read.quick);
  EXPECT_EQ(read.rounds, 25);
  EXPECT_EQ(read.finger, run.finger);
  EXPECT_EQ(read.machine.at("cpu"), "a CPU");
  EXPECT_EQ(read.build.at("flags"), "RELEASE: -O3");
  ASSERT_EQ(read.settings.size(), 1u);
  const Measurement &a = run.settings[0], &b = read.settings[0];
  EXPECT_EQ(b.name.id(), "sensing/one_contact/taylor8x1/alone");
  EXPECT_EQ(b.words, a.words);
  EXPECT_EQ(b.time_us, a.time_us);  // to the last bit
  EXPECT_EQ(b.yardstick_us, a.yardstick_us);
  EXPECT_EQ(b.errors.contact_mm, a.errors.contact_mm);
  EXPECT_TRUE(std::isnan(b.errors.normal_N));
  EXPECT_EQ(b.solved_percent, 100);
}

TEST(BenchmarkFilesTest, CsvHasARowASetting) {
  BenchmarkRun run = MadeRun(10, 0, 1);
  run.settings.push_back(MadeSetting("slow", 1000, 0, 2));
  const std::string csv = BenchmarkCsv(run);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_THAT(csv, HasSubstr("\nsensing/one_contact/taylor8x1/alone,sensing,"
                             "one_contact,taylor8x1,alone,\"words, "
                             "\"\"quoted\"\"\","));
  // The first is on the front, the second, slower and as accurate, is not.
  EXPECT_THAT(csv, HasSubstr(",1\nsensing/one_contact/slow"));
  EXPECT_THAT(csv, testing::EndsWith(",0\n"));
}

TEST(BenchmarkFilesTest, BadFilesAreNamedWithTheirPlace) {
  TempFolder folder;
  const std::string path = folder.Path("benchmark.json");
  const auto message = [&](const std::string& content) -> std::string {
    WriteFileAtomically(path, content);
    try {
      ReadBenchmark(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message("{}"), HasSubstr("tool"));
  EXPECT_THAT(message("{\"tool\": \"other\"}"),
              HasSubstr("benchmark.json:1:10"));
  std::string json = BenchmarkJson(MadeRun(10, 0, 1));
  const auto at = json.find("\"yardstick_us\": [");
  json.insert(at + 17, "1, ");
  EXPECT_THAT(message(json), HasSubstr("expected as many numbers"));
  EXPECT_THROW(ReadBenchmark(folder.Path("none.json")), InputError);
}

}  // namespace
}  // namespace finray
