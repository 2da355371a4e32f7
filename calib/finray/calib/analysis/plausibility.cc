#include "finray/calib/analysis/plausibility.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "finray/calib/analysis/gauge_changes.h"
#include "finray/calib/analysis/gauge_plausibility.h"
#include "finray/calib/problem/median.h"
#include "finray/calib/solve/contact_guess.h"
#include "finray/finger/geometry.h"
#include "finray/io/error.h"
#include "finray/io/number_text.h"
#include "finray/scene/frame_columns.h"
#include "finray/scene/gauge_faults.h"
#include "finray/statics/equilibrium.h"

namespace finray {
namespace {

using From = ContactGuess::From;

// At most so many frames are looked at.
constexpr std::size_t kLooked = 100;

using FramesOfLogs = std::vector<const CalibrationFrame*>;

// Returns fitted frames that touch, or free ones, evenly spread.
FramesOfLogs SomeFrames(const CalibrationProblem& problem, bool touching) {
  FramesOfLogs all;
  for (const CalibrationFrame& frame : problem.logs().frames) {
    if (frame.contact == touching && !frame.held_out && !frame.IsBench() &&
        (touching || !frame.undecided)) {
      all.push_back(&frame);
    }
  }
  const std::size_t count = std::min(all.size(), kLooked);
  FramesOfLogs some;
  for (std::size_t k = 0; k < count; ++k) {
    some.push_back(all[k * all.size() / count]);
  }
  return some;
}

template <class... Values>
[[noreturn]] void Refuse(const char* format, Values... values) {
  throw InputError(FormatText(format, values...));
}

// Returns the frame with nothing but the object to tell its contact.
CalibrationFrame WithoutForce(const CalibrationFrame& frame) {
  CalibrationFrame object = frame;
  object.force_N = object.contact_mm = CalibrationFrame::kNotMeasured;
  object.force_xy_N.setConstant(CalibrationFrame::kNotMeasured);
  return object;
}

struct Press {
  int log;
  double force_N, x_mm, y_mm;
};

std::vector<Press> Presses(const FramesOfLogs& frames) {
  std::vector<Press> presses;
  for (const CalibrationFrame* frame : frames) {
    const double force = frame->Force().magnitude_N;
    if (!std::isfinite(force) || !frame->object_mm.allFinite()) continue;
    presses.push_back(
        {frame->log, force, frame->object_mm.x(), frame->object_mm.y()});
  }
  return presses;
}

// Returns the range from the 10th to the 90th percentile.
double Range(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() * 9 / 10] - values[values.size() / 10];
}

double Range(const std::vector<Press>& presses, double Press::*quantity) {
  std::vector<double> values;
  for (const Press& press : presses) values.push_back(press.*quantity);
  return Range(std::move(values));
}

// Makes the check that holds wherever the contacts are.
void RefuseImpossibleBends(const FramesOfLogs& frames, const Finger& finger) {
  for (int j = 0; j < static_cast<int>(finger.gauges.size()); ++j) {
    std::map<int, std::vector<double>> logs;
    for (const CalibrationFrame* frame : frames) {
      const double volts = frame->gauges_V[j];
      if (std::isfinite(volts)) logs[frame->log].push_back(volts);
    }
    for (const auto& [log, volts] : logs) {
      const double bend = Range(volts) / finger.gauges[j].gain_V_per_rad;
      if (std::abs(bend) < kMostBend) continue;
      Refuse(
          "logs: %s varies by %.3g, which is a bend of %.3g rad by the "
          "finger's gain: expected readings in V; are these mV or counts?",
          GaugeVolts(j).c_str(), Range(volts), std::abs(bend));
    }
  }
}

// Makes the check that needs no model at all.
void RefuseFaultyGauges(const CalibrationProblem& problem) {
  for (const auto& [log, faults] :
       FindGaugeFaults(problem.logs(), problem.finger())) {
    const std::string words = WordsOf(faults, false);
    if (words.empty()) continue;
    const bool all = faults[0].kind == GaugeFault::Kind::kAllStill;
    throw InputError(
        "logs: " + problem.logs().names[log] + ": " + words +
        (all ? "; look at the cable, the unit and the logger, and record anew"
             : ": check its wiring, its range and its column; leave these "
               "cells empty, or record anew"));
  }
}

// Returns the correlation of force and x about their means in each tenth of the
// height of each log. Returns 0 if x varies there by no more than a few std.
double CorrelationOfForceAndX(const std::vector<Press>& presses,
                              double height_mm, double object_std_mm) {
  constexpr double kMove = 5;  // in std
  std::map<std::pair<int, int>, std::vector<Press>> tenths;
  for (const Press& press : presses) {
    const double tenth =
        std::clamp(std::floor(10 * press.y_mm / height_mm), -1e6, 1e6);
    tenths[{press.log, static_cast<int>(tenth)}].push_back(press);
  }
  double ff = 0, fx = 0, xx = 0;
  for (const auto& [tenth, its] : tenths) {
    double force = 0, x = 0;
    for (const Press& press : its) {
      force += press.force_N / static_cast<double>(its.size());
      x += press.x_mm / static_cast<double>(its.size());
    }
    for (const Press& press : its) {
      ff += (press.force_N - force) * (press.force_N - force);
      fx += (press.force_N - force) * (press.x_mm - x);
      xx += (press.x_mm - x) * (press.x_mm - x);
    }
  }
  const auto dof = static_cast<double>(presses.size() - tenths.size());
  return ff > 0 && xx > dof * std::pow(kMove * object_std_mm, 2)
             ? fx / std::sqrt(ff * xx)
             : 0;
}

// Makes the checks that hold wherever the object's origin is.
void RefuseImplausibleMotion(const std::vector<Press>& presses,
                             const Finger& finger, const Plan& plan) {
  // A smaller change of force, in std, means nothing.
  constexpr double kNoise = 10;
  if (presses.size() < 10) return;
  const double change = Range(presses, &Press::force_N);
  if (change < kNoise * plan.force_std_N) return;
  const double moved =
      std::max(Range(presses, &Press::x_mm), Range(presses, &Press::y_mm));
  if (change > kMostStiffness * ForceUnit(finger) / finger.front_length_mm *
                   std::max(moved, 1e-9)) {
    Refuse(
        "logs: forces change by %.3g N while the object moves by %.3g mm: are "
        "object_x_mm and object_y_mm in mm, and of the same rows?",
        change, moved);
  }
  const double correlation = CorrelationOfForceAndX(
      presses, finger.front_length_mm, plan.object_std_mm);
  if (correlation < kLeastCorrelation) {
    Refuse(
        "logs: the force falls as object_x_mm rises (correlation %.2f): +x "
        "points from the front beam into the finger; check its sign and "
        "column",
        correlation);
  }
}

// Says that the place of the object is known well enough for these checks.
bool ObjectIsKnown(const CalibrationProblem& problem) {
  constexpr double kMost_mm = 2;
  return problem.plan().PlaceStd_mm(problem.finger().front_length_mm) <
         kMost_mm;
}

// Returns what the gauges would read at contacts that are known without them:
// from the place of the object, which holds for any stiffness, or from the
// place and force of the contact.
std::vector<ExpectedGauges> ExpectGauges(const FramesOfLogs& frames,
                                         CalibrationProblem* problem,
                                         ContactGuess* guess) {
  const bool object_known =
      problem->plan().scene.circle_radius_mm() && ObjectIsKnown(*problem);
  EquilibriumSolver solver(problem->finger(), problem->discretization());
  std::vector<ExpectedGauges> expected;
  for (const CalibrationFrame* frame : frames) {
    const bool by_object = object_known && frame->object_mm.allFinite();
    if (!by_object &&
        (!std::isfinite(frame->contact_mm) || !frame->Force().IsMeasured())) {
      continue;
    }
    const ContactGuess::Place place = guess->Of(
        by_object ? WithoutForce(*frame) : *frame, From::kObjectFirst);
    if ((by_object && !place.met) ||
        !solver.Solve({{place.arc_mm, place.normal_N}})) {
      continue;
    }
    ExpectedGauges gauges{frame->log, frame->row, frame->gauges_V, {}};
    for (int j = 0; j < static_cast<int>(gauges.read_V.size()); ++j) {
      gauges.expected_rad.push_back(solver.gauge_angle(j));
    }
    expected.push_back(std::move(gauges));
  }
  return expected;
}

// Adds free frames, in the order of rows.
std::vector<ExpectedGauges> WithFree(std::vector<ExpectedGauges> expected,
                                     const CalibrationProblem& problem) {
  const std::vector<double> unbent(problem.finger().gauges.size(), 0.0);
  for (const CalibrationFrame* frame : SomeFrames(problem, false)) {
    expected.push_back({frame->log, frame->row, frame->gauges_V, unbent});
  }
  std::sort(expected.begin(), expected.end(),
            [](const ExpectedGauges& a, const ExpectedGauges& b) {
              return std::pair(a.log, a.row) < std::pair(b.log, b.row);
            });
  return expected;
}

// FramesOfLogs with the object elsewhere.
std::vector<CalibrationFrame> Moved(
    const FramesOfLogs& frames,
    const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& to) {
  std::vector<CalibrationFrame> moved;
  for (const CalibrationFrame* frame : frames) {
    if (!frame->object_mm.allFinite()) continue;
    moved.push_back(*frame);
    moved.back().object_mm = to(frame->object_mm);
  }
  return moved;
}

FramesOfLogs PointersTo(const std::vector<CalibrationFrame>& frames) {
  FramesOfLogs pointers;
  for (const CalibrationFrame& frame : frames) pointers.push_back(&frame);
  return pointers;
}

// The number of objects that would touch the finger from there.
int MetIf(const std::vector<CalibrationFrame>& moved, ContactGuess* guess) {
  return static_cast<int>(
      std::count_if(moved.begin(), moved.end(), [&](const auto& frame) {
        return guess->Of(WithoutForce(frame), From::kObjectFirst).met;
      }));
}

// Returns the offsets c of y' = c - y that are likely if +y points from the tip
// to the base: the stage counts from the base, from the tip, or from the other
// end of its way.
std::vector<double> MirrorsOfY(const FramesOfLogs& frames,
                               const Finger& finger) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const CalibrationFrame* frame : frames) {
    if (!frame->object_mm.allFinite()) continue;
    low = std::min(low, frame->object_mm.y());
    high = std::max(high, frame->object_mm.y());
  }
  return {0, finger.front_length_mm, low + high};
}

