#include "finray/batch/estimation_warnings.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "finray/finger/possible_reading.h"
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
  int moved_gauges = 0, last_moved = -1;
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
    if (std::abs(moved_V) >
        kMoved * std::hypot(gauge.noise_V, gauge.HysteresisV())) {
      shift.moved = true;
      ++shift.moved_gauges;
      shift.last_moved = static_cast<int>(j);
    }
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

// Returns the gauge that reads nothing but noise while the others move; -1 if
// there is none.
int DeadGauge(const EstimationSummary& summary, const Finger& finger) {
  constexpr double kStill = 3, kMoves = 30;  // in noise_V
  const auto rows = static_cast<double>(summary.read_rows);
  if (summary.read_rows < EstimationSummary::kManyFrames) return -1;
  int still = -1, moving = 0;
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    const double mean = summary.read_sums_V[j] / rows;
    const double variance = summary.read_squares_V2[j] / rows - mean * mean;
    const double scatter =
        std::sqrt(std::max(0.0, variance)) / finger.gauges[j].noise_V;
    if (scatter < kStill) still = still < 0 ? static_cast<int>(j) : -2;
    moving += scatter > kMoves;
  }
  return still >= 0 && moving + 1 == static_cast<int>(finger.gauges.size())
             ? still
             : -1;
}

// Says whether the frames that are not explained are those of high loads.
bool GrowsWithLoad(const EstimationSummary& summary) {
  constexpr double kHeavier = 1.5;
  constexpr std::size_t kFewest = EstimationSummary::kFewestUnexplained;
  return summary.loads_explained >= kFewest &&
         summary.loads_unexplained >= kFewest &&
         summary.load_unexplained_N /
                 static_cast<double>(summary.loads_unexplained) >
             kHeavier * summary.load_explained_N /
                 static_cast<double>(summary.loads_explained);
}

// The likeliest reason why the finger does not fit a log; empty if there is
// none.
std::string LikeliestCause(const EstimationSummary& summary,
                           const Finger& finger,
                           const std::optional<Shift>& shift) {
  const std::string cause = "likeliest cause: ";
  if (!finger.calibration) return cause + "the finger is not calibrated; ";
  if (const int dead = DeadGauge(summary, finger); dead >= 0) {
    return cause + "gauge " + std::to_string(dead + 1) +
           " is dead: it does not move while the others do; ";
  }
  if (shift && shift->moved_gauges == 1 && finger.gauges.size() > 2) {
    return cause + "gauge " + std::to_string(shift->last_moved + 1) +
           " has slipped: its offset alone has moved; ";
  }
  if (!(shift && shift->moved) && GrowsWithLoad(summary)) {
    return cause +
           "it grows with the load, so stiffness, gains or friction are not "
           "the finger's; ";
  }
  if (MayHaveMoved(shift)) return cause + "the gauges' offsets have moved; ";
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
          LikeliestCause(summary, finger, shift) +
              std::to_string(summary.unexplained) + " of " +
              std::to_string(summary.frames - summary.unsolved()) +
              " solved frames of " + log +
              " are not explained by the finger and its noise" +
              Measured(shift),
          Remedy(finger, shift)};
}

Warning SomeUnexplained(const EstimationSummary& summary, const Finger& finger,
                        const std::string& log) {
  Warning warning = Unexplained(summary, finger, log);
  warning.code = "some_unexplained_frames";
  return warning;
}

