// How labs write the same log, and that it reads back the same.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "finray/io/error.h"
#include "finray/io/frame_table.h"
#include "finray/io/log_lines.h"
#include "finray/io/number_text.h"
#include "temp_file.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

struct Dialect {
  char delimiter;
  char decimal;
  bool units, preamble, bom, crlf;
  std::string missing;
};

const std::vector<std::string> kNames = {"time_s", "gauge_1_V", "force_N",
                                         "object_x_mm", "note"};
const std::vector<std::string> kHeaders = {"t", "U1", "Fz [N]", "stage",
                                           "note"};
constexpr char kColumns[] =
    "columns: {t: time_s, U1: gauge_1_V, \"Fz [N]\": force_N, "
    "stage: object_x_mm}\n";

std::string Joined(const std::vector<std::string>& cells,
                   const Dialect& dialect) {
  std::string line;
  for (const std::string& cell : cells) {
    if (&cell != &cells.front()) line += dialect.delimiter;
    line +=
        cell.find(dialect.delimiter) == cell.npos ? cell : "\"" + cell + "\"";
  }
  return line + (dialect.crlf ? "\r\n" : "\n");
}

std::string NumberIn(double value, const Dialect& dialect) {
  if (std::isnan(value)) return dialect.missing;
  std::string text = NumberText(value);
  std::replace(text.begin(), text.end(), '.', dialect.decimal);
  return text;
}

using Rows = std::vector<std::vector<double>>;

// Numbers of all kinds that logs hold, and some that they do not.
Rows RandomRows(std::mt19937* random, std::size_t rows) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto number = [&]() -> double {
    switch ((*random)() % 6) {
      case 0:
        return std::round(1e4 * uniform(*random));
      case 1:
        return std::round(1e4 * uniform(*random)) / 1000;
      case 2:
        return std::ldexp(uniform(*random), (*random)() % 30);
      case 3:
        return std::ldexp(uniform(*random),
                          -static_cast<int>((*random)() % 200));
      case 4:
        return std::nan("");
      default:
        return uniform(*random);
    }
  };
  Rows table(rows, std::vector<double>(4));
  for (auto& row : table) std::generate(row.begin(), row.end(), number);
  table[0] = {0, 0.5, 0.25, -0.125};  // shows the decimal mark
  return table;
}

std::string LogText(const Rows& rows, const std::vector<std::string>& headers,
                    const Dialect& dialect) {
  std::string text = dialect.bom ? "\xEF\xBB\xBF" : "";
  if (dialect.preamble) {
    const std::string end = dialect.crlf ? "\r\n" : "\n";
    text += "Logger 7, channels: 3" + end + "Start;24.11.2026 10:00" + end +
            end + "Rate\t200 Hz" + end;
  }
  text += Joined(headers, dialect);
  if (dialect.units) text += Joined({"s", "[V]", "N", "mm", ""}, dialect);
  for (const auto& row : rows) {
    std::vector<std::string> cells;
    for (const double value : row) cells.push_back(NumberIn(value, dialect));
    cells.push_back("1,5; \t2.5");
    text += Joined(cells, dialect);
  }
  return text;
}

void ExpectSame(const FrameTable& table, const Rows& rows) {
  ASSERT_EQ(table.rows(), rows.size());
  for (std::size_t column = 0; column < 4; ++column) {
    const std::vector<double>& numbers = table.Numbers(kNames[column]);
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const double expected = rows[row][column];
      if (std::isnan(expected)) {
        EXPECT_TRUE(std::isnan(numbers[row]));
      } else {
        EXPECT_EQ(numbers[row], expected);
      }
    }
  }
}

std::vector<Dialect> AllDialects() {
  std::vector<Dialect> dialects;
  for (int bits = 0; bits < 32; ++bits) {
    for (const char delimiter : {',', ';', '\t'}) {
      for (const char* missing :
           {"", "NA", "N/A", "NaN", "nan", "-nan", "null", "NULL", "-", "--",
            "---", "?", "#N/A", "#NV", "None", "missing"}) {
        dialects.push_back({delimiter, bits & 1 ? ',' : '.', (bits & 2) != 0,
                            (bits & 4) != 0, (bits & 8) != 0, (bits & 16) != 0,
                            missing});
      }
    }
  }
  return dialects;
}