Eigen::Vector2d MirroredY(const Eigen::Vector2d& at, double mirror) {
  return {at.x(), mirror - at.y()};
}

constexpr char kMirrored[] =
    "if y ran the other way: +y points from the base to the tip; check the "
    "sign "
    "of object_y_mm, or the direction of that axis of the stage";

// Gauges that objects do not explain, but objects mirrored in y do.
void RefuseMirroredY(const FramesOfLogs& frames,
                     const std::vector<ExpectedGauges>& expected,
                     CalibrationProblem* problem, ContactGuess* guess) {
  const double rest = UnexplainedShare(expected, problem->finger());
  if (!(rest > kLeastUnexplained)) return;
  for (const double mirror : MirrorsOfY(frames, problem->finger())) {
    const std::vector<CalibrationFrame> moved =
        Moved(frames, [&](const auto& at) { return MirroredY(at, mirror); });
    const double then = UnexplainedShare(
        ExpectGauges(PointersTo(moved), problem, guess), problem->finger());
    if (!(then < rest / kMirrorExplains)) continue;
    Refuse("logs: gauges bend as they would %s", kMirrored);
  }
}

// Makes the checks of objects whose places are known.
void RefuseImplausibleObjects(const FramesOfLogs& frames,
                              const CalibrationProblem& problem,
                              ContactGuess* guess) {
  const Plan& plan = problem.plan();
  if (!plan.scene.circle_radius_mm() || !ObjectIsKnown(problem)) return;
  std::vector<double> ratios;
  int objects = 0, met = 0;
  for (const CalibrationFrame* frame : frames) {
    if (!frame->object_mm.allFinite()) continue;
    const ContactGuess::Place place =
        guess->Of(WithoutForce(*frame), From::kObjectFirst);
    ++objects;
    met += place.met;
    const double force = frame->Force().magnitude_N;
    // An object may be where it presses with no force at all.
    const double least = 1e-6 * ForceUnit(problem.finger());
    if (place.met && force > 0) {
      ratios.push_back(force / std::max(place.normal_N, least));
    }
  }
  if (objects >= 4 && 2 * met < objects) {
    const auto met_if = [&](const auto& to) {
      return 2 * MetIf(Moved(frames, to), guess) > objects;
    };
    if (met_if(
            [](const auto& at) { return Eigen::Vector2d(at.y(), at.x()); })) {
      Refuse(
          "logs: of %d frames with contact the circle can touch the finger in "
          "%d, and in most if the columns are exchanged: are object_x_mm and "
          "object_y_mm swapped?",
          objects, met);
    }
    if (met_if([](const auto& at) { return MirroredY(at, 0); })) {
      Refuse(
          "logs: of %d frames with contact the circle can touch the finger in "
          "%d, and in most %s",
          objects, met, kMirrored);
    }
    Refuse(
        "logs: of %d frames with contact the circle of radius %g mm can touch "
        "the finger in %d: check units, signs and columns of object_x_mm and "
        "object_y_mm, the radius, or free object_origin",
        objects, *plan.scene.circle_radius_mm(), met);
  }
  if (ratios.size() < 4) return;
  const double ratio = Median(ratios);
  if (ratio > kFactor || ratio < 1 / kFactor) {
    Refuse(
        "logs: forces are %.3g times those that would press the finger to "
        "where the objects are: check the units of force and positions, and "
        "the "
        "finger's stiffness",
        ratio);
  }
}

}  // namespace

