// Plans a recording: where the stage goes, what to expect there, and how many
// rows suffice.

#include <cmath>
#include <cstdio>

#include "app.h"
#include "finger_picture.h"
#include "finray/calib/analysis/plausibility.h"
#include "finray/calib/design/recording_plan.h"
#include "finray/finger/geometry.h"
#include "finray/io/atomic_file.h"
#include "finray/io/frame_table.h"
#include "finray/io/log_list.h"
#include "finray/io/number_text.h"
#include "finray/io/python_script.h"
#include "finray/scene/frame_columns.h"
#include "number_flags.h"

DEFINE_string(finger, "",
              "finger YAML: the drawing, or an earlier calibration");
DEFINE_string(plan, "",
              "plan YAML of the calibration: its circle, its priors and std");
DEFINE_string(from, "",
              "logs recorded so far, separated by commas: plan what is still "
              "missing");
DEFINE_string(out_dir, "", "folder for recording.csv, recording.html");
DEFINE_string(x_mm, "", "object_x_mm that the stage reaches, from:to");
DEFINE_string(y_mm, "", "object_y_mm that the stage reaches, from:to");
DEFINE_double(force_max_N, 0, "largest force on finger and sensor");
DEFINE_string(region_mm, "",
              "front beam from:to that the target is for; default: 0.2 to 0.7 "
              "of it");
DEFINE_double(force_N, 0, "force that the target is for; 0: 3 EI / l_0^2");
DEFINE_double(target_contact_mm, 0, "rms error of l_c of a frame; 0: any");
DEFINE_double(target_force_N, 0, "rms error of the force of a frame; 0: any");
DEFINE_double(confidence_percent, 95,
              "share of fingers and recordings that shall meet the target");
DEFINE_int32(most_frames, 400, "plan no more rows");
DEFINE_int32(threads, 0, "threads over frames of --from; 0: all cores");
DEFINE_uint64(seed, 1, "of the order of rows and of the drawn fingers");
DEFINE_bool(report, true, "render recording.html");

namespace {

using namespace finray;

constexpr int kLeastRows = 12;  // fewer tell no finger

RecordingLimits LimitFlags(const Finger& finger) {
  RecordingLimits limits;
  const auto x = RangeFlag("x_mm", Required("x_mm", FLAGS_x_mm));
  const auto y = RangeFlag("y_mm", Required("y_mm", FLAGS_y_mm));
  limits.from_mm = {x.first, y.first};
  limits.to_mm = {x.second, y.second};
  limits.force_max_N = PositiveFlag("force_max_N", FLAGS_force_max_N);
  const double most_N = kMostForce * ForceUnit(finger);
  if (limits.force_max_N > most_N) {
    throw UsageError(FormatText(
        "--force_max_N %.6g: expected at most %.3g, %.0f EI / l_0^2 of this "
        "finger",
        limits.force_max_N, most_N, kMostForce));
  }
  return limits;
}

RecordingTarget TargetFlags(const Finger& finger) {
  RecordingTarget target;
  std::tie(target.from_mm, target.to_mm) =
      RegionFlag("region_mm", FLAGS_region_mm, finger, 0.2, 0.7);
  target.normal_N = FLAGS_force_N == 0 ? 3 * ForceUnit(finger)
                                       : PositiveFlag("force_N", FLAGS_force_N);
  if (FLAGS_target_contact_mm != 0) {
    target.place_mm =
        PositiveFlag("target_contact_mm", FLAGS_target_contact_mm);
  }
  if (FLAGS_target_force_N != 0) {
    target.force_N = PositiveFlag("target_force_N", FLAGS_target_force_N);
  }
  if (!target.place_mm && !target.force_N) {
    throw UsageError("--target_contact_mm or --target_force_N is missing");
  }
  target.confidence = FLAGS_confidence_percent / 100;
  if (!(target.confidence >= 0.5 && target.confidence <= 0.99)) {
    throw UsageError("--confidence_percent: expected 50 to 99, found " +
                     NumberText(FLAGS_confidence_percent));
  }
  return target;
}

FrameTable TableOf(const std::vector<RecordingRow>& rows) {
  FrameTable table(rows.size());
  const std::size_t gauges = rows.empty() ? 0 : rows[0].gauges_V.size();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RecordingRow& row = rows[i];
    table.MutableNumbers("object_x_mm")[i] = row.object_mm.x();
    table.MutableNumbers("object_y_mm")[i] = row.object_mm.y();
    table.MutableNumbers("force_N")[i] = row.force_N;
    table.MutableText("force_low_N")[i] = NumberText(row.force_low_N);
    table.MutableText("force_high_N")[i] = NumberText(row.force_high_N);
    table.MutableText("touches_at_mm")[i] =
        row.touches ? FormatText("%.1f", row.contact_mm) : "";
    for (std::size_t j = 0; j < gauges; ++j) {
      table.MutableNumbers(GaugeVolts(static_cast<int>(j)))[i] =
          row.gauges_V[j];
    }
  }
  return table;
}

