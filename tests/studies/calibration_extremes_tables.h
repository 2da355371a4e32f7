#ifndef FINRAY_TESTS_STUDIES_CALIBRATION_EXTREMES_TABLES_H_
#define FINRAY_TESTS_STUDIES_CALIBRATION_EXTREMES_TABLES_H_

#include <cmath>
#include <string>
#include <vector>

#include "studies/calibration_extremes.h"
#include "studies/table_text.h"

namespace finray {

/// All noise times a factor, of the log and as told.
inline CalibrationCase WithNoiseTimes(double factor) {
  CalibrationCase c;
  for (Gauge& gauge : c.truth.gauges) gauge.noise_V *= factor;
  c.start = NominalWithNoiseOf(c.truth);
  c.force_std_N *= factor;
  c.object_std_mm *= factor;
  c.plan.force_std_N = c.force_std_N;
  c.plan.object_std_mm = c.object_std_mm;
  return c;
}

/// Noise as a share of what is measured: of the rms of each gauge's reading,
/// of the force and of how far the object is pushed in.
inline CalibrationCase WithNoiseOfReading(double share) {
  CalibrationCase c;
  const FrameTable frames = StandardFrames(c.truth, 1);
  const auto rms = [&](const std::string& name, double zero) {
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < frames.rows(); ++i) {
      if (i % 21 == 0) continue;  // the free ones
      sum += std::pow(frames.Numbers(name)[i] - zero, 2);
      ++count;
    }
    return std::sqrt(sum / count);
  };
  for (int j = 0; j < 4; ++j) {
    Gauge& gauge = c.truth.gauges[j];
    gauge.noise_V = share * rms(GaugeVolts(j), gauge.offset_V);
  }
  c.start = NominalWithNoiseOf(c.truth);
  c.plan.force_std_N = c.force_std_N = share * rms("force_N", 0);
  c.plan.object_std_mm = c.object_std_mm = share * rms("object_x_mm", -15);
  return c;
}

inline void CalibrationNoiseTable(int seeds) {
  PrintCalibrationHeader("noise of gauges, force and object");
  for (const bool priors : {true, false}) {
    CalibrationCase c;
    c.noisy_gauges = false;
    c.force_std_N = c.object_std_mm = 0;
    if (!priors) c.plan = WithoutPriors(c.plan);
    PrintCalibration(
        std::string("0, told as usual, ") + (priors ? "priors" : "no priors"),
        RunCalibration(c, seeds));
  }
  for (const double factor : {1e-9, 1e-6, 1e-3, 1.0, 10.0}) {
    PrintCalibration(ShortNumber(factor) + " times the usual",
                     RunCalibration(WithNoiseTimes(factor), seeds));
  }
  for (const double share : {0.01, 0.03, 0.1, 0.3}) {
    PrintCalibration(ShortNumber(100 * share) + " % of what is measured",
                     RunCalibration(WithNoiseOfReading(share), seeds));
  }
  for (const double lie : {1e-3, 0.1, 10.0, 1e3}) {
    CalibrationCase c;
    for (Gauge& gauge : c.start.gauges) gauge.noise_V *= lie;
    c.plan.force_std_N *= lie;
    c.plan.object_std_mm *= lie;
    PrintCalibration("usual, told " + ShortNumber(lie) + " times as much",
                     RunCalibration(c, seeds));
  }
}

inline void CalibrationQuantisedTable(int seeds) {
  PrintCalibrationHeader("bits over -1 .. 1 V, told noise_V");
  for (const int bits : {6, 8, 10, 12, 16}) {
    const double step = std::ldexp(2.0, -bits);
    for (const bool told : {true, false}) {
      CalibrationCase c;
      c.noisy_gauges = false;
      c.disturb = [step](FrameTable* log) {
        for (int j = 0; j < 4; ++j) {
          for (double& V : log->MutableNumbers(GaugeVolts(j))) {
            V = step * std::round(V / step);
          }
        }
      };
      for (Gauge& gauge : c.start.gauges) {
        gauge.noise_V = told ? step / std::sqrt(12.0) : 1e-5;
      }
      PrintCalibration(
          std::to_string(bits) + ", " + (told ? "step / sqrt(12)" : "1e-05 V"),
          RunCalibration(c, seeds));
    }
  }
}

