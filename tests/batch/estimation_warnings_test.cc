#include "finray/batch/estimation_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "finray/estimation/zeroed_finger.h"
#include "test_finger.h"

namespace finray {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

Finger CalibratedFinger() {
  Finger finger = PaperFinger();
  for (Gauge& gauge : finger.gauges) gauge.noise_V = 3e-4;
  finger.calibration.emplace();
  return finger;
}

FrameEstimate Contact(double normal_N, double std_N) {
  FrameEstimate estimate;
  estimate.status = FrameStatus::kOk;
  estimate.contacts = 1;
  estimate.contact[0].normal_N = normal_N;
  estimate.contact[0].normal_std_N = std_N;
  return estimate;
}

Measurements Row(const Finger& finger, double force_N, double shift_V) {
  const Eigen::VectorXd bent_V = FreeVolts(finger, {});
  Measurements row;
  row.force_N = force_N;
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    row.gauges_V.push_back(finger.gauges[j].offset_V + shift_V +
                           bent_V[static_cast<Eigen::Index>(j)]);
  }
  return row;
}

Scene OneContact() {
  Scene scene;
  scene.contacts = 1;
  return scene;
}

std::vector<Warning> Of(const EstimationSummary& summary, const Finger& finger,
                        const LogCause& cause = {}) {
  return WarningsOf({{&summary, "a.csv", &cause}}, finger);
}

// Gauges that have all moved by as much agree on a contact that is not there.
TEST(EstimationWarningsTest, ForcesThatTheLogContradicts) {
  const Finger finger = CalibratedFinger();
  EstimationSummary summary;
  for (int i = 0; i < 40; ++i) {
    summary.Add(Contact(3, 0.02), 0, Row(finger, 3.01, 0.02), finger);
  }
  EXPECT_THAT(Of(summary, finger), IsEmpty());
  // Some are chance, and a light touch may be off by the sensor's noise.
  summary.Add(Contact(0.08, 0.001), 0, Row(finger, 0.03, 0.02), finger);
  for (int i = 0; i < 2; ++i) {
    summary.Add(Contact(30, 1), 0, Row(finger, 0.01, 0.02), finger);
  }
  EXPECT_THAT(Of(summary, finger), IsEmpty());
  summary.Add(Contact(30, 1), 0, Row(finger, 0, 0.02), finger);
  const std::vector<Warning> warnings =
      Of(summary, finger,
         {"the gauges' offsets have moved", "so far", "finray_zero"});
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_EQ(warnings[0].code, "forces_differ");
  EXPECT_EQ(warnings[0].text,
            "likeliest cause: the gauges' offsets have moved; estimated forces "
            "differ from the force_N of a.csv by 7.83 N rms, 29.9 times their "
            "stated std, and 3 of 44 are far off; in its 4 rows with a "
            "force_N near zero the gauges read +20, +20, +20, +20 mV beside "
            "their offsets; so far");
  // Nobody has looked for a cause, so none is named.
  EXPECT_EQ(Of(summary, finger)[0].text.find("estimated forces differ"), 0u);
  EXPECT_THAT(warnings[0].remedy, HasSubstr("finray_zero"));
  EXPECT_TRUE(FailsStrict(warnings, {}));
}

