#include "finray/batch/estimation_warnings.h"

#include <algorithm>

#include "finray/estimation/zeroed_finger.h"
#include "finray/finger/possible_reading.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

// Where free rows show it, says what their gauges read beside the offsets.
std::string Measured(const EstimationSummary& summary, const Finger& finger) {
  if (!summary.any_free_rows()) return "";
  const Eigen::VectorXd bent_V = FreeVolts(finger, {});
  std::string list;
  for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
    const double moved_V =
        summary.free_sums_V[j] / static_cast<double>(summary.free_rows) -
        finger.gauges[j].offset_V - bent_V[static_cast<Eigen::Index>(j)];
    list += FormatText("%s%+.2g", j > 0 ? ", " : "", 1e3 * moved_V);
  }
  return "; in its " + std::to_string(summary.free_rows) +
         " rows with a force_N near zero the gauges read " + list +
         " mV beside their offsets";
}

bool IsFaulty(const LogSummary& log) {
  return log.cause && log.cause->of_gauges;
}

// "likeliest cause: ...; ", or "" if nobody has looked for it.
std::string CauseOf(const LogSummary& log, const Finger& finger) {
  const std::string cause = "likeliest cause: ";
  if (log.cause && !log.cause->words.empty()) {
    return cause + log.cause->words + "; ";
  }
  return finger.calibration ? "" : cause + "the finger is not calibrated; ";
}

// What the cause and the free rows measure.
std::string Details(const LogSummary& log, const Finger& finger) {
  std::string details = Measured(*log.summary, finger);
  if (log.cause && !log.cause->details.empty()) {
    details += "; " + log.cause->details;
  }
  return details;
}

std::string Remedy(const LogSummary& log, const Finger& finger) {
  if (log.cause && !log.cause->remedy.empty()) return log.cause->remedy;
  return finger.calibration
             ? "look at the frames with a high chi2: for moved offsets, more "
               "contacts than the scene has, a changed finger, a wrong noise_V"
             : "calibrate it with finray_calibrate";
}

// `name` is that of the log, and may count others.
Warning Unexplained(const LogSummary& log, const Finger& finger,
                    const std::string& name) {
  const EstimationSummary& summary = *log.summary;
  return {"unexplained_frames",
          CauseOf(log, finger) + std::to_string(summary.unexplained) + " of " +
              std::to_string(summary.frames - summary.unsolved()) +
              " solved frames of " + name +
              " are not explained by the finger and its noise" +
              Details(log, finger),
          Remedy(log, finger)};
}

Warning SomeUnexplained(const LogSummary& log, const Finger& finger,
                        const std::string& name) {
  Warning warning = Unexplained(log, finger, name);
  warning.code = "some_unexplained_frames";
  return warning;
}

Warning ForcesDiffer(const LogSummary& log, const Finger& finger,
                     const std::string& name) {
  const EstimationSummary& summary = *log.summary;
  return {"forces_differ",
          CauseOf(log, finger) +
              "estimated forces differ from the force_N of " + name +
              FormatText(" by %.3g N rms, %.3g times their stated std, and "
                         "%zu of %zu are far off",
                         summary.force_rms_N(),
                         summary.force_rms_N() / summary.force_std_N(),
                         summary.force_far, summary.force_judged) +
              Details(log, finger),
          Remedy(log, finger)};
}

Warning Faulty(const LogSummary& log, const std::string& name) {
  return {"gauge_fault", "in " + name + " " + log.cause->words,
          log.cause->remedy};
}

Warning NeverFree(const LogSummary& log, const Finger& finger,
                  const std::string& name) {
  const EstimationSummary& summary = *log.summary;
  const std::string none =
      "none of the " + std::to_string(summary.frames - summary.unsolved()) +
      " solved frames of " + name + " is free, " +
      std::to_string(summary.count(FrameStatus::kUnobservable)) +
      " unobservable";
  if (summary.any_free_rows()) {
    return {"forces_differ",
            CauseOf(log, finger) + none +
                ", although some have a force_N near zero" +
                Details(log, finger),
            Remedy(log, finger)};
  }
  // Where a cause is known, it is not guessed here.
  const bool looked =
      finger.calibration && log.cause && !log.cause->words.empty();
  return {"never_free", none + ", and no force_N says whether that is so",
          looked ? log.cause->remedy
                 : "if the finger was free in any of them, the gauges' offsets "
                   "have moved: zero them with finray_zero; if it never was, "
                   "say contacts: 1 in the scene"};
}