inline CalibrationCase WithOffsets(double offset_V, bool priors) {
  CalibrationCase c;
  for (Gauge& gauge : c.truth.gauges) gauge.offset_V += offset_V;
  if (!priors) c.plan = WithoutPriors(c.plan);
  return c;
}

inline void CalibrationOffsetTable(int seeds) {
  PrintCalibrationHeader("offsets of the truth");
  for (const double offset : {1.0, 1e3}) {
    PrintCalibration(ShortNumber(offset) + " V, prior of 0 +- 1 V",
                     RunCalibration(WithOffsets(offset, true), seeds));
  }
  for (const double offset : {1.0, 1e3, 1e6, 1e9}) {
    PrintCalibration(ShortNumber(offset) + " V, no priors",
                     RunCalibration(WithOffsets(offset, false), seeds));
  }
}

/// Gauges of the hidden finger with other gains, and volts to match.
inline CalibrationCase WithGainsTimes(double factor, bool priors) {
  CalibrationCase c;
  for (Gauge& gauge : c.truth.gauges) {
    gauge.gain_V_per_rad *= factor;
    gauge.offset_V *= factor;
    gauge.noise_V *= std::abs(factor);
  }
  c.start = NominalWithNoiseOf(c.truth);
  if (!priors) c.plan = WithoutPriors(c.plan);
  return c;
}

inline void CalibrationGainTable(int seeds) {
  PrintCalibrationHeader("gains of the truth, times");
  for (const double factor : {1e-9, 1e-6, 1e-3, 0.1, -1.0, 10.0, 100.0}) {
    PrintCalibration(ShortNumber(factor) + ", prior of 1 +- 2 V/rad",
                     RunCalibration(WithGainsTimes(factor, true), seeds));
  }
  for (const double factor : {1e-9, 1e-6, 1e-3, -1.0, 10.0, 100.0}) {
    PrintCalibration(ShortNumber(factor) + ", no priors",
                     RunCalibration(WithGainsTimes(factor, false), seeds));
  }
}

/// The gauges (1-based) of the hidden finger that a log has.
inline CalibrationCase WithGauges(const std::vector<int>& gauges) {
  CalibrationCase c;
  const std::vector<Gauge> all = c.truth.gauges;
  c.truth.gauges.clear();
  for (const int j : gauges) c.truth.gauges.push_back(all[j - 1]);
  c.start = NominalWithNoiseOf(c.truth);
  return c;
}

inline void CalibrationLayoutTable(int seeds) {
  PrintCalibrationHeader("gauges");
  const auto row = [&](const std::string& name, const CalibrationCase& c) {
    PrintCalibration(name, RunCalibration(c, seeds));
  };
  row("four", CalibrationCase());
  row("the first twice", WithGauges({1, 1, 2, 3, 4}));
  row("all twice", WithGauges({1, 1, 2, 2, 3, 3, 4, 4}));
  CalibrationCase copied = WithGauges({1, 1, 2, 3, 4});
  copied.disturb = [](FrameTable* log) {
    log->MutableNumbers("gauge_2_V") = log->Numbers("gauge_1_V");
  };
  row("the first twice, noise and all", copied);
  row("four at one place", WithGauges({2, 2, 2, 2}));
  row("two", WithGauges({1, 4}));
  row("one", WithGauges({2}));
  for (const double reading : {0.0, 1.0, std::nan("")}) {
    CalibrationCase dead;
    dead.disturb = [reading](FrameTable* log) {
      for (double& V : log->MutableNumbers("gauge_2_V")) V = reading;
    };
    row("the second reads " + ShortNumber(reading) + " V", dead);
  }
}