TEST(EstimationWarningsTest, AFaultOfGaugesWhateverFramesShow) {
  const Finger finger = CalibratedFinger();
  EstimationSummary summary;
  FrameEstimate free = Contact(0, 0);
  free.status = FrameStatus::kNoContact;
  for (int i = 0; i < 40; ++i) {
    summary.Add(free, 0, Row(finger, std::nan(""), 0), finger);
  }
  EXPECT_THAT(Of(summary, finger), IsEmpty());
  const LogCause frozen{"all gauges read the same", "", "look", true};
  std::vector<Warning> warnings = Of(summary, finger, frozen);
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_EQ(warnings[0].code, "gauge_fault");
  EXPECT_EQ(warnings[0].text, "in a.csv all gauges read the same");
  EXPECT_TRUE(FailsStrict(warnings, OneContact()));

  // Beside a few frames, which alone do not fail.
  summary.frames = 1000;
  summary.unexplained = 20;
  EXPECT_FALSE(
      FailsStrict(Of(summary, finger, {"slipped", "", ""}), OneContact()));
  warnings = Of(summary, finger, frozen);
  ASSERT_THAT(warnings, SizeIs(2));
  EXPECT_EQ(warnings[1].code, "some_unexplained_frames");
  EXPECT_THAT(warnings[1].text,
              HasSubstr("likeliest cause: all gauges read the same; 20 of"));
  EXPECT_TRUE(FailsStrict(warnings, OneContact()));

  // In a log that another one surpasses.
  EstimationSummary worse = summary;
  worse.unexplained = 900;
  const LogCause moved{"the gauges' offsets have moved", "", "zero"};
  warnings = WarningsOf(
      {{&worse, "a.csv", &moved}, {&summary, "b.csv", &frozen}}, finger);
  EXPECT_EQ(warnings[0].text, "in b.csv all gauges read the same");
  EXPECT_THAT(
      warnings[1].text,
      HasSubstr("likeliest cause: the gauges' offsets have moved; 900"));
}

TEST(EstimationWarningsTest, FreeRowsThatReadTheirOffsets) {
  const Finger finger = CalibratedFinger();
  EstimationSummary summary;
  for (int i = 0; i < 10; ++i) {
    summary.Add(Contact(3, 0.02), 0, Row(finger, 3000, 0), finger);  // mN
    FrameEstimate free = Contact(0, 0);
    free.status = FrameStatus::kNoContact;
    free.contacts = 0;
    summary.Add(free, 0, Row(finger, 0.01, 1e-4), finger);
  }
  const std::vector<Warning> warnings = Of(summary, finger);
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_THAT(warnings[0].text, HasSubstr("read +0.1, +0.1, +0.1, +0.1 mV"));
  EXPECT_THAT(warnings[0].text, Not(HasSubstr("offsets have moved")));
}

TEST(EstimationWarningsTest, ALogWithoutForceThatIsNeverFree) {
  const Finger finger = CalibratedFinger();
  EstimationSummary summary;
  for (int i = 0; i < 49; ++i) {
    summary.Add(Contact(30, 1), 0, Row(finger, std::nan(""), 0.02), finger);
  }
  EXPECT_THAT(Of(summary, finger), IsEmpty());
  FrameEstimate estimate = Contact(30, 1);
  estimate.status = FrameStatus::kUnobservable;
  summary.Add(estimate, 0, Row(finger, std::nan(""), 0.02), finger);
  const std::vector<Warning> warnings = Of(summary, finger);
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_EQ(warnings[0].text,
            "none of the 50 solved frames of a.csv is free, 1 unobservable, "
            "and no force_N says whether that is so");
  EXPECT_THAT(warnings[0].remedy, HasSubstr("say contacts: 1 in the scene"));
  EXPECT_TRUE(FailsStrict(warnings, {}));
  EXPECT_FALSE(FailsStrict(warnings, OneContact()));  // it is meant
  // Some of the rows are free, and their forces cannot be compared.
  EstimationSummary free = summary;
  for (int i = 0; i < 3; ++i)
    free.Add(estimate, 0, Row(finger, 0, 0.02), finger);
  const std::vector<Warning> sure = Of(free, finger);
  ASSERT_THAT(sure, SizeIs(1));
  EXPECT_THAT(sure[0].text, HasSubstr("although some have a force_N near zero; "
                                      "in its 3 rows"));
  EXPECT_TRUE(FailsStrict(sure, OneContact()));
  estimate.status = FrameStatus::kNoContact;
  summary.Add(estimate, 0, Row(finger, std::nan(""), 0.02), finger);
  EXPECT_THAT(Of(summary, finger), IsEmpty());
}