Warning ForcesDiffer(const EstimationSummary& summary, const Finger& finger,
                     const std::string& log) {
  const auto shift = ShiftOf(summary, finger);
  return {"forces_differ",
          LikeliestCause(summary, finger, shift) +
              "estimated forces differ from the force_N of " + log +
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
  const std::string none =
      "none of the " + std::to_string(summary.frames - summary.unsolved()) +
      " solved frames of " + log + " is free, " +
      std::to_string(summary.count(FrameStatus::kUnobservable)) +
      " unobservable";
  if (shift) {
    return {"forces_differ",
            none + ", although some have a force_N near zero" + Measured(shift),
            MovedOrNot(shift)};
  }
  return {"never_free", none + ", and no force_N says whether that is so",
          "if the finger was free in any of them, the gauges' offsets have "
          "moved: zero them with finray_zero; if it never was, say contacts: 1 "
          "in the scene"};
}

Warning WalkDiffers(const EstimationSummary& summary, const Finger& /*finger*/,
                    const std::string& log) {
  using Verdict = WalkIncrements::Verdict;
  const WalkIncrements& walk = summary.walk;
  const Verdict verdict = walk.Judge();
  const std::string told =
      FormatText("std_V_per_sqrt_s: %.3g", walk.told_V_per_sqrt_s);
  const std::string fitting = FormatText("%.2g", walk.FittingWalk());
  if (verdict == Verdict::kTooLarge) {
    return {"wide_offset_walk",
            "the offsets of " + log + " wander less than the scene's " + told +
                " says: " + fitting +
                " fits. Contacts that are held come out less exact, or "
                "unobservable",
            "say " + fitting + " in the scene's gauge_offset_walk"};
  }
  const std::string unobservable = "; its contacts are unobservable";
  if (verdict == Verdict::kTooSmall) {
    return {"offset_walk",
            "the offsets of " + log + " wander more than the scene's " + told +
                " says: " + fitting + " fits" + unobservable,
            "say " + fitting + " in the scene's gauge_offset_walk"};
  }
  std::string drifts;
  for (const double moved_V : walk.moved_V) {
    drifts += FormatText("%s%+.2g", drifts.empty() ? "" : ", ",
                         1e3 * moved_V / walk.moved_s);
  }
  return {"offset_walk",
          "the offsets of " + log + " drift steadily, by " + drifts +
              " mV/s, which the scene's walk of " + told + " is not" +
              unobservable,
          "let the gauges warm up, or take the drift out of the readings; a "
          "walk must be as large as the drift between two free stretches"};
}

Warning ChangesDiffer(const EstimationSummary& summary,
                      const Finger& /*finger*/, const std::string& log) {
  return {"smoothing",
          FormatText("contacts of %s change from frame to frame by %.2g times "
                     "what the scene's smoothing says, so that their std are "
                     "too small",
                     log.c_str(),
                     std::sqrt(summary.change_chi2 / summary.change_dof)),
          "say larger std in the scene's smoothing"};
}

Warning Alone(const EstimationSummary& summary, const Finger& /*finger*/,
              const std::string& log) {
  return {"not_joint",
          "the frames of " + log +
              " could not be solved together: the problem does not converge; " +
              std::to_string(summary.alone) + " of " +
              std::to_string(summary.frames) + " are estimated one by one",
          "look for moved offsets and at start_std_V of the scene's "
          "gauge_offset_walk"};
}

Warning BadRows(const EstimationSummary& summary, const Finger& /*finger*/,
                const std::string& log) {
  return {
      "bad_rows",
      std::to_string(summary.bad_rows) + " of " +
          std::to_string(summary.frames + summary.bad_rows) + " rows of " +
          log + " are bad and left out",
      "their lines and reasons are in <log>.bad_rows.csv beside the result"};
}

Warning Impossible(const EstimationSummary& summary, const Finger& finger,
                   const std::string& log) {
  const Gauge& gauge = finger.gauges.at(summary.impossible_gauge - 1);
  const double most_V = LargestBending_V(gauge);
  return {"impossible_readings",
          std::to_string(summary.impossible) + " of " +
              std::to_string(summary.frames) + " rows of " + log +
              " are bad_input for a reading that no gauge gives: in row " +
              std::to_string(summary.impossible_row) + " gauge " +
              std::to_string(summary.impossible_gauge) + " reads " +
              summary.impossible_V +
              FormatText(" V, expected %.4g to %.4g V", gauge.offset_V - most_V,
                         gauge.offset_V + most_V),
          "look for an open cable, a wrong unit, or an error code of the "
          "logger, which not_measured in the scene can name"};
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
    {&EstimationSummary::unexplained_some, &EstimationSummary::unexplained,
     SomeUnexplained},
    {&EstimationSummary::forces_differ, &EstimationSummary::force_far,
     ForcesDiffer},
    {&EstimationSummary::offsets_move_otherwise, &EstimationSummary::frames,
     WalkDiffers},
    {&EstimationSummary::changes_differ, &EstimationSummary::frames,
     ChangesDiffer},
    {&EstimationSummary::any_alone, &EstimationSummary::alone, Alone},
    {&EstimationSummary::never_free, &EstimationSummary::frames, NeverFree},
    {&EstimationSummary::any_bad_rows, &EstimationSummary::bad_rows, BadRows},
    {&EstimationSummary::any_impossible, &EstimationSummary::impossible,
     Impossible}};

}  // namespace

std::vector<Warning> WarningsOf(const Finger& finger, const Scene& scene) {
  std::vector<Warning> warnings = FrictionWarnings(finger, scene);
  if (!finger.calibration) {
    warnings.push_back(
        {"not_calibrated",
         "the finger is not calibrated: its gains and stiffness are as drawn, "
         "and so are the std of its forces",
         "calibrate it with finray_calibrate"});
  }
  return warnings;
}

std::vector<Warning> FrictionWarnings(const Finger& finger,
                                      const Scene& scene) {
  constexpr double kHarmless = 0.02;  // of the coefficient
  constexpr double kFar = 2;          // friction_std
  std::vector<Warning> warnings;
  if (scene.presliding_mm && scene.friction_coefficient == 0) {
    warnings.push_back(
        {"no_friction",
         "presliding_mm does nothing in a scene without friction",
         "give the scene a friction_coefficient, or leave presliding_mm out"});
  }
  if (!finger.calibration || scene.contacts == 0) return warnings;
  const double calibrated = finger.calibration->friction;
  const double apart = std::abs(scene.friction_coefficient - calibrated);
  if (std::isnan(calibrated) ||
      apart <= std::max(kHarmless, kFar * scene.friction_std) ||
      IsFrictionOf(*finger.calibration, scene.friction_coefficient)) {
    return warnings;
  }
  warnings.push_back(
      {"friction_differs",
       FormatText("the finger was calibrated with a friction coefficient of "
                  "%.3g, and the scene has %.3g: against the same objects "
                  "places and forces are off, and chi2 may not show it",
                  calibrated, scene.friction_coefficient),
       FormatText("write friction_coefficient: %.3g in the scene; against "
                  "other objects it has theirs, with their friction_std",
                  calibrated)});
  return warnings;
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

bool FailsStrict(const std::vector<Warning>& warnings, const Scene& scene) {
  return std::any_of(
      warnings.begin(), warnings.end(), [&](const Warning& warning) {
        return warning.code == "unexplained_frames" ||
               warning.code == "forces_differ" ||
               warning.code == "offset_walk" || warning.code == "smoothing" ||
               (warning.code == "never_free" && !scene.contacts);
      });
}

}  // namespace finray