class LogDialectTest : public testing::Test {
 protected:
  ColumnMapping Mapping(const std::string& yaml) {
    return ReadColumnMapping(YamlMap::FromFile(folder_.Write("m.yaml", yaml)));
  }
  FrameTable Load(const std::string& text, const std::string& yaml = "") {
    return FrameTable::Read(folder_.Write("log.csv", text),
                            yaml.empty() ? ColumnMapping() : Mapping(yaml));
  }
  double Only(const std::string& cell, const std::string& rule,
              const std::string& column) {
    return Load("x;note\n" + cell + ";\n", "columns: {x: " + rule + "}\n")
        .Numbers(column)[0];
  }
  TempFolder folder_;
};

#define EXPECT_REFUSED(statement, text) \
  EXPECT_THAT([&] { statement; }, ThrowsMessage<InputError>(HasSubstr(text)))

TEST_F(LogDialectTest, ARandomLogReadsBackFromEveryDialect) {
  std::mt19937 random(7);
  for (const Dialect& dialect : AllDialects()) {
    SCOPED_TRACE(std::string("delimiter ") + dialect.delimiter + " decimal " +
                 dialect.decimal + " missing '" + dialect.missing + "' flags " +
                 std::to_string(dialect.units) +
                 std::to_string(dialect.preamble) +
                 std::to_string(dialect.bom) + std::to_string(dialect.crlf));
    const Rows rows = RandomRows(&random, 20);
    // With commas between cells decimal commas are stated, all else is found.
    const bool stated = dialect.delimiter == ',' && dialect.decimal == ',';
    const std::string decimal = stated ? "decimal: \",\"\n" : "";
    ExpectSame(Load(LogText(rows, kHeaders, dialect), kColumns + decimal),
               rows);
    ExpectSame(Load(LogText(rows, kNames, dialect), decimal), rows);
    if (HasFailure()) return;
  }
}

TEST_F(LogDialectTest, ALiveLogReadsTheSameRowByRow) {
  std::mt19937 random(3);
  for (const Dialect& dialect : AllDialects()) {
    if (dialect.delimiter == ',' && dialect.decimal == ',') continue;
    const Rows rows = RandomRows(&random, 5);
    const std::string text = LogText(rows, kHeaders, dialect);
    std::size_t given = 0;
    const auto a_line = [&](char* buffer, int) {
      const std::size_t end = std::min(text.find('\n', given), text.size() - 1);
      const std::size_t size = end + 1 - given;
      std::copy_n(text.data() + given, size, buffer);
      given += size;
      return static_cast<int>(size);
    };
    LogLines lines(LineReader(a_line, "stdin"), "stdin", Mapping(kColumns));
    FrameRows cells;
    for (const auto& row : rows) {
      ASSERT_TRUE(lines.Next());
      // No line is read before it is needed.
      EXPECT_EQ(std::count(text.begin(),
                           text.begin() + static_cast<long>(given), '\n'),
                lines.line().number);
      cells.Clear();
      lines.parser().Parse(lines.line(), &cells);
      for (std::size_t i = 0; i < row.size(); ++i) {
        EXPECT_TRUE(cells.at(0, i).number == row[i] || std::isnan(row[i]));
      }
    }
    EXPECT_FALSE(lines.Next());
    if (HasFailure()) return;
  }
}

TEST_F(LogDialectTest, UnitsScaleAndOffset) {
  EXPECT_EQ(Only("12.3", "{to: gauge_1_V, unit: mV}", "gauge_1_V"), 0.0123);
  EXPECT_EQ(Only("250", "{to: force_N, unit: gf}", "force_N"),
            250 * 9.80665 / 1000);
  EXPECT_EQ(Only("2", "{to: force_N, unit: kgf}", "force_N"), 2 * 9.80665);
  EXPECT_DOUBLE_EQ(Only("1", "{to: force_N, unit: lbf}", "force_N"),
                   4.4482216152605);
  EXPECT_EQ(Only("0.123", "{to: object_x_mm, unit: m}", "object_x_mm"), 123);
  EXPECT_EQ(Only("2", "{to: object_x_mm, unit: inch}", "object_x_mm"), 50.8);
  EXPECT_EQ(Only("-0.1", "{to: object_x_mm, scale: -1000, offset: 150}",
                 "object_x_mm"),
            250);
  // The unit is converted first.
  EXPECT_EQ(Only("0.1", "{to: object_x_mm, unit: m, scale: -1, offset: 150}",
                 "object_x_mm"),
            50);
  EXPECT_DOUBLE_EQ(
      Only("180", "{to: tip_angle_rad, unit: deg}", "tip_angle_rad"), M_PI);
  EXPECT_DOUBLE_EQ(
      Only("0.5", "{to: object_angle_deg, unit: rad}", "object_angle_deg"),
      90 / M_PI);
  EXPECT_EQ(
      Only("12.5", "{to: object_angle_deg, unit: deg}", "object_angle_deg"),
      12.5);
  EXPECT_EQ(Only("1250", "{to: time_s, unit: ms}", "time_s"), 1.25);
  EXPECT_NEAR(Only("300", "{to: temperature_C, unit: K}", "temperature_C"),
              26.85, 1e-12);
  EXPECT_DOUBLE_EQ(
      Only("68", "{to: temperature_C, unit: degF}", "temperature_C"), 20);
}

