// Predicts how well a finger will sense, and chooses where its gauges go.

#include <cmath>
#include <cstdio>

#include "app.h"
#include "design_start.h"
#include "finger_picture.h"
#include "finray/calib/design/finger_check.h"
#include "finray/calib/design/finger_design.h"
#include "finray/finger/geometry.h"
#include "finray/io/atomic_file.h"
#include "finray/io/number_text.h"
#include "finray/scene/frame_columns.h"
#include "number_flags.h"

DEFINE_string(finger, "", "finger YAML to start from");
DEFINE_string(dxf, "",
              "outline of a strip finger to start from: one closed contour, "
              "and one for each cell between ribs");
DEFINE_double(front_length_mm, 0, "to start from dimensions: l_0");
DEFINE_double(back_angle_deg, 112, "direction of the back beam from +x");
DEFINE_string(ribs, "", "front_mm:angle_deg of each rib, separated by commas");
DEFINE_double(thickness_mm, 0, "of both beams; --dxf has its own");
DEFINE_double(width_mm, 0, "of both beams, across the plane of the finger");
DEFINE_double(youngs_modulus_GPa, 0, "of both beams");
DEFINE_string(out_dir, "", "folder for finger.yaml, accuracy.csv, finger.svg");
DEFINE_string(plan, "",
              "plan YAML of the calibration that is to come; without it the "
              "finger counts as known as well as its YAML says");
DEFINE_int32(calibration_frames, 200, "frames of that calibration");
DEFINE_string(region_mm, "",
              "front beam from:to that matters; default: 0.15 to 0.8 of it");
DEFINE_double(force_N, 0, "force of the contacts; 0: 3 EI / l_0^2");
DEFINE_double(friction, 0, "friction coefficient of the contacts");
DEFINE_int32(gauges, 0, "place so many gauges; 0: keep those of the finger");
DEFINE_int32(most_gauges, 0,
             "also find the best std for 2 to so many gauges (gauges.csv)");
DEFINE_string(gauge_beams, "back", "beams that gauges may be on: back,front");
DEFINE_string(gauge_length_mm, "18",
              "length of a gauge, or least:most; gains go with 1 / length");
DEFINE_double(gauge_noise_rad, 3e-4,
              "noise of a gauge of 18 mm, rad of bending");
DEFINE_double(clearance_mm, 1,
              "least distance of a gauge from hinges, ends and other gauges");
DEFINE_string(goal, "place", "what gauges should tell best: place or force");
DEFINE_uint64(seed, 1, "of the starts of the search");

