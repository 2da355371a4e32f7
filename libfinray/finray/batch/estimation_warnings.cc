#include "finray/batch/estimation_warnings.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "finray/io/number_text.h"
#include "finray/sensing/zeroed_finger.h"

namespace finray {
namespace {

// If all gauges of the free finger read their offsets within so many noise_V,
// the offsets are not the cause.
constexpr double kMoved = 2;

// The mean shift of each gauge in free rows.
struct Shift {
  std::string words;
  bool moved = false;
};

std::optional<Shift> ShiftOf(const EstimationSummary& summary,
                             const Finger& finger) {
  if (summary.free_rows < EstimationSummary::kFewestUnexplained) return {};
  const Eigen::VectorXd bent_V = FreeVolts(finger, {});
  Shift shift;
  std::string list;
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    const Gauge& gauge = finger.gauges[j];
    const double moved_V =
        summary.free_sums_V[j] / static_cast<double>(summary.free_rows) -
        gauge.offset_V - bent_V[static_cast<Eigen::Index>(j)];
    shift.moved |= std::abs(moved_V) > kMoved * gauge.noise_V;
    list += FormatText("%s%+.2g", j > 0 ? ", " : "", 1e3 * moved_V);
  }
  shift.words = "in its " + std::to_string(summary.free_rows) +
                " rows with a force_N near zero the gauges read " + list +
                " mV beside their offsets";
  return shift;
}

// Where free rows show it, says how far the offsets have moved.
std::string Measured(const std::optional<Shift>& shift) {
  return shift ? "; " + shift->words : "";
}

bool MayHaveMoved(const std::optional<Shift>& shift) {
  return !shift || shift->moved;
}

const char* MovedOrNot(const std::optional<Shift>& shift) {
  return MayHaveMoved(shift)
             ? "zero the gauges with finray_zero; then look for more contacts "
               "than the scene has, a changed finger, a wrong noise_V"
             : "the offsets have not moved: look at the unit and the delay of "
               "force_N, for more contacts than the scene has, a changed "
               "finger, a wrong noise_V";
}

// The likeliest reason why the finger does not fit a log; empty if there is
// none.
const char* LikeliestCause(const Finger& finger,
                           const std::optional<Shift>& shift) {
  if (!finger.calibration)
    return "likeliest cause: the finger is not calibrated; ";
  if (MayHaveMoved(shift))
    return "likeliest cause: the gauges' offsets have moved; ";
  return "";
}

const char* Remedy(const Finger& finger, const std::optional<Shift>& shift) {
  return finger.calibration ? MovedOrNot(shift)
                            : "calibrate it with finray_calibrate";
}

Warning Unexplained(const EstimationSummary& summary, const Finger& finger,
                    const std::string& log) {
  const auto shift = ShiftOf(summary, finger);
  return {"unexplained_frames",
          LikeliestCause(finger, shift) + std::to_string(summary.unexplained) +
              " of " + std::to_string(summary.frames - summary.unsolved()) +
              " solved frames of " + log +
              " are not explained by the finger and its noise" +
              Measured(shift),
          Remedy(finger, shift)};
}

Warning ForcesDiffer(const EstimationSummary& summary, const Finger& finger,
                     const std::string& log) {
  const auto shift = ShiftOf(summary, finger);
  return {"forces_differ",
          LikeliestCause(finger, shift) +
              std::string("estimated forces differ from the force_N of ") +
              log +
              FormatText(" by %.3g N rms, %.3g times their stated std, and "
                         "%zu of %zu are far off",
                         summary.force_rms_N(),
                         summary.force_rms_N() / summary.force_std_N(),
                         summary.force_far, summary.force_judged) +
              Measured(shift),
          Remedy(finger, shift)};
}

Warning NeverFree(const EstimationSummary& summary, const Finger& finger,
                  const std::string& log) {
  const auto shift = ShiftOf(summary, finger);
  const std::string contacts =
      "all " + std::to_string(summary.frames - summary.unsolved()) +
      " solved frames of " + log + " have a contact, " +
      std::to_string(summary.count(FrameStatus::kUnobservable)) +
      " of them an unobservable one";
  if (shift) {
    return {
        "forces_differ",
        contacts + ", although some have a force_N near zero" + Measured(shift),
        MovedOrNot(shift)};
  }
  return {"never_free", contacts + ", and no force_N says whether that is so",
          "if the finger was free in any of them, the gauges' offsets have "
          "moved: zero them with finray_zero"};
}

// A reason to doubt a log, and how many of its frames show it.
struct Doubt {
  bool (EstimationSummary::*applies)() const;
  std::size_t EstimationSummary::*frames;
  Warning (*warning)(const EstimationSummary&, const Finger&,
                     const std::string&);
};
constexpr Doubt kDoubts[] = {
    {&EstimationSummary::unexplained_too_many, &EstimationSummary::unexplained,
     Unexplained},
    {&EstimationSummary::forces_differ, &EstimationSummary::force_far,
     ForcesDiffer},
    {&EstimationSummary::never_free, &EstimationSummary::frames, NeverFree}};

}  // namespace

std::vector<Warning> WarningsOf(const Finger& finger) {
  if (finger.calibration) return {};
  return {
      {"not_calibrated",
       "the finger is not calibrated: its gains and stiffness are as drawn, "
       "and so are the std of its forces",
       "calibrate it with finray_calibrate"}};
}

std::vector<Warning> WarningsOf(const std::vector<LogSummary>& logs,
                                const Finger& finger) {
  std::vector<Warning> warnings;
  for (const Doubt& doubt : kDoubts) {
    const LogSummary* worst = nullptr;
    std::size_t count = 0;
    for (const LogSummary& log : logs) {
      if (!(log.summary->*doubt.applies)()) continue;
      ++count;
      if (!worst ||
          log.summary->*doubt.frames > worst->summary->*doubt.frames) {
        worst = &log;
      }
    }
    if (!worst) continue;
    std::string name = worst->log;
    if (count > 1) {
      name += " (the worst of " + std::to_string(count) + " logs)";
    }
    warnings.push_back(doubt.warning(*worst->summary, finger, name));
  }
  return warnings;
}

bool FailsStrict(const std::vector<Warning>& warnings) {
  return std::any_of(warnings.begin(), warnings.end(),
                     [](const Warning& warning) {
                       return warning.code == "unexplained_frames" ||
                              warning.code == "forces_differ";
                     });
}

}  // namespace finray