TEST_F(LogDialectTest, CountsOfAConverter) {
  const std::string twelve =
      "{to: gauge_1_V, unit: {adc_bits: 12, range_V: [0, 3.3]}}";
  EXPECT_EQ(Only("0", twelve, "gauge_1_V"), 0);
  EXPECT_EQ(Only("2048", twelve, "gauge_1_V"), 1.65);
  EXPECT_EQ(Only("4095", twelve, "gauge_1_V"), 3.3 * 4095 / 4096);
  EXPECT_REFUSED(Only("4096", twelve, "gauge_1_V"),
                 "log.csv:2:1: gauge_1_V: expected counts of 12 bits, 0 to "
                 "4095, found '4096'");
  const std::string two_s =
      "{to: gauge_1_V, unit: {adc_bits: 16, range_V: [-4.096, 4.096], signed: "
      "true}}";
  EXPECT_EQ(Only("0", two_s, "gauge_1_V"), 0);
  EXPECT_EQ(Only("-32768", two_s, "gauge_1_V"), -4.096);
  EXPECT_EQ(Only("8000", two_s, "gauge_1_V"), 1);
}

TEST_F(LogDialectTest, TimesOfADayAndAZone) {
  const std::string iso = "{to: time_s, format: iso8601}";
  EXPECT_EQ(Only("1970-01-01T00:00:00Z", iso, "time_s"), 0);
  EXPECT_EQ(Only("2000-02-29 12:30:15.25", iso, "time_s"), 951827415.25);
  EXPECT_EQ(Only("2026-11-24T10:30:15,5+01:00", iso, "time_s"), 1795512615.5);
  EXPECT_EQ(Only("2026-11-24T10:30:15.5-0530", iso, "time_s"), 1795536015.5);
  EXPECT_EQ(Only("1969-12-31T23:59:59.75Z", iso, "time_s"), -0.25);
  for (const char* bad :
       {"2026-02-29T10:00:00Z", "2026-13-01T10:00Z", "24.11.2026 10:00",
        "2026-11-24", "2026-11-24T10:00:00.Z", "2026-11-24T10:00:00+1", "7"}) {
    EXPECT_REFUSED(Only(bad, iso, "time_s"),
                   "log.csv:2:1: time_s: expected a time such as");
  }
  const std::string epoch_ms = "{to: time_s, format: epoch, unit: ms}";
  EXPECT_EQ(Only("1795512615250", epoch_ms, "time_s"), 1795512615.25);
  EXPECT_EQ(Only("1795512615250", "{to: time_s, unit: epoch_ms}", "time_s"),
            1795512615.25);
  EXPECT_REFUSED(Only("1795512615", epoch_ms, "time_s"),
                 "expected a time since 1970 in ms");
}

