#include "finray/batch/result_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "finray/io/error.h"
#include "test_finger.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

FrameParser Log(const std::string& header) {
  return FrameParser("a.csv", {header, 1, false}, {});
}

// A row of the result of a line.
std::string Row(const FrameParser& log, const Scene& scene,
                const std::string& line, const FrameEstimate& estimate) {
  const ResultLayout layout(PaperFinger(), scene, log);
  FrameRows rows;
  log.Parse({line, 2, false}, &rows);
  Measurements readings;
  layout.Read(rows, 0, &readings);
  std::string csv;
  std::vector<double> values;
  layout.Append(rows, 0, readings, estimate, &values, &csv);
  return csv;
}

FrameEstimate Estimate() {
  FrameEstimate estimate;
  estimate.status = FrameStatus::kOk;
  estimate.contacts = 1;
  estimate.contact[0].arc_mm = 50.25;
  estimate.contact[0].arc_std_mm = std::numeric_limits<double>::infinity();
  estimate.contact[0].normal_N = 1.0 / 3;
  estimate.rib_tension_N = {1, 2, 3, 4, 5};
  estimate.chi2 = 2;
  estimate.dof = 2;
  return estimate;
}

TEST(ResultRowsTest, WritesTheColumnsAndDigitsThatAreAskedFor) {
  const FrameParser log =
      Log("time_s,gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V,note");
  const auto row = [&](const ResultFormat& format) {
    const ResultLayout layout(PaperFinger(), {}, log, format);
    FrameRows rows;
    log.Parse({"0.10,1,2,3,4,a", 2, false}, &rows);
    Measurements readings;
    layout.Read(rows, 0, &readings);
    std::string csv = layout.HeaderCsv();
    std::vector<double> values;
    layout.Append(rows, 0, readings, Estimate(), &values, &csv);
    return csv;
  };
  EXPECT_EQ(row({{"status", "contact_1_*mm", "normal_1_N", "time_s"}, 4}),
            "status,contact_1_mm,contact_1_std_mm,contact_1_noise_mm,"
            "contact_1_x_mm,contact_1_y_mm,contact_1_low_mm,contact_1_high_mm,"
            "normal_1_N,time_s\n"
            "ok,50.25,,,,,,,0.3333,0.10\n");
  // A row is never blank.
  EXPECT_EQ(row({{"contact_1_std_mm"}, 0}), "contact_1_std_mm\nnan\n");
  EXPECT_EQ(row({{"note", "note", "n*e"}, 0}), "note\na\n");
  EXPECT_THAT(
      [&] {
        row({{"contact_3_mm"}, 0});
      },
      testing::ThrowsMessage<InputError>(testing::HasSubstr(
          "a.csv: --columns: no column 'contact_3_mm' (did you mean")));
}

TEST(ResultRowsTest, KeepsTheLogAndOverwritesInPlace) {
  const FrameParser log =
      Log("status,normal_1_N,gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V,time_s,"
          "\"a,b\"");
  const ResultLayout layout(PaperFinger(), {}, log);
  EXPECT_THAT(layout.HeaderCsv(),
              StartsWith("status,normal_1_N,gauge_1_V,gauge_2_V,gauge_3_V,"
                         "gauge_4_V,time_s,\"a,b\",contact_1_mm,"));
  const std::string row =
      Row(log, {}, "was,7,+1.50,nan,\" 3\",4e0,,\"c \"\"d\"\"\"", Estimate());
  EXPECT_THAT(row, StartsWith("ok,0.3333333333333333,+1.50,,3,4e0,,"
                              "\"c \"\"d\"\"\",50.25,,,"));
}

TEST(ResultRowsTest, CellsOfAnyLengthStay) {
  const FrameParser log =
      Log("time_s,force_N,gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V,note");
  for (const std::size_t length : {400, 470, 500, 510, 511, 512, 5000}) {
    const std::string digits = "0." + std::string(length, '1');
    const std::string line =
        digits + "," + digits + ",1,2,3,4," + std::string(length, 'a');
    EXPECT_THAT(Row(log, {}, line, Estimate()), StartsWith(line + ",50.25,,"));
  }
}

TEST(ResultRowsTest, ColumnsFollowFromTheScene) {
  const FrameParser log = Log("gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_rad");
  const auto header = [&](std::optional<int> contacts, std::size_t gauges = 4) {
    Finger finger = PaperFinger();
    finger.gauges.resize(gauges);
    Scene scene;
    scene.contacts = contacts;
    return ResultLayout(finger, scene, log).HeaderCsv();
  };
  const std::string one = header(1), two = header(2);
  EXPECT_THAT(one, HasSubstr("tip_angle_rad,chi2,chi2_p_value,iterations,"
                             "alternative_contact_1_mm,alternative_normal_1_N,"
                             "alternative_chi2,status\n"));
  EXPECT_THAT(one, Not(HasSubstr("_2_mm")));
  EXPECT_THAT(two, HasSubstr(",contact_1_angle_rad,contact_1_low_mm,"
                             "contact_1_high_mm,normal_1_low_N,normal_1_high_N,"
                             "contact_2_mm,"
                             "contact_2_std_mm,contact_2_noise_mm,normal_2_N,"
                             "normal_2_std_N,normal_2_noise_N,"
                             "contact_2_x_mm,contact_2_y_mm,"
                             "contact_2_angle_rad,contact_2_low_mm,"
                             "contact_2_high_mm,normal_2_low_N,"
                             "normal_2_high_N,gauge_1_rad,"));
  EXPECT_THAT(two, HasSubstr("alternative_contact_2_mm,alternative_normal_2_N,"
                             "alternative_chi2"));
  EXPECT_EQ(header(std::nullopt), two);
  EXPECT_EQ(header(std::nullopt, 3), header(1, 3));
  Scene measured;
  measured.object_std_mm = 0.1;
  EXPECT_EQ(ResultLayout(PaperFinger(), measured, log).HeaderCsv(), one);
  EXPECT_THAT(header(0), Not(HasSubstr("alternative")));
  EXPECT_THAT(two, Not(HasSubstr("search_ended")));
  Scene limited;
  limited.search_iteration_limit = 50;
  EXPECT_THAT(ResultLayout(PaperFinger(), limited, log).HeaderCsv(),
              HasSubstr("chi2_p_value,iterations,search_ended,alternative_"));
  // All of them read back as numbers.
  const FrameParser back(
      "b.csv", {std::string_view(two).substr(0, two.size() - 1), 1, false}, {});
  for (std::size_t i = 0; i < back.names().size(); ++i) {
    EXPECT_EQ(back.IsNumeric(i), back.names()[i] != "status")
        << back.names()[i];
  }
}