Warning WalkDiffers(const LogSummary& log, const Finger& /*finger*/,
                    const std::string& name) {
  const EstimationSummary& summary = *log.summary;
  using Verdict = WalkIncrements::Verdict;
  const WalkIncrements& walk = summary.walk;
  const Verdict verdict = walk.Judge();
  const std::string told =
      FormatText("std_V_per_sqrt_s: %.3g", walk.told_V_per_sqrt_s);
  const std::string fitting = FormatText("%.2g", walk.FittingWalk());
  const bool is_floor = walk.FitsTheLeast();
  // At the floor nothing is told but that the walk is far smaller.
  const std::string remedy =
      is_floor ? "say the walk that a free finger shows in the scene's "
                 "gauge_offset_walk"
               : "say std_V_per_sqrt_s: " + fitting +
                     " in the scene's gauge_offset_walk";
  if (verdict == Verdict::kTooLarge) {
    return {"wide_offset_walk",
            "the offsets of " + name + " wander less than the scene's " + told +
                " says" + (is_floor ? "" : ": " + fitting + " fits") +
                ". Contacts that are held come out less exact, or "
                "unobservable",
            remedy};
  }
  const std::string unobservable =
      "; its contacts are unobservable once that shows";
  if (verdict == Verdict::kTooSmall) {
    return {"offset_walk",
            "the offsets of " + name + " wander more than the scene's " + told +
                " says: " + fitting + " fits" + unobservable,
            remedy};
  }
  std::string drifts;
  for (const double moved_V : walk.moved_V) {
    drifts += FormatText("%s%+.2g", drifts.empty() ? "" : ", ",
                         1e3 * moved_V / walk.moved_s);
  }
  return {"offset_walk",
          "the offsets of " + name + " drift steadily, by " + drifts +
              " mV/s, which the scene's walk of " + told + " is not" +
              unobservable,
          "let the gauges warm up, or take the drift out of the readings; a "
          "walk must be as large as the drift between two free stretches"};
}

Warning ChangesDiffer(const LogSummary& log, const Finger& /*finger*/,
                      const std::string& name) {
  const EstimationSummary& summary = *log.summary;
  return {"smoothing",
          FormatText("contacts of %s change from frame to frame by %.2g times "
                     "what the scene's smoothing says, so that their std are "
                     "too small",
                     name.c_str(),
                     std::sqrt(summary.change_chi2 / summary.change_dof)),
          "say larger std in the scene's smoothing"};
}

Warning Alone(const LogSummary& log, const Finger& /*finger*/,
              const std::string& name) {
  const EstimationSummary& summary = *log.summary;
  return {"not_joint",
          "the frames of " + name +
              " could not be solved together: the problem does not converge; " +
              std::to_string(summary.alone) + " of " +
              std::to_string(summary.frames) + " are estimated one by one",
          "look for moved offsets, and at the std of the scene's "
          "gauge_offset_walk: too large ones leave a long touch open"};
}

Warning BadRows(const LogSummary& log, const Finger& /*finger*/,
                const std::string& name) {
  const EstimationSummary& summary = *log.summary;
  return {
      "bad_rows",
      std::to_string(summary.bad_rows) + " of " +
          std::to_string(summary.frames + summary.bad_rows) + " rows of " +
          name + " are bad and left out",
      "their lines and reasons are in <log>.bad_rows.csv beside the result"};
}

Warning Impossible(const LogSummary& log, const Finger& finger,
                   const std::string& name) {
  const EstimationSummary& summary = *log.summary;
  const Gauge& gauge = finger.gauges.at(summary.impossible_gauge - 1);
  const double most_V = LargestBending_V(gauge);
  return {"impossible_readings",
          std::to_string(summary.impossible) + " of " +
              std::to_string(summary.frames) + " rows of " + name +
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
  Warning (*warning)(const LogSummary&, const Finger&, const std::string&);
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
  // Warns of the log with the most frames that show it.
  const auto warn = [&](const auto& applies, auto frames, const auto& warning) {
    const LogSummary* worst = nullptr;
    std::size_t count = 0;
    for (const LogSummary& log : logs) {
      if (!applies(log)) continue;
      ++count;
      if (!worst || log.summary->*frames > worst->summary->*frames) {
        worst = &log;
      }
    }
    if (!worst) return;
    std::string name = worst->log;
    if (count > 1) {
      name += " (the worst of " + std::to_string(count) + " logs)";
    }
    warnings.push_back(warning(*worst, name));
  };
  warn(IsFaulty, &EstimationSummary::frames, Faulty);
  for (const Doubt& doubt : kDoubts) {
    warn([&](const LogSummary& log) { return (log.summary->*doubt.applies)(); },
         doubt.frames,
         [&](const LogSummary& log, const std::string& name) {
           return doubt.warning(log, finger, name);
         });
  }
  return warnings;
}

bool NeedsCause(const EstimationSummary& summary) {
  return summary.unexplained_too_many() || summary.unexplained_some() ||
         summary.forces_differ() ||
         (summary.never_free() && summary.any_free_rows());
}

bool FailsStrict(const std::vector<Warning>& warnings, const Scene& scene) {
  return std::any_of(
      warnings.begin(), warnings.end(), [&](const Warning& warning) {
        return warning.code == "gauge_fault" ||
               warning.code == "unexplained_frames" ||
               warning.code == "forces_differ" ||
               warning.code == "offset_walk" || warning.code == "smoothing" ||
               (warning.code == "never_free" && !scene.contacts);
      });
}

}  // namespace finray