TEST_F(LogDialectTest, TheUnitsOfTheLogAreConvertedOrContradictTheMapping) {
  const std::string log = "t,F\nms,mN\n1500,250\n";
  const FrameTable table = Load(log, "columns: {t: time_s, F: force_N}\n");
  EXPECT_EQ(table.Numbers("time_s")[0], 1.5);
  EXPECT_EQ(table.Numbers("force_N")[0], 0.25);
  EXPECT_EQ(table.line(0), 3);
  // A scale speaks of the cell as it is written.
  EXPECT_EQ(Load(log, "columns: {t: time_s, F: {to: force_N, scale: 2}}\n")
                .Numbers("force_N")[0],
            500);
  EXPECT_REFUSED(Load(log, "columns: {t: time_s, F: {to: force_N, unit: N}}\n"),
                 "log.csv:2:2: force_N: the log gives it in mN, its name or "
                 "mapping in N");
  EXPECT_REFUSED(
      Load(log, "columns: {t: time_s, F: {to: force_N, unit: N, scale: -1}}\n"),
      "the log gives it in mN, its name or mapping in N");
  EXPECT_REFUSED(Load("time_s,force_N\ns,mN\n0,1\n"),
                 "log.csv:2:2: force_N: the log gives it in mN, its name");
  EXPECT_REFUSED(Load(log, "columns: {t: force_N, F: time_s}\n"),
                 "log.csv:2:1: force_N: the log gives it in ms, expected one "
                 "of N, mN, kN, gf");
  EXPECT_REFUSED(
      Load("t,F\nms,Newton\n0,1\n", "columns: {t: time_s, F: force_N}\n"),
      "log.csv:2:2: force_N: expected a unit as in the other columns");
  EXPECT_EQ(Load("t;Fz [mN]\n0;250\n", "columns: {\"Fz [mN]\": force_N}\n")
                .Numbers("force_N")[0],
            0.25);
  EXPECT_EQ(Load("t;Fz [kg]\n0;2\n", "columns: {\"Fz [kg]\": force_N}\n")
                .Numbers("force_N")[0],
            2 * 9.80665);
  // A torque is no force, unless a lever arm says so.
  EXPECT_REFUSED(Load("t,T\ns,Nm\n0,1\n", "columns: {t: time_s, T: force_N}\n"),
                 "log.csv:2:2: force_N: the log gives it in Nm, expected one "
                 "of N, mN, kN, gf");
  EXPECT_REFUSED(Load("t;T [N m]\n0;1\n", "columns: {\"T [N m]\": force_N}\n"),
                 "the log gives it in Nm, expected one of N, mN, kN, gf");
  EXPECT_EQ(Load("t,T\ns,Nm\n0,3\n",
                 "columns: {t: time_s, T: {to: force_N, scale: 20}}\n")
                .Numbers("force_N")[0],
            60);
  EXPECT_REFUSED(
      Load(log, "columns: {t: time_s, F: force_N}\nunits_row: false\n"),
      "log.csv:2:1: time_s: expected a number, found 'ms'");
  EXPECT_REFUSED(Load("time_s,force_N\n0,1\n", "units_row: true\n"),
                 "log.csv:2:1: time_s: expected a unit, found '0'");
}

TEST_F(LogDialectTest, NothingIsGuessedThatMayBeTwoThings) {
  // One comma with three digits behind it may separate thousands.
  EXPECT_REFUSED(
      Load("time_s;force_N\n0;1,234\n1;2,345\n"),
      "log.csv:2:2: force_N: expected a number, found '1,234', which "
      "may stand for two numbers; a decimal comma is stated by "
      "decimal: \",\"");
  EXPECT_EQ(Load("time_s;force_N\n0;1,234\n", "decimal: \",\"\n")
                .Numbers("force_N")[0],
            1.234);
  EXPECT_EQ(Load("time_s;force_N\n0;1,234\n1;0,5\n").Numbers("force_N")[0],
            1.234);
  EXPECT_REFUSED(
      Load("time_s,force_N\n0,1,234\n"),
      "log.csv:2: expected 2 cells as in the header, found 3; another "
      "delimiter");
  EXPECT_REFUSED(Load("time_s,force_N\n0,\"1,5\"\n"),
                 "log.csv:2:2: force_N: expected a number, found '1,5'; a "
                 "decimal comma is stated");
  // Both marks: the first one counts, and the other one is refused.
  EXPECT_REFUSED(
      Load("time_s;force_N\n0;1,5\n1;2.5\n"),
      "log.csv:3:2: force_N: expected a number with a decimal comma, "
      "found '2.5'");
  EXPECT_REFUSED(Load("time_s;force_N\n0;1.5\n1;2,5\n"),
                 "log.csv:3:2: force_N: expected a number, found '2,5'; a");
  EXPECT_REFUSED(Load("time_s;force_N\n0;1.234,5\n"), "found '1.234,5'");
  EXPECT_REFUSED(
      Load("force_N;x,time_s\n0;1,2\n"),
      "log.csv:1: the header 'force_N;x,time_s' holds more than one");
  EXPECT_EQ(Load("force_N;x,time_s\n0;1,2\n", "delimiter: \";\"\n").rows(), 1u);
}