TEST(ResultRowsTest, ValuesStandUnderTheirNames) {
  const FrameParser log = Log("gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V");
  Scene scene;
  scene.contacts = 2;
  scene.friction_coefficient = 0.25;
  FrameEstimate estimate = Estimate();
  estimate.contact[1].arc_mm = 90;
  estimate.contact[1].pose = {1, 2, 3};
  estimate.contact[1].arc_low_mm = 80;
  estimate.contact[1].normal_high_N = 9;
  estimate.alternative[1].normal_N = 0.5;
  estimate.alternative_chi2 = 7;
  const ResultLayout layout(PaperFinger(), scene, log);
  const std::string row = Row(log, scene, "1,2,3,4", estimate);
  const std::string header = layout.HeaderCsv();
  const FrameParser names(
      "b.csv",
      {std::string_view(header).substr(0, header.size() - 1), 1, false}, {});
  FrameRows rows;
  names.Parse({row.substr(0, row.size() - 1), 2, false}, &rows);
  const auto value = [&](const std::string& name) {
    const auto& all = names.names();
    const auto at = std::find(all.begin(), all.end(), name);
    EXPECT_NE(at, all.end()) << name;
    return rows.at(0, static_cast<std::size_t>(at - all.begin())).number;
  };
  EXPECT_EQ(value("contact_1_mm"), 50.25);
  EXPECT_EQ(value("contact_2_mm"), 90);
  EXPECT_EQ(value("contact_2_angle_rad"), 3);
  EXPECT_EQ(value("contact_2_low_mm"), 80);
  EXPECT_EQ(value("normal_2_high_N"), 9);
  EXPECT_TRUE(std::isnan(value("contact_2_high_mm")));
  EXPECT_EQ(value("friction_2"), 0.25);
  EXPECT_EQ(value("alternative_normal_2_N"), 0.5);
  EXPECT_TRUE(std::isnan(value("alternative_contact_2_mm")));
  EXPECT_EQ(value("alternative_chi2"), 7);
  EXPECT_EQ(value("rib_4_N"), 4);
  EXPECT_NEAR(value("chi2_p_value"), std::exp(-1), 1e-15);
  EXPECT_EQ(value("gauge_2_rad"), 2);
}

TEST(MeasurementColumnsTest, ReadsVoltsAnglesAndTheObjectsPlace) {
  Finger finger = PaperFinger();
  finger.gauges.resize(2);
  finger.gauges[1].gain_V_per_rad = 10;
  finger.gauges[1].offset_V = 0.5;
  const std::vector<std::string> names = {
      "object_angle_deg", "gauge_2_rad", "object_y_mm", "gauge_1_V",
      "gauge_1_rad",      "object_x_mm", "force_N"};
  const MeasurementColumns columns(finger, names, "a.csv", {});
  std::vector<double> row = {90, 0.25, -3, 1.5, 9, 4, 2};
  const auto cell = [&](std::size_t i) { return row[i]; };
  Measurements readings;
  columns.Read(cell, &readings);
  EXPECT_THAT(readings.gauges_V, testing::ElementsAre(1.5, 3));
  EXPECT_EQ(readings.object_mm.x(), 4);
  EXPECT_EQ(readings.object_mm.y(), -3);
  EXPECT_NEAR(readings.object_angle_rad, M_PI / 2, 1e-15);
  EXPECT_EQ(readings.force_N, 2);
  // A row without measurements keeps none of the row before.
  row.assign(row.size(), std::nan(""));
  columns.Read(cell, &readings);
  EXPECT_TRUE(std::isnan(readings.gauges_V[1]));
  EXPECT_TRUE(std::isnan(readings.object_mm.x()));
  EXPECT_EQ(readings.object_angle_rad, 0);

  const MeasurementColumns none(finger, {"gauge_1_V", "gauge_2_V"}, "a.csv",
                                {});
  none.Read([](std::size_t) { return 1.0; }, &readings);
  EXPECT_TRUE(std::isnan(readings.object_mm.y()));
  EXPECT_TRUE(std::isnan(readings.force_N));
  EXPECT_THAT([&] { MeasurementColumns(finger, {"gauge_1_V"}, "a.csv", {}); },
              testing::ThrowsMessage<InputError>(
                  HasSubstr("a.csv: no column 'gauge_2_V'")));
}

}  // namespace
}  // namespace finray