namespace {

using namespace finray;

constexpr double kReferenceLength_mm = 18;

// Throws UsageError for flags that would do nothing.
void RefuseUnused() {
  const auto refuse = [](std::initializer_list<const char*> flags,
                         const char* why) {
    for (const char* flag : flags) {
      if (IsGiven(flag)) throw UsageError(std::string("--") + flag + why);
    }
  };
  const char* const dimensions = " goes with --front_length_mm";
  if (!IsGiven("front_length_mm")) {
    refuse({"ribs", "back_angle_deg", "thickness_mm"}, dimensions);
  }
  if (!FLAGS_finger.empty()) {
    refuse({"width_mm", "youngs_modulus_GPa"},
           ": the beams are those of --finger");
  }
  if (FLAGS_plan.empty()) refuse({"calibration_frames"}, " goes with --plan");
}

PlacementTask Task(const Finger& finger) {
  PlacementTask task;
  task.gauge.length_mm = kReferenceLength_mm;
  task.gauge.noise_V = PositiveFlag("gauge_noise_rad", FLAGS_gauge_noise_rad) *
                       task.gauge.gain_V_per_rad;
  for (const std::string& beam : SplitList(FLAGS_gauge_beams)) {
    if (beam != "front" && beam != "back") {
      throw UsageError("--gauge_beams: expected back, front or both, found " +
                       beam);
    }
    task.beams.push_back(beam == "front" ? Side::kFront : Side::kBack);
  }
  if (task.beams.empty()) {
    throw UsageError("--gauge_beams: expected back, front or both");
  }
  const std::string& length_mm = FLAGS_gauge_length_mm;
  if (const auto one = ParseNumber(length_mm)) {
    task.least_length_mm = task.most_length_mm = *one;
  } else {
    std::tie(task.least_length_mm, task.most_length_mm) =
        RangeFlag("gauge_length_mm", length_mm);
  }
  if (task.least_length_mm < 1) {
    throw UsageError("--gauge_length_mm: expected at least 1 mm");
  }
  task.clearance_mm = FLAGS_clearance_mm;
  if (!(task.clearance_mm >= 0)) {
    throw UsageError("--clearance_mm: expected at least 0");
  }
  std::tie(task.from_mm, task.to_mm) =
      RegionFlag("region_mm", FLAGS_region_mm, finger, 0.15, 0.8);
  task.normal_N = FLAGS_force_N == 0 ? 3 * ForceUnit(finger)
                                     : PositiveFlag("force_N", FLAGS_force_N);
  task.friction = FLAGS_friction;
  if (!(std::abs(task.friction) <= 10)) {
    throw UsageError("--friction: expected a coefficient, -10 to 10, found " +
                     NumberText(task.friction));
  }
  if (FLAGS_goal != "place" && FLAGS_goal != "force") {
    throw UsageError("--goal: expected place or force, found " + FLAGS_goal);
  }
  task.goal =
      FLAGS_goal == "place" ? PlacementGoal::kPlace : PlacementGoal::kForce;
  return task;
}

std::string PlacesOf(const Finger& finger) {
  std::string words;
  for (const Gauge& gauge : finger.gauges) {
    words += (words.empty() ? "" : ", ") + std::string(SideName(gauge.beam)) +
             FormatText(" %g to %g", gauge.start_mm,
                        gauge.start_mm + gauge.length_mm);
  }
  return words;
}

std::string WordsOf(const WorstStd& worst) {
  if (std::isinf(worst.place_mm)) {
    return FormatText("not determined at %.0f mm", worst.place_at_mm);
  }
  return FormatText("place %.3g mm (at %.0f mm), force %.3g N (at %.0f mm)",
                    worst.place_mm, worst.place_at_mm, worst.force_N,
                    worst.force_at_mm);
}

void PrintPairs(const FrameTable& table) {
  if (!table.Has(ContactArc(1))) return;
  std::vector<double> places, forces;
  const std::vector<double>& second = table.Numbers(ContactArc(1));
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (std::isnan(second[row])) continue;
    for (int c = 0; c < 2; ++c) {
      places.push_back(table.Numbers(ContactArcStd(c))[row]);
      forces.push_back(table.Numbers(NormalForceStd(c))[row]);
    }
  }
  const auto median = [](std::vector<double>* values) {
    std::nth_element(values->begin(), values->begin() + values->size() / 2,
                     values->end());
    return (*values)[values->size() / 2];
  };
  std::printf(
      "two contacts   half of them are told within %.3g mm and %.3g N "
      "(std; accuracy.csv)\n",
      median(&places), median(&forces));
}

FrameTable Front(const Finger& finger, const GaugePlaces& places,
                 const PlacementTask& task,
                 const FutureCalibration& calibration,
                 const Discretization& discretization) {
  FrameTable table(static_cast<std::size_t>(FLAGS_most_gauges - 1));
  for (int count = 2; count <= FLAGS_most_gauges; ++count) {
    const auto row = static_cast<std::size_t>(count - 2);
    const std::optional<GaugeChoice> choice = ChooseGauges(
        finger, places, task, count, calibration, FLAGS_seed, discretization);
    if (!choice) {
      std::printf("%d gauges       have no room\n", count);
      table.Truncate(row);
      break;
    }
    std::printf("%d gauges       %s: %s\n", count,
                WordsOf(choice->worst).c_str(),
                PlacesOf(choice->finger).c_str());
    if (!choice->untold_mm.empty()) {
      std::printf("               %zu heights are not told\n",
                  choice->untold_mm.size());
    }
    table.MutableText("untold_heights")[row] =
        std::to_string(choice->untold_mm.size());
    table.MutableText("gauges")[row] = std::to_string(count);
    table.MutableText("worst_place_std_mm")[row] =
        NumberText(choice->worst.place_mm);
    table.MutableText("worst_force_std_N")[row] =
        NumberText(choice->worst.force_N);
    table.MutableText("places_mm")[row] = PlacesOf(choice->finger);
  }
  return table;
}