inline void CalibrationStartTable(int seeds) {
  PrintCalibrationHeader("start");
  for (const double factor : {1e-3, 0.01, 0.1, 10.0, 100.0, 1e3}) {
    CalibrationCase c;
    c.start.front_stiffness_N_mm2 *= factor;
    c.start.back_stiffness_N_mm2 *= factor;
    PrintCalibration("both EI x " + ShortNumber(factor),
                     RunCalibration(c, seeds));
  }
  for (const double factor : {-100.0, -1.0, 0.01, 0.1, 10.0, 100.0, 1e4}) {
    CalibrationCase c;
    for (Gauge& gauge : c.start.gauges) gauge.gain_V_per_rad *= factor;
    PrintCalibration("gains x " + ShortNumber(factor),
                     RunCalibration(c, seeds));
  }
  for (const double off : {1.0, 3.0}) {
    CalibrationCase c;
    for (std::size_t i = 0; i < 5; ++i) {
      c.start.ribs[i].length_mm += i % 2 == 0 ? off : -off;
    }
    PrintCalibration("ribs off by " + ShortNumber(off) + " mm, prior of 0.5 mm",
                     RunCalibration(c, seeds));
  }
}

/// Starts and priors so wrong that a calibration takes minutes.
inline void CalibrationSlowTable() {
  PrintCalibrationHeader("start, prior");
  for (const double factor : {10.0, 100.0}) {
    CalibrationCase c;
    c.start.front_stiffness_N_mm2 *= factor;
    c.start.back_stiffness_N_mm2 /= factor;
    PrintCalibration("front EI x " + ShortNumber(factor) + ", back EI / " +
                         ShortNumber(factor),
                     RunCalibration(c, 1));
  }
  PrintCalibration("gains times 1000, prior of 1 +- 2 V/rad",
                   RunCalibration(WithGainsTimes(1e3, true), 1));
  PrintCalibration("offsets of 1e6 V, prior of 0 +- 1 V",
                   RunCalibration(WithOffsets(1e6, true), 1));
}

/// A finger of EI times a factor, whose forces and the std of these are as much
/// larger: the same problem.
inline CalibrationCase WithForcesTimes(double factor) {
  CalibrationCase c;
  c.truth.front_stiffness_N_mm2 *= factor;
  c.truth.back_stiffness_N_mm2 *= factor;
  c.start.front_stiffness_N_mm2 *= factor;
  c.start.back_stiffness_N_mm2 *= factor;
  c.force_std_N *= factor;
  c.plan.force_std_N *= factor;
  return c;
}

/// The largest difference of values and std, in std, the other's forces being
/// `factor` times as large.
inline double DifferenceInStd(const CalibrationOutcome& one,
                              const CalibrationOutcome& other, double factor) {
  if (one.values.size() != other.values.size() || one.values.empty()) {
    return std::nan("");
  }
  double worst = 0;
  for (std::size_t i = 0; i < one.values.size(); ++i) {
    const double unit = i < 2 ? factor : 1;  // stiffness comes first
    worst = std::max(
        {worst, std::abs(other.values[i] / unit - one.values[i]) / one.std[i],
         std::abs(other.std[i] / unit / one.std[i] - 1)});
  }
  return worst;
}

inline void CalibrationUnitsTable() {
  std::printf(
      "| EI and forces times | values and std differ "
      "by, std | verdict, exit code, warnings |\n|---|---|---|\n");
  const CalibrationOutcome before = RunCalibration(CalibrationCase(), 1);
  for (const double factor : {1e-6, 1e-5, 1e-3, 0.1, 10.0, 1e3, 1e6}) {
    const CalibrationOutcome after = RunCalibration(WithForcesTimes(factor), 1);
    std::printf("| %g | %.1e | %s |\n", factor,
                DifferenceInStd(before, after, factor), after.said[0].c_str());
    std::fflush(stdout);
  }
}

}  // namespace finray

#endif  // FINRAY_TESTS_STUDIES_CALIBRATION_EXTREMES_TABLES_H_