std::string TargetWords(const RecordingTarget& target) {
  std::string words;
  if (target.place_mm) words = FormatText("%.3g mm", *target.place_mm);
  if (target.force_N) {
    words +=
        (words.empty() ? "" : " and ") + FormatText("%.3g N", *target.force_N);
  }
  return words + FormatText(" rms of %.3g N from %.4g to %.4g mm",
                            target.normal_N, target.from_mm, target.to_mm);
}

int Run() {
  const Discretization discretization = DiscretizationFlags();
  const Finger finger = ReadFinger(Required("finger", FLAGS_finger));
  const Plan plan = ReadPlan(Required("plan", FLAGS_plan));
  Required("out_dir", FLAGS_out_dir);
  const RecordingLimits limits = LimitFlags(finger);
  const RecordingTarget target = TargetFlags(finger);
  if (FLAGS_most_frames < kLeastRows) {
    throw UsageError("--most_frames: expected at least " +
                     std::to_string(kLeastRows));
  }
  std::vector<std::string> logs;
  if (!FLAGS_from.empty()) logs = ExpandLogs(SplitList(FLAGS_from), "");
  std::vector<std::string> inputs = logs;
  inputs.push_back(FLAGS_finger);
  inputs.push_back(FLAGS_plan);
  RefuseToOverwrite(inputs, {OutPath("recording.csv")});
  const KnownFinger known = logs.empty()
                                ? FromDrawing(finger, plan, discretization)
                                : FromLogs(finger, plan, logs, discretization,
                                           Threads(FLAGS_threads));
  const RecordingPlan recording = PlanRecording(
      known, plan, limits, target, FLAGS_seed,
      static_cast<std::size_t>(FLAGS_most_frames), discretization);

  MakeFolder(FLAGS_out_dir);
  TableOf(recording.rows).Write(OutPath("recording.csv"));
  std::vector<Eigen::Vector2d> places;
  int free = 0;
  for (const RecordingRow& row : recording.rows) {
    free += !row.touches;
    places.push_back(known.stage.InS(row.object_mm));
  }
  const std::string verdict =
      recording.rows.empty() ? "no further row is needed"
      : recording.suffices
          ? FormatText("%zu rows suffice, %d of them free",
                       recording.rows.size(), free)
          : FormatText("%zu rows do not suffice", recording.rows.size());
  if (FLAGS_report) {
    const bool drawn = DrawFinger(known.finger, OutPath("finger.svg"), places);
    const std::string why_not = RunPythonScript(
        "calib/report/recording_page.py",
        {FLAGS_out_dir, known.finger.name, verdict, TargetWords(target),
         FormatText("%.4g", limits.force_max_N), drawn ? "1" : "0"},
        "python3-jinja2");
    if (!why_not.empty()) Warn("no recording.html", why_not);
  }
  std::printf("%s\n", OutPath("recording.csv").c_str());
  std::printf("rows           %s\n", verdict.c_str());
  std::printf("target         %s\n", TargetWords(target).c_str());
  std::printf(
      "predicted      %.1f %% of fingers and recordings meet it (%.1f %% "
      "without these rows)\n",
      100 * recording.met, 100 * recording.met_before);
  std::printf(
      "error          half are below %.3g mm and %.3g N; the noise of a "
      "frame alone is %.3g mm and %.3g N, at worst %.3g mm and %.3g N\n",
      recording.median_mm, recording.median_N, recording.noise_mm,
      recording.noise_N, recording.worst_mm, recording.worst_N);
  if (!known.copies.empty()) Warn(known.copies, kCopiesRemedy);
  if (!logs.empty() && known.rows < kLeastRows) {
    Warn(
        FormatText("--from has %zu row%s that can be fitted, which tell%s next "
                   "to nothing of the finger",
                   known.rows, known.rows == 1 ? "" : "s",
                   known.rows == 1 ? "s" : ""),
        "are these the logs that you mean? Without --from the plan starts "
        "from the drawing");
  }
  if (recording.largest_N > limits.force_max_N) {
    Warn(FormatText("a finger within the priors may press with up to %.3g N at "
                    "these places",
                    recording.largest_N),
         FormatText("stop at %.4g N and leave that row out; the plan counts "
                    "with that",
                    limits.force_max_N));
  }
  if (!recording.suffices) {
    Warn("the target is not met with " + std::to_string(FLAGS_most_frames) +
             " rows",
         recording.shortfall.Remedy());
    return kGateFailed;
  }
  return kGood;
}

}  // namespace

const finray::App finray::kApp = {
    "Plans a recording for a calibration: stage places in random order, "
    "expected "
    "forces and volts, and how many rows suffice.\n"
    "finray_plan --finger F.yaml --plan P.yaml --x_mm -30:10 --y_mm 0:140 "
    "--force_max_N 8 --target_force_N 0.05 --out_dir D [--from log.csv]",
    Run};
