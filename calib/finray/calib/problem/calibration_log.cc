#include "finray/calib/problem/calibration_log.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "finray/calib/problem/repeated_rows.h"
#include "finray/io/error.h"
#include "finray/io/frame_table.h"
#include "finray/io/frame_vocabulary.h"
#include "finray/io/message_text.h"
#include "finray/io/nan.h"
#include "finray/io/number_text.h"
#include "finray/scene/frame_columns.h"
#include "finray/scene/measurement_columns.h"

namespace finray {
namespace {

constexpr double kSignificant = 3;  // standard deviations
// In a long log noise alone reads above the bound of a free row. Up to so many
// times the bound an object that is out of reach contradicts the force.
constexpr double kWeak = 2;
// Whole blocks of neighbouring frames are held out, because neighbours share
// errors.
constexpr int kHoldoutBlock = 10;

// Returns how far the circle reaches into the undeformed finger, in mm.
double Reach(const CalibrationFrame& frame, const Finger& finger,
             const Plan& plan) {
  // The undeformed front beam lies on x = 0.
  const double nearest_y =
      std::clamp(frame.object_mm.y(), 0.0, finger.front_length_mm);
  const double over = frame.object_mm.y() - nearest_y;
  return frame.object_mm.x() +
         std::sqrt(std::max(
             0.0, std::pow(*plan.scene.circle_radius_mm(), 2) - over * over));
}

struct Touch {
  bool contact, undecided;
};

Touch TouchOf(const CalibrationFrame& frame, const Finger& finger,
              const Plan& plan) {
  if (frame.IsBench()) return {false, false};
  if (plan.scene.contacts) return {*plan.scene.contacts > 0, false};
  const bool object =
      frame.object_mm.allFinite() && plan.scene.circle_radius_mm();
  const FamilyPlan& offset = plan.family(ParameterFamily::kForceOffset);
  const FamilyPlan& weight = plan.family(ParameterFamily::kForceWeight);
  const double place_std_mm = plan.PlaceStd_mm(finger.front_length_mm);
  const bool object_known = std::isfinite(place_std_mm);
  const MeasuredForce force = frame.Force();
  const double reach_std =
      object ? Reach(frame, finger, plan) /
                   (object_known ? place_std_mm : plan.object_std_mm)
             : 0;
  if (force.IsMeasured() && !(object && !plan.ForceZeroIsKnown())) {
    const double std_N =
        std::hypot(frame.ForceStd_N(plan), offset.prior_std.value_or(0),
                   weight.prior_std.value_or(0));
    const bool contact = force.magnitude_N > 0 && !force.IsWithinNoise(std_N);
    if (!object || !object_known) return {contact, false};
    const bool reaches = reach_std > -kSignificant;
    return {contact,
            contact ? !reaches && force.IsWithinNoise(kWeak * std_N) : reaches};
  }
  if (!object) return {true, false};
  return {reach_std > kSignificant,
          object_known && std::abs(reach_std) <= kSignificant};
}

void MarkHoldout(const Plan& plan, CalibrationLogs* logs) {
  if (plan.holdout_by == HoldoutBy::kNothing) return;
  // Says whether log or block i of n is held out. The chosen ones are the
  // plan's fraction of n, rounded and evenly spread.
  const auto chosen = [&](int i, int n) {
    const int count = std::clamp(
        static_cast<int>(std::lround(plan.holdout_fraction * n)), 1, n - 1);
    return (i + 1) * count / n > i * count / n;
  };
  const bool by_log = plan.holdout_by == HoldoutBy::kLog;
  const auto block_of = [&](const CalibrationFrame& frame) {
    return std::pair(frame.log, by_log ? 0 : frame.row / kHoldoutBlock);
  };
  // The place of each log or block. Logs of the bench are always fitted.
  std::map<std::pair<int, int>, int> places;
  for (const CalibrationFrame& frame : logs->frames) {
    if (!frame.IsBench()) places[block_of(frame)] = 0;
  }
  int n = 0;
  for (auto& [block, place] : places) place = n++;
  if (n < 2 && by_log) {
    throw InputError(
        "holdout by log needs at least 2 logs of the finger, got " +
        std::to_string(n) + "; use {by: block}");
  }
  if (n < 2) {
    throw InputError("holdout by block: the logs are too short, " +
                     std::to_string(logs->frames.size()) +
                     " frames in all; blocks have " +
                     std::to_string(kHoldoutBlock));
  }
  for (CalibrationFrame& frame : logs->frames) {
    if (!frame.IsBench())
      frame.held_out = chosen(places.at(block_of(frame)), n);
  }
}

// Returns the shortest part of each path that differs from all others.
std::vector<std::string> NamesOf(const std::vector<std::string>& paths) {
  std::vector<std::string> names;
  for (const std::string& path : paths) {
    names.push_back(std::filesystem::path(path).filename().string());
  }
  const std::vector<std::string> short_names = names;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (std::count(short_names.begin(), short_names.end(), names[i]) == 1) {
      continue;
    }
    names[i] = paths[i];
    if (std::count(paths.begin(), paths.end(), paths[i]) > 1) {
      names[i] += "#" + std::to_string(i + 1);
    }
  }
  return names;
}

// Reads a column that a free parameter needs. A cell without a number gets the
// number of the row before. Cells before the first number get that one.
std::vector<double> Needed(const FrameTable& table, const char* column,
                           const char* parameter) {
  if (!table.Has(column)) {
    throw InputError(table.path() + ": " + NoColumn(column, table.headers()) +
                     "; the plan's " + parameter + " needs it");
  }
  std::vector<double> values = table.Numbers(column);
  const auto measured = [](double value) { return std::isfinite(value); };
  const auto first = std::find_if(values.begin(), values.end(), measured);
  if (first == values.end()) {
    throw InputError(table.path() + ": column '" + column +
                     "' has no number; the plan's " + parameter + " needs it");
  }
  double last = *first;
  for (double& value : values) last = value = measured(value) ? value : last;
  return values;
}

void RefuseWithoutMeasurements(const Plan& plan, const CalibrationLogs& logs) {
  const auto none = [&](auto&& has) {
    return std::none_of(logs.frames.begin(), logs.frames.end(), has);
  };
  for (const auto& [family, name] :
       {std::pair(ParameterFamily::kForceScale, "force_scale"),
        std::pair(ParameterFamily::kForceOffset, "force_offset"),
        std::pair(ParameterFamily::kForceTimeOffset, "force_time_offset")}) {
    if (plan.family(family).free && none([](const CalibrationFrame& frame) {
          return frame.Force().IsMeasured();
        })) {
      throw InputError(std::string("plan: ") + name +
                       " is free, but no log has a force_N, or a force_x_N "
                       "and force_y_N");
    }
  }
  for (const auto& [family, name] :
       {std::pair(ParameterFamily::kForceTilt, "force_tilt"),
        std::pair(ParameterFamily::kForceWeight, "force_weight")}) {
    if (plan.family(family).free && none([](const CalibrationFrame& frame) {
          return frame.force_xy_N.allFinite();
        })) {
      throw InputError(std::string("plan: ") + name +
                       " is free, but no log has a force_x_N and force_y_N");
    }
  }
  if (plan.family(ParameterFamily::kCameraOrigin).free && !plan.pin_std_mm &&
      !plan.tip_std_mm) {
    throw InputError(
        "plan: camera_origin is free, but measurements have no pin_std_mm and "
        "no tip_std_mm, so that nothing a camera saw is used");
  }
  if (plan.pin_std_mm &&
      none([](const CalibrationFrame& frame) { return !frame.pins.empty(); })) {
    throw InputError(
        "plan: there is a pin_std_mm, but no log has both coordinates of a "
        "rib's pin (rib_1_front_x_mm, rib_1_front_y_mm, ...)");
  }
  if (plan.tip_std_mm && none([](const CalibrationFrame& frame) {
        return frame.tip_mm.allFinite();
      })) {
    throw InputError(
        "plan: there is a tip_std_mm, but no log has a tip_x_mm and tip_y_mm");
  }
}

// Every row of a bench log has a cylinder.
bool IsBenchLog(const FrameTable& table) {
  const std::vector<double> radii = table.NumbersOrNan("cylinder_radius_mm");
  for (std::size_t row = 0; row < radii.size(); ++row) {
    if (radii[row] == 0) {
      throw InputError(table.path() + ":" + std::to_string(table.line(row)) +
                       ": cylinder_radius_mm: expected a radius, inf if "
                       "flat, found 0");
    }
  }
  return !radii.empty() &&
         std::none_of(radii.begin(), radii.end(),
                      [](double radius) { return std::isnan(radius); });
}

// Refuses numbers that no sensor reads: the sum of squares would overflow.
// Tables of arrays have not come through the reader of logs.
void RefuseHugeCells(const FrameTable& table, int gauges) {
  const auto refuse = [&](const std::string& name, double largest) {
    const std::vector<double> values = table.NumbersOrNan(name);
    for (std::size_t row = 0; row < values.size(); ++row) {
      if (!(std::abs(values[row]) > largest)) {
        continue;
      }
      throw InputError(
          table.path() + ":" + std::to_string(table.line(row)) + ": " + name +
          ": expected a magnitude of " +
          FormatText("at most %g, found %g", largest, values[row]));
    }
  };
  for (const std::string& name : table.headers()) {
    if (std::isfinite(LargestIn(name))) refuse(name, LargestIn(name));
  }
  for (int j = 0; j < gauges; ++j) refuse(GaugeVolts(j), kLargestMeasured);
}

// Refuses one of two coordinates, and a force whose column is nearly named so:
// a calibration without them would look like one that needed none.
void RefuseNearlyNamed(const FrameTable& table) {
  const std::vector<std::string> headers = table.headers();
  const auto refuse = [&](const std::string& name) {
    throw InputError(table.path() + ": " + NoColumn(name, headers));
  };
  for (const auto& [x, y] : {std::pair("object_x_mm", "object_y_mm"),
                             std::pair("force_x_N", "force_y_N")}) {
    if (table.Has(x) != table.Has(y)) refuse(table.Has(x) ? y : x);
  }
  const bool has_force = table.Has("force_N") || table.Has("force_x_N");
  if (has_force || DidYouMean("force_N", headers).empty()) return;
  refuse("force_N");
}

// Returns the std of one reading of an axis of the force sensor, the root mean
// square of its scatter about the rows; nothing where the log does not tell.
std::optional<double> ForceScatter_N(const FrameTable& table) {
  double squares = 0;
  int count = 0;
  for (const char* name :
       {"force_scatter_N", "force_x_scatter_N", "force_y_scatter_N"}) {
    for (const double std_N : table.NumbersOrNan(name)) {
      if (!(std_N > 0 && std_N < kLargestMeasured)) continue;
      squares += std_N * std_N;
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  return std::sqrt(squares / count);
}

// Refuses forces with the other sign: force_N is a magnitude, and only noise
// takes those of free rows below zero. A few wrong rows are rejected later.
void RefuseTurnedForces(const FrameTable& table, const Plan& plan) {
  if (!table.Has("force_N")) return;
  std::size_t below = 0, above = 0, first = 0;
  double sum_N = 0;
  const std::vector<double>& forces = table.Numbers("force_N");
  for (std::size_t row = 0; row < forces.size(); ++row) {
    if (!(std::abs(forces[row]) > kSignificant * plan.force_std_N)) continue;
    sum_N += forces[row];
    if (forces[row] < 0 && below++ == 0) first = row;
    above += forces[row] > 0;
  }
  if (below <= above || sum_N >= 0) return;
  throw InputError(
      table.path() + ":" + std::to_string(table.line(first)) +
      FormatText(": force_N: expected a magnitude, 0 or more, found %g; %zu of "
                 "%zu forces are negative; scale: -1 in the plan's columns "
                 "turns their sign",
                 forces[first], below, below + above));
}

// Reads the rows of one log. A log with pins may lack all gauges, but not only
// some. A bench log may lack some, because its gauges are bent one by one.
std::vector<CalibrationFrame> ReadLog(const FrameTable& table,
                                      const Finger& finger, const Plan& plan) {
  const bool bench = IsBenchLog(table);
  const auto gauges = static_cast<int>(finger.gauges.size());
  bool pins = false;
  for (int i = 0; i < static_cast<int>(finger.ribs.size()); ++i) {
    pins |= plan.pin_std_mm && (table.Has(RibPin(i, "front", "x")) ||
                                table.Has(RibPin(i, "back", "x")));
  }
  int found = 0;
  for (int j = 0; j < gauges; ++j) found += table.Has(GaugeVolts(j));
  MeasurementColumns::Options options;
  options.angles = false;
  options.gauges_may_lack = bench ? found > 0 : found == 0 && pins;
  options.camera = true;
  std::vector<Measurements> rows = ReadMeasurements(table, finger, options);
  RefuseHugeCells(table, gauges);
  RefuseNearlyNamed(table);
  RefuseTurnedForces(table, plan);
  std::vector<double> times, temperatures;
  if (!bench && plan.family(ParameterFamily::kGaugeDrift).free) {
    times = Needed(table, "time_s", "gauge_drift");
  } else if (!bench && plan.HasCreep(finger)) {
    times = Needed(table, "time_s", "creep of gauges");
  } else if (!bench && plan.family(ParameterFamily::kForceTimeOffset).free) {
    times = Needed(table, "time_s", "force_time_offset");
  }
  if (!bench && plan.family(ParameterFamily::kTemperatureCoefficient).free) {
    temperatures = Needed(table, "temperature_C", "temperature_coefficient");
  }
  const std::optional<double> force_reading_std_N =
      plan.force_std_stated ? std::nullopt : ForceScatter_N(table);
  std::vector<CalibrationFrame> frames(rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    CalibrationFrame& frame = frames[row];
    static_cast<Measurements&>(frame) = std::move(rows[row]);
    frame.row = static_cast<int>(row);
    if (plan.gauge_std_V) frame.gauge_readings = 1;
    if (force_reading_std_N && frame.force_readings > 1) {
      frame.force_std_times =
          Measurements::MeanStd(*force_reading_std_N, frame.force_readings) /
          plan.force_std_N;
    }
    for (int j = 0; j < gauges; ++j) {
      double& volts = frame.gauges_V[j];
      if (!finger.gauges[j].IsMeasured(volts)) volts = std::nan("");
    }
    if (!times.empty()) frame.time_s = times[row];
    if (!temperatures.empty()) frame.temperature_C = temperatures[row];
    if (!frame.object_mm.allFinite()) frame.object_mm.setConstant(std::nan(""));
    if (!plan.pin_std_mm) frame.pins.clear();
    if (!plan.tip_std_mm) frame.tip_mm.setConstant(std::nan(""));
  }
  return frames;
}

}  // namespace

std::vector<bool> CalibrationLogs::HeldOut() const {
  std::vector<bool> held_out(paths.size(), true);
  for (const CalibrationFrame& frame : frames) {
    if (!frame.held_out) held_out[frame.log] = false;
  }
  return held_out;
}

namespace {

// The scatter of single readings about the rows of all logs.
class ReadingScatter {
 public:
  explicit ReadingScatter(std::size_t gauges)
      : squares_(gauges), counts_(gauges) {}

  void Add(const FrameTable& table) {
    for (std::size_t j = 0; j < squares_.size(); ++j) {
      for (const double std_V : table.NumbersOrNan(
               IndexedColumn("gauge_", static_cast<int>(j), "_scatter_V"))) {
        if (!std::isfinite(std_V)) continue;
        squares_[j] += std_V * std_V;
        ++counts_[j];
      }
    }
  }
  std::vector<double> Std_V() const {
    std::vector<double> std_V;
    for (std::size_t j = 0; j < squares_.size(); ++j) {
      std_V.push_back(counts_[j] > 0 ? std::sqrt(squares_[j] / counts_[j])
                                     : std::nan(""));
    }
    return std_V;
  }

 private:
  std::vector<double> squares_;
  std::vector<int> counts_;
};

// table(i) returns the log of the i-th path.
template <class Table>
CalibrationLogs MakeLogs(const std::vector<std::string>& paths,
                         const Finger& finger, const Plan& plan, Table table) {
  CalibrationLogs logs;
  logs.paths = paths;
  logs.names = NamesOf(paths);
  ReadingScatter scatter(finger.gauges.size());
  std::vector<std::vector<double>> times_s;  // NaN for the bench
  for (std::size_t log = 0; log < paths.size(); ++log) {
    const FrameTable& rows = table(log);
    scatter.Add(rows);
    times_s.push_back(IsBenchLog(rows) ? std::vector<double>(rows.rows(), kNaN)
                                       : rows.NumbersOrNan("time_s"));
    for (CalibrationFrame& frame : ReadLog(rows, finger, plan)) {
      frame.log = static_cast<int>(log);
      const Touch touch = TouchOf(frame, finger, plan);
      frame.contact = touch.contact;
      // Gauges decide.
      frame.undecided =
          touch.undecided &&
          std::any_of(frame.gauges_V.begin(), frame.gauges_V.end(),
                      [](double volts) { return std::isfinite(volts); });
      logs.frames.push_back(std::move(frame));
    }
  }
  LeaveOutCopies(std::move(times_s), &logs);
  logs.reading_std_V = scatter.Std_V();
  RefuseWithoutMeasurements(plan, logs);
  MarkHoldout(plan, &logs);
  MarkRepeatedRows(plan, &logs);
  return logs;
}

}  // namespace

CalibrationLogs ReadCalibrationLogs(const std::vector<std::string>& paths,
                                    const Finger& finger, const Plan& plan) {
  return MakeLogs(paths, finger, plan, [&](std::size_t log) {
    return FrameTable::Read(paths[log], plan.columns);
  });
}

CalibrationLogs ReadCalibrationLogs(const std::vector<FrameTable>& tables,
                                    const Finger& finger, const Plan& plan) {
  std::vector<std::string> names;
  for (const FrameTable& table : tables) names.push_back(table.path());
  return MakeLogs(
      names, finger, plan,
      [&](std::size_t log) -> const FrameTable& { return tables[log]; });
}

}  // namespace finray