TEST_F(LogDialectTest, StatedLinesAndWords) {
  EXPECT_EQ(Load("force_N\n\na;b\nforce_N;time_s\n1;2\n", "header_line: 4\n")
                .Numbers("time_s")[0],
            2);
  EXPECT_REFUSED(Load("force_N\n\n1\n", "header_line: 2\n"),
                 "log.csv:2: expected the header, as header_line says");
  const FrameTable table =
      Load("force_N,time_s\n-9999,1\n2,OFF\n", "not_measured: [-9999, OFF]\n");
  EXPECT_TRUE(std::isnan(table.Numbers("force_N")[0]));
  EXPECT_TRUE(std::isnan(table.Numbers("time_s")[1]));
  EXPECT_EQ(table.Numbers("force_N")[1], 2);
  // Rows of empty cells between tabs are rows.
  EXPECT_EQ(Load("force_N\ttime_s\n\t\n1\t2\n").rows(), 2u);
}

TEST_F(LogDialectTest, ASharedMappingFile) {
  std::filesystem::create_directory(folder_.Path("lab"));
  folder_.Write("lab/columns.yaml",
                "columns: {U: {to: gauge_1_V, unit: mV}}\ndelimiter: \";\"\n");
  const ColumnMapping mapping = Mapping("columns: lab/columns.yaml\n");
  EXPECT_EQ(mapping.path, folder_.Path("lab/columns.yaml"));
  EXPECT_EQ(mapping.delimiter, ';');
  EXPECT_EQ(FrameTable::Read(folder_.Write("log.csv", "U;a,b\n5;1\n"), mapping)
                .Numbers("gauge_1_V")[0],
            0.005);
  // What stands beside it counts.
  EXPECT_EQ(Mapping("columns: lab/columns.yaml\ndelimiter: tab\n").delimiter,
            '\t');
  folder_.Write("lab/columns.yaml", "columns: other.yaml\n");
  EXPECT_REFUSED(Mapping("columns: lab/columns.yaml\n"),
                 "columns.yaml:1:10: columns: expected a mapping");
  EXPECT_REFUSED(Mapping("columns: none.yaml\n"), "none.yaml");
}

TEST_F(LogDialectTest, MappingsThatAreWrongNameThePlace) {
  const auto refused = [&](const std::string& rule, const std::string& text) {
    EXPECT_REFUSED(Mapping("columns:\n  x: " + rule + "\n"), text);
  };
  refused(
      "{to: force_N, unit: mV}",
      "m.yaml:2:26: unit: column 'force_N' takes one of N, mN, kN, gf, kgf, "
      "lbf, found 'mV'");
  refused("{to: gauge_1_V, unit: Volt}", "counts {adc_bits, range_V}, found");
  refused("{to: force_N, unit: {adc_bits: 12, range_V: [0, 3]}}",
          "takes one of N, mN, kN, gf, kgf, lbf, found counts");
  refused("{to: iterations, unit: s}", "column 'iterations' has no unit");
  refused("{to: fource_N}", "no known column (did you mean 'force_N'?)");
  refused("fource_N",
          "m.yaml:2:6: columns: 'x' is to become 'fource_N', which");
  refused("{to: force_N, scael: 2}", "unknown key 'scael'");
  refused("{to: force_N, scale: 0}", "scale: expected another than 0");
  refused("{to: force_N, format: epoch}", "format: it is for time_s");
  refused("{to: time_s, format: iso}", "expected one of iso8601, epoch");
  refused("{to: time_s, format: iso8601, unit: s}",
          "a time of iso8601 has none");
  refused("{to: gauge_1_V, unit: {adc_bits: 0, range_V: [0, 1]}}", "1 to 32");
  refused("{to: gauge_1_V, unit: {adc_bits: 8, range_V: [1, 0]}}",
          "[from, to]");
  refused("{scale: 2}", "'to' is missing");
  EXPECT_REFUSED(Mapping("delimiter: \"|\"\n"), "delimiter: expected");
  EXPECT_REFUSED(Mapping("decimal: x\n"), "decimal: expected one of ., ,");
}

}  // namespace
}  // namespace finray