void RefuseImplausible(CalibrationProblem* problem) {
  const Plan& plan = problem->plan();
  const FramesOfLogs frames = SomeFrames(*problem, true);
  std::vector<double> forces;
  for (const CalibrationFrame* frame : frames) {
    const double force = frame->Force().magnitude_N;
    if (std::isfinite(force)) forces.push_back(force);
  }
  const double unit = ForceUnit(problem->finger());
  if (!forces.empty()) {
    const double median = Median(forces);
    if (median < kLeastForce * unit || median > kMostForce * unit) {
      Refuse(
          "logs: the median force of frames with contact is %.3g N; of this "
          "finger %.2g to %.2g N are expected: is the column in N, and the "
          "finger's stiffness in N mm^2?",
          median, kLeastForce * unit, kMostForce * unit);
    }
  }
  RefuseImplausibleMotion(Presses(frames), problem->finger(), plan);
  RefuseImpossibleBends(frames, problem->finger());
  // A coarse gauge looks clipped.
  RefuseCoarserSteps(problem->logs(), problem->finger());
  RefuseFaultyGauges(*problem);
  ContactGuess guess(problem);
  RefuseImplausibleObjects(frames, *problem, &guess);
  // Last: what is expected of the gauges follows from the objects.
  const std::vector<ExpectedGauges> expected =
      ExpectGauges(frames, problem, &guess);
  RefuseGaugeChanges(WithFree(expected, *problem), problem->logs(),
                     problem->finger());
  RefuseMirroredY(frames, expected, problem, &guess);
  RefuseImplausibleGauges(expected, problem->finger());
}

}  // namespace finray