int Design() {
  const Discretization discretization = DiscretizationFlags();
  Required("out_dir", FLAGS_out_dir);
  RefuseUnused();
  const auto [start, plates] = StartFinger();
  const PlacementTask task = Task(start);
  FutureCalibration calibration;
  if (!FLAGS_plan.empty()) calibration.plan = ReadPlan(FLAGS_plan);
  if (FLAGS_calibration_frames < 1) {
    throw UsageError("--calibration_frames: expected at least 1");
  }
  if (FLAGS_gauges < 0 || FLAGS_gauges == 1 || FLAGS_most_gauges < 0 ||
      FLAGS_most_gauges == 1) {
    throw UsageError(
        "--gauges, --most_gauges: expected 0, or at least 2, which a contact "
        "takes");
  }
  calibration.frames = static_cast<std::size_t>(FLAGS_calibration_frames);
  if (FLAGS_gauges == 0 && start.gauges.empty()) {
    throw UsageError(
        "--gauges is missing: the finger has none to predict with");
  }
  std::vector<std::string> inputs;
  for (const std::string& path : {FLAGS_finger, FLAGS_dxf, FLAGS_plan}) {
    if (!path.empty()) inputs.push_back(path);
  }
  RefuseToOverwrite(inputs, {OutPath("finger.yaml")});

  // How well it senses as it is.
  const std::vector<double> heights = HeightsOf(task.from_mm, task.to_mm);
  Finger designed = start;
  std::optional<WorstStd> before;
  if (!start.gauges.empty()) {
    designed =
        AfterCalibration(start, calibration, task.normal_N, discretization);
    ContactAccuracy accuracy(designed, task.friction, discretization);
    before = WorstOf(heights, task.normal_N, task.friction, &accuracy);
  }
  WorstStd worst = before.value_or(WorstStd{});
  std::vector<double> untold;
  std::optional<GaugePlaces> places;
  if (FLAGS_gauges > 0 || FLAGS_most_gauges > 0) {
    places.emplace(start, task, discretization);
  }
  if (FLAGS_gauges > 0) {
    const std::optional<GaugeChoice> choice =
        ChooseGauges(start, *places, task, FLAGS_gauges, calibration,
                     FLAGS_seed, discretization);
    if (!choice) {
      throw InputError(FormatText(
          "%d gauges have no room on the beams of --gauge_beams; place fewer, "
          "shorter ones or allow another beam",
          FLAGS_gauges));
    }
    designed = choice->finger;
    worst = choice->worst;
    untold = choice->untold_mm;
  } else {
    untold = UntoldHeights(designed, heights, task.normal_N, task.friction,
                           discretization);
  }
  const FrameTable table =
      AccuracyTable(designed, task.normal_N, task.friction, discretization);
  Finger written = designed;
  // The covariance is a prediction. A file with it would look calibrated.
  written.calibration = FLAGS_gauges > 0 ? std::nullopt : start.calibration;
  MakeFolder(FLAGS_out_dir);
  WriteFileAtomically(OutPath("finger.yaml"),
                      FingerToYaml(written,
                                   "Designed by finray_design; not "
                                   "calibrated."));
  table.Write(OutPath("accuracy.csv"));
  DrawFinger(written, OutPath("finger.svg"));
  std::printf("%s\n", OutPath("finger.yaml").c_str());
  std::printf("finger         %s, %zu ribs\n", written.name.c_str(),
              written.ribs.size());
  std::printf("gauges         %s\n", PlacesOf(written).c_str());
  if (calibration.plan) {
    std::printf("calibration    %zu frames by %s\n", calibration.frames,
                FLAGS_plan.c_str());
  } else {
    std::printf("calibration    %s\n",
                start.calibration && FLAGS_gauges == 0
                    ? "as the finger's YAML says"
                    : "exact: no --plan says how the finger is calibrated");
  }
  std::printf("one contact    worst std of %.3g N from %.4g to %.4g mm: %s\n",
              task.normal_N, task.from_mm, task.to_mm, WordsOf(worst).c_str());
  if (before && FLAGS_gauges > 0) {
    std::printf("before         %s with gauges at %s\n",
                WordsOf(*before).c_str(), PlacesOf(start).c_str());
  }
  PrintPairs(table);
  Warn(StiffnessWarnings(start, plates));
  if (start.ribs.empty()) {
    Warn("the finger has no ribs",
         "give them by --ribs or list them in the "
         "finger YAML, from base to tip");
  }
  if (!untold.empty()) {
    Warn(
        FormatText("at %zu of %zu heights of the region, %.0f to %.0f mm, the "
                   "estimator does not tell the contact, even from exact "
                   "readings",
                   untold.size(), heights.size(), untold.front(),
                   untold.back()),
        "another contact explains them as well: take a larger force, a smaller "
        "region, or more gauges");
  }
  if (FLAGS_most_gauges > 0) {
    Front(start, *places, task, calibration, discretization)
        .Write(OutPath("gauges.csv"));
  }
  return std::isinf(worst.place_mm) || untold.size() == heights.size()
             ? kGateFailed
             : kGood;
}

int Run() {
  try {
    return Design();
  } catch (const DrawingFailed&) {
    return kBadInput;
  }
}

}  // namespace

const finray::App finray::kApp = {
    "Predicts how well a finger will sense and chooses places of gauges.\n"
    "finray_design --finger F.yaml --out_dir D [--plan P.yaml] [--gauges 4]\n"
    "finray_design --dxf outline.dxf --width_mm 20 --youngs_modulus_GPa 2.1 "
    "--gauges 4 --out_dir D\n"
    "finray_design --front_length_mm 140 --ribs 17:10,39:13 --width_mm 20 "
    "--thickness_mm 1 --youngs_modulus_GPa 7 --gauges 4 --out_dir D",
    Run};