TEST(EstimationWarningsTest, NamesTheFirstReadingThatNoGaugeGives) {
  Finger finger = CalibratedFinger();
  finger.gauges[1].offset_V = 0.25;
  finger.gauges[1].gain_V_per_rad = -2;
  EstimationSummary summary;
  FrameEstimate bad;
  bad.status = FrameStatus::kBadInput;
  summary.Add(Contact(1, 0.02), 0, Row(finger, std::nan(""), 0), finger);
  for (const double volts : {-13., 9.9e37}) {
    Measurements row = Row(finger, std::nan(""), 0);
    row.gauges_V[1] = volts;
    summary.Add(bad, 0, row, finger);
  }
  const auto warnings = Of(summary, finger);
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_EQ(warnings[0].code, "impossible_readings");
  EXPECT_THAT(warnings[0].text,
              HasSubstr("2 of 3 rows of a.csv are bad_input for a reading that "
                        "no gauge gives: in row 2 gauge 2 reads -13 V, "
                        "expected -12.32 to 12.82 V"));
  EXPECT_FALSE(FailsStrict(warnings, OneContact()));
}

TEST(EstimationWarningsTest, FrictionOfSceneAndFinger) {
  Finger finger = PaperFinger();
  finger.calibration.emplace();
  finger.calibration->parameters = {{FingerParameterKind::kFrontStiffness}};
  finger.calibration->std = Eigen::VectorXd::Constant(1, 100);
  finger.calibration->correlations = Eigen::MatrixXd::Identity(1, 1);
  Scene scene;
  EXPECT_THAT(WarningsOf(finger, scene), IsEmpty());  // the file does not say
  finger.calibration->friction = 0.3;
  const auto warnings = WarningsOf(finger, scene);
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_EQ(warnings[0].code, "friction_differs");
  EXPECT_THAT(warnings[0].text, HasSubstr("of 0.3, and the scene has 0"));
  EXPECT_THAT(warnings[0].remedy, HasSubstr("friction_coefficient: 0.3"));
  scene.friction_std = 0.2;  // the scene does not contradict it
  EXPECT_THAT(WarningsOf(finger, scene), IsEmpty());
  scene.friction_std = 0.1;
  EXPECT_THAT(WarningsOf(finger, scene), SizeIs(1));
  scene.friction_std = 0;
  scene.friction_coefficient = 0.31;
  EXPECT_THAT(WarningsOf(finger, scene), IsEmpty());
  scene.friction_coefficient = 0.33;
  EXPECT_THAT(WarningsOf(finger, scene), SizeIs(1));
  // As far as a calibration that has found it can tell.
  finger.calibration->parameters.push_back({FingerParameterKind::kFriction});
  finger.calibration->std = Eigen::Vector2d(100, 0.05);
  finger.calibration->correlations = Eigen::Matrix2d::Identity();
  scene.friction_coefficient = 0.34;
  EXPECT_THAT(WarningsOf(finger, scene), IsEmpty());
  scene.friction_coefficient = 0.36;
  EXPECT_THAT(WarningsOf(finger, scene), SizeIs(1));
  scene.contacts = 0;
  EXPECT_THAT(WarningsOf(finger, scene), IsEmpty());
}

TEST(EstimationWarningsTest, PreslidingWithoutFrictionDoesNothing) {
  Scene scene;
  scene.presliding_mm = 0.001;
  EXPECT_EQ(WarningsOf(PaperFinger(), scene)[0].code, "no_friction");
}

TEST(EstimationWarningsTest, NamesTheWorstOfLogs) {
  Finger finger = PaperFinger();
  EXPECT_EQ(WarningsOf(finger, Scene())[0].code, "not_calibrated");
  EstimationSummary good, bad, worse;
  good.frames = bad.frames = worse.frames = 10;
  bad.unexplained = 3;
  worse.unexplained = 4;
  const auto warnings =
      WarningsOf({{&good, "a"}, {&bad, "b"}, {&worse, "c"}}, finger);
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_THAT(warnings[0].text,
              HasSubstr("4 of 10 solved frames of c (the worst of 2 logs)"));
  EXPECT_THAT(WarningsOf({{&good, "a"}}, finger), IsEmpty());
}

}  // namespace
}  // namespace finray
