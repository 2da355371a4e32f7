#include "finray/io/frame_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "finray/io/error.h"
#include "finray/io/frame_vocabulary.h"
#include "renaming.h"
#include "temp_file.h"

namespace finray {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

class FrameTableTest : public testing::Test {
 protected:
  FrameTable Load(const std::string& text) {
    return FrameTable::Read(folder_.Write("log.csv", text));
  }
  TempFolder folder_;
};

#define EXPECT_INPUT_ERROR(expression, text) \
  EXPECT_THAT([&] { expression; }, ThrowsMessage<InputError>(HasSubstr(text)))

TEST_F(FrameTableTest, ReadsNumbersTextAndGaps) {
  const FrameTable table = Load(
      "\xEF\xBB\xBF# a comment\r\ntime_s, gauge_1_V ,note\r\n"
      "0,+1.5e-3,\"a, \"\"b\"\"\"\r\n\r\n1,,plain\r\n2,NaN,\r\n");
  EXPECT_EQ(table.rows(), 3u);
  EXPECT_THAT(table.headers(), ElementsAre("time_s", "gauge_1_V", "note"));
  EXPECT_EQ(table.Numbers("gauge_1_V")[0], 1.5e-3);
  EXPECT_TRUE(std::isnan(table.Numbers("gauge_1_V")[1]));
  EXPECT_TRUE(std::isnan(table.Numbers("gauge_1_V")[2]));
  FrameTable copy = table;
  EXPECT_EQ(copy.MutableText("note")[0], "a, \"b\"");
  EXPECT_EQ(table.line(1), 5);
}

TEST_F(FrameTableTest, DoublesReadBackIdentical) {
  std::mt19937_64 generator(3);
  FrameTable table(2000);
  for (double& value : table.MutableNumbers("gauge_1_V")) {
    do {
      const std::uint64_t bits = generator();
      std::memcpy(&value, &bits, sizeof value);
    } while (!std::isfinite(value));
  }
  table.MutableNumbers("chi2")[7] = 5e-324;
  for (const char* name : {"a.csv", "a.csv.gz"}) {
    table.Write(folder_.Path(name));
    const FrameTable back = FrameTable::Read(folder_.Path(name));
    EXPECT_EQ(back.Numbers("gauge_1_V"), table.Numbers("gauge_1_V"));
    EXPECT_EQ(back.Numbers("chi2")[7], 5e-324);
    EXPECT_TRUE(std::isnan(back.Numbers("chi2")[0]));
  }
  EXPECT_EQ(folder_.Read("a.csv.gz").substr(0, 2), "\x1f\x8b");
}

TEST_F(FrameTableTest, TextSurvivesAWrite) {
  const FrameTable table =
      Load("status,x y\nok,\"a,b\"\nbad,\"c \"\"d\"\"\"\n");
  EXPECT_EQ(table.ToCsv(), "status,x y\nok,\"a,b\"\nbad,\"c \"\"d\"\"\"\n");
}

TEST_F(FrameTableTest, APlaneSurvivesAWrite) {
  FrameTable table(2);
  const double plane = std::numeric_limits<double>::infinity();
  table.MutableNumbers("cylinder_radius_mm") = {plane, 80};
  table.MutableNumbers("force_N") = {plane, 1};  // could not be read
  EXPECT_EQ(table.ToCsv(), "cylinder_radius_mm,force_N\ninf,\n80,1\n");
  table.Write(folder_.Path("a.csv"));
  EXPECT_EQ(
      FrameTable::Read(folder_.Path("a.csv")).Numbers("cylinder_radius_mm")[0],
      plane);
}

TEST_F(FrameTableTest, Vocabulary) {
  for (const char* name : {"time_s", "gauge_12_V", "contact_1_std_mm",
                           "friction_2", "rib_5_N", "iterations"}) {
    EXPECT_TRUE(IsFrameColumn(name)) << name;
  }
  for (const char* name : {"gauge_0_V", "gauge_01_V", "gauge__V", "gauge_1",
                           "status", "Force_N", "rib_x_N"}) {
    EXPECT_FALSE(IsFrameColumn(name)) << name;
  }
}

TEST_F(FrameTableTest, RenamesALabsHeaders) {
  const std::string path = folder_.Write("log.csv", "Fz [N],U1\n2,3\n");
  ColumnMapping mapping = Renaming("Fz [N]", "force_N");
  mapping.AddMissing(Renaming("U1", "gauge_1_V"));
  const FrameTable table = FrameTable::Read(path, mapping);
  EXPECT_EQ(table.Numbers("force_N")[0], 2);
  EXPECT_EQ(table.Numbers("gauge_1_V")[0], 3);
  EXPECT_INPUT_ERROR(FrameTable::Read(path, Renaming("Fz[N]", "force_N")),
                     "no column 'Fz[N]' to rename to 'force_N' (did you mean "
                     "'Fz [N]'?)");
}

TEST_F(FrameTableTest, GaugesMayReadInfinity) {
  const std::string text = "gauge_1_V,gauge_2_rad\n-inf,inf\n1,2\n";
  const FrameTable table = Load(text);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(table.Numbers("gauge_1_V")[0], -infinity);
  EXPECT_EQ(table.Numbers("gauge_2_rad")[0], infinity);
  EXPECT_EQ(table.ToCsv(), text);
  EXPECT_EQ(Load("gauge_1_V\n1e999\n").Numbers("gauge_1_V")[0], infinity);
  EXPECT_EQ(Load("gauge_1_V\nInfinity\n").Numbers("gauge_1_V")[0], infinity);
  EXPECT_INPUT_ERROR(Load("gauge_1_V\n1e-999\n"), "expected a number");
  EXPECT_INPUT_ERROR(Load("gauge_1_V\ninfinite\n"), "expected a number");
}

TEST_F(FrameTableTest, ErrorsNameThePlace) {
  EXPECT_INPUT_ERROR(Load("time_s,force_N\n0,1\n1,2x\n"),
                     "log.csv:3:2: force_N: expected a number, found '2x'");
  EXPECT_INPUT_ERROR(Load("force_N\ninf\n"), "log.csv:2:1: force_N: expected");
  EXPECT_INPUT_ERROR(Load("force_N\n\"1,5\"\n"), "found '1,5'");
  EXPECT_INPUT_ERROR(Load("a,b\n1\n"),
                     "log.csv:2: expected 2 cells as in the header, found 1");
  EXPECT_INPUT_ERROR(Load("force_N,force_N\n1,1\n"),
                     "log.csv:1:2: header 'force_N' appears twice");
  EXPECT_INPUT_ERROR(Load("a\n\"b\n"), "quoted cell does not end");
  EXPECT_INPUT_ERROR(Load("gauge1_V\n1\n").Numbers("gauge_1_V"),
                     "log.csv: no column 'gauge_1_V' (did you mean "
                     "'gauge1_V'?)");
}

TEST_F(FrameTableTest, FilesThatAreNoTable) {
  EXPECT_INPUT_ERROR(Load(""), "is empty");
  EXPECT_INPUT_ERROR(Load("force_N\n"), "has a header but no rows");
  EXPECT_INPUT_ERROR(Load(std::string("force_N\n1\0\n", 11)), "NUL");
  EXPECT_INPUT_ERROR(Load("# comment\nforce_N,\x1f\x8b\n1,2\n"),
                     "log.csv:2:2: the header ' ?' holds a control character");
  EXPECT_INPUT_ERROR(Load("force_N\x7f\n1\n"), "holds a control character");
  EXPECT_INPUT_ERROR(Load("time_s,force_N\r0,1\r"),
                     "log.csv:1:2: the header 'force_N 0' holds a carriage "
                     "return");
  EXPECT_EQ(Load("a\tb,force_N\n1,2\n").rows(), 1u);
  EXPECT_INPUT_ERROR(FrameTable::Read(folder_.Path("none.csv")),
                     "none.csv: cannot be read: No such file");
  EXPECT_INPUT_ERROR(FrameTable::Read(folder_.Path("")), "is a folder");
  EXPECT_INPUT_ERROR(Load("force_N\n" + std::string(1 << 25, '1') + "\n"),
                     "too long");
  FrameTable table(100);
  table.MutableNumbers("force_N").assign(100, 1.25);
  table.Write(folder_.Path("b.csv.gz"));
  const std::string zipped = folder_.Read("b.csv.gz");
  folder_.Write("cut.csv.gz", zipped.substr(0, zipped.size() / 2));
  EXPECT_INPUT_ERROR(FrameTable::Read(folder_.Path("cut.csv.gz")),
                     "cannot be read to its end");
}

}  // namespace
}  // namespace finray
