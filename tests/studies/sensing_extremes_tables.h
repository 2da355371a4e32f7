#ifndef FINRAY_TESTS_STUDIES_SENSING_EXTREMES_TABLES_H_
#define FINRAY_TESTS_STUDIES_SENSING_EXTREMES_TABLES_H_

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "studies/sensing_extremes.h"
#include "studies/table_text.h"

namespace finray {

/// Readings as they are.
inline void NoNoise(const Finger&, std::mt19937_64*, Measurements*) {}

inline Finger WithGaugeNoise(Finger finger, double noise_V) {
  for (Gauge& gauge : finger.gauges) gauge.noise_V = noise_V;
  return finger;
}

inline void NoiseTable(int frames) {
  PrintSensingHeader("noise, of the reading");
  for (const double told : {3e-4, 1e-12}) {
    SensingCase c;
    c.told = WithGaugeNoise(c.truth, told);
    c.disturb = NoNoise;
    PrintSensing("0, told " + ShortNumber(told) + " rad",
                 RunSensing(c, frames));
  }
  for (const double noise :
       {1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0}) {
    SensingCase c;
    c.noise_of_reading = noise;
    PrintSensing(ShortNumber(noise), RunSensing(c, frames));
  }
  std::printf("\nTold %s as they are, of readings with 0.001.\n\n",
              "other std than");
  PrintSensingHeader("told, times the true std");
  for (const double lie : {1e-6, 1e-3, 0.1, 10.0, 1e3}) {
    SensingCase c;
    c.noise_of_reading = 1e-3 * lie;
    c.disturb = [lie](const Finger& told, std::mt19937_64* generator,
                      Measurements* readings) {
      Finger noisy = told;
      for (Gauge& gauge : noisy.gauges) gauge.noise_V /= lie;
      *readings = WithNoise(*readings, noisy, generator);
    };
    PrintSensing(ShortNumber(lie), RunSensing(c, frames));
  }
}

/// Converters of these bits over -1 to 1 V, in which the readings reach 0.3 V.
inline void QuantisedTable(int frames) {
  PrintSensingHeader("bits over -1 .. 1 V, told noise_V");
  for (const int bits : {4, 6, 8, 10, 12, 16, 24}) {
    const double step = std::ldexp(2.0, -bits);
    for (const bool told : {true, false}) {
      SensingCase c;
      const double noise = told ? step / std::sqrt(12.0) : 1e-6;
      c.told = WithGaugeNoise(c.truth, noise);
      c.disturb = [step](const Finger&, std::mt19937_64*,
                         Measurements* readings) {
        for (double& V : readings->gauges_V) V = step * std::round(V / step);
      };
      PrintSensing(
          std::to_string(bits) + ", " + (told ? "step / sqrt(12)" : "1e-06 V"),
          RunSensing(c, frames));
    }
  }
}

inline void OffsetTable(int frames) {
  PrintSensingHeader("offset, what is left of it");
  const auto offset_by = [](Finger finger, double offset_V) {
    for (Gauge& gauge : finger.gauges) gauge.offset_V = offset_V;
    return finger;
  };
  for (const double offset : {1.0, 1e3, 1e6, 1e9, 1e12, 1e13, 1e15}) {
    SensingCase c;
    c.truth = c.told = offset_by(c.truth, offset);
    c.disturb = NoNoise;
    PrintSensing(ShortNumber(offset) + " V, removed, no noise",
                 RunSensing(c, frames));
    c.disturb = SensingCase().disturb;
    PrintSensing(ShortNumber(offset) + " V, removed, 3e-4 V of noise",
                 RunSensing(c, frames));
  }
  for (const double drift :
       {1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 0.1, 1.0, 1e3, 1e6}) {
    SensingCase c;
    c.disturb = [drift](const Finger& told, std::mt19937_64* generator,
                        Measurements* readings) {
      *readings = WithNoise(*readings, told, generator);
      // One gauge up, the next one down.
      double sign = 1;
      for (double& V : readings->gauges_V) V += (sign = -sign) * drift;
    };
    PrintSensing("drift of " + ShortNumber(drift) + " V, not removed",
                 RunSensing(c, frames));
  }
}

/// The largest difference of two runs over the same contacts, in l_0 and f_c,
/// the second one's lengths and forces being these times the first one's.
inline std::string LargestDifference(const SensingOutcome& a,
                                     const SensingOutcome& b, double length,
                                     double force, double l0_mm) {
  double arc = 0, normal = 0, std = 0;
  int other_status = 0;
  for (std::size_t i = 0; i < a.estimates.size(); ++i) {
    const ContactEstimate& one = a.estimates[i].contact[0];
    const ContactEstimate& two = b.estimates[i].contact[0];
    other_status += a.estimates[i].status != b.estimates[i].status;
    if (a.estimates[i].status != FrameStatus::kOk ||
        b.estimates[i].status != FrameStatus::kOk) {
      continue;
    }
    arc = std::max(arc, std::abs(two.arc_mm / length - one.arc_mm) / l0_mm);
    normal =
        std::max(normal, std::abs(two.normal_N / force / one.normal_N - 1));
    std = std::max({std, std::abs(two.arc_std_mm / length / one.arc_std_mm - 1),
                    std::abs(two.normal_std_N / force / one.normal_std_N - 1)});
  }
  char text[128];
  std::snprintf(text, sizeof text, "%.1e | %.1e | %.1e | %d", arc, normal, std,
                other_status);
  return text;
}

/// Same contacts, same noise in rad: nothing may change but the units.
inline void UnitsTable(int frames) {
  std::printf(
      "| what is changed | l_c, of l_0 | f_c, "
      "of f_c | std, of std | other status, of %d |\n|---|---|---|---|---|\n",
      frames * static_cast<int>(UsualPlaces().size()));
  const SensingCase usual;
  const SensingOutcome before = RunSensing(usual, frames);
  const double l0 = usual.truth.front_length_mm;
  for (const double gain : {1e-12, 1e-6, 1e-3, -1.0, 1e3, 1e6, 1e12}) {
    SensingCase c;
    for (Gauge& gauge : c.truth.gauges) {
      gauge.gain_V_per_rad *= gain;
      gauge.noise_V *= std::abs(gain);
    }
    c.told = c.truth;
    // The same angles.
    c.disturb = [gain](const Finger& told, std::mt19937_64* generator,
                       Measurements* readings) {
      Finger signed_noise = told;
      for (Gauge& gauge : signed_noise.gauges)
        gauge.noise_V *= gain < 0 ? -1 : 1;
      *readings = WithNoise(*readings, signed_noise, generator);
    };
    std::printf(
        "| gains of %g V/rad | %s |\n", gain,
        LargestDifference(before, RunSensing(c, frames), 1, 1, l0).c_str());
  }
  const std::pair<double, double> units[] = {
      {1, 1e-6}, {1, 1e-3}, {1, 0.1}, {1, 10},      {1, 1e3},
      {1, 1e6},  {1e-3, 1}, {1e3, 1}, {1e-3, 1e-3}, {1e3, 1e-3}};
  for (const auto& [length, force] : units) {
    SensingCase c;
    c.truth = c.told = InUnits(c.truth, length, force);
    c.arc_spread_mm *= length;
    for (PointContact& place : c.places) {
      place.arc_mm *= length;
      place.normal_N *= force;
    }
    std::printf(
        "| lengths x %g, forces x %g (EI x %g) | %s |\n", length, force,
        force * length * length,
        LargestDifference(before, RunSensing(c, frames), length, force, l0)
            .c_str());
    std::fflush(stdout);
  }
}

inline std::vector<std::pair<std::string, Finger>> GaugeLayouts() {
  const Finger paper = PaperFinger();
  std::vector<std::pair<std::string, Finger>> all = {
      {"four, as they are", paper}};
  const auto add = [&](const char* name, const std::vector<int>& gauges) {
    Finger finger = paper;
    finger.gauges.clear();
    for (const int j : gauges) finger.gauges.push_back(paper.gauges[j - 1]);
    all.push_back({name, finger});
    return &all.back().second;
  };
  add("the first twice", {1, 1, 2, 3, 4});
  add("the first thrice", {1, 1, 1, 2, 3, 4});
  add("all twice", {1, 1, 2, 2, 3, 3, 4, 4});
  add("all thrice", {1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4});
  add("second 1 mm beside the first", {1, 1, 3, 4})->gauges[1].start_mm += 1;
  add("1 and 4 only", {1, 4});
  add("1 and 2 only", {1, 2});
  add("3 and 4 only", {3, 4});
  add("two 1 mm apart", {2, 2})->gauges[1].start_mm += 1;
  add("two 1e-3 mm apart", {2, 2})->gauges[1].start_mm += 1e-3;
  add("two 1e-6 mm apart", {2, 2})->gauges[1].start_mm += 1e-6;
  add("two at one place", {2, 2});
  add("four at one place", {2, 2, 2, 2});
  return all;
}

inline void LayoutTable(int frames) {
  std::printf("Condition number at 75 mm and 2 N:\n\n");
  for (const auto& [name, finger] : GaugeLayouts()) {
    const SensingCondition condition = ConditionOf(finger, {75, 2});
    std::printf("- %s: %.3g, the weak direction moves readings by %.3g std\n",
                name.c_str(), condition.number, condition.least);
  }
  std::printf("\n");
  PrintSensingHeader("gauges, noise of 3e-4 rad");
  for (const auto& [name, finger] : GaugeLayouts()) {
    SensingCase c;
    c.truth = c.told = finger;
    PrintSensing(name, RunSensing(c, frames));
  }
  const auto with_first_reading = [&](const char* name, double reading_V) {
    SensingCase c;
    c.disturb = [=](const Finger& told, std::mt19937_64* generator,
                    Measurements* readings) {
      *readings = WithNoise(*readings, told, generator);
      readings->gauges_V[1] = reading_V;
    };
    PrintSensing(name, RunSensing(c, frames));
  };
  with_first_reading("the second reads nothing", std::nan(""));
  with_first_reading("the second stuck at 0 V", 0);
  with_first_reading("the second stuck at 1 V", 1);
  with_first_reading("the second reads 1e300 V", 1e300);
  with_first_reading("the second reads infinity",
                     std::numeric_limits<double>::infinity());
}

inline void PlacesTable(int frames) {
  std::printf(
      "Noise of 1e-6 rad; the contact is where it says, to rounding.\n\n");
  PrintSensingHeader("l_c, mm; f_c, N; contacts");
  Finger finger = WithGaugeNoise(PaperFinger(), 1e-6);
  // One on the front beam as well, with an end where a contact will be.
  finger.gauges.push_back(finger.gauges[0]);
  finger.gauges.back().beam = Side::kFront;
  finger.gauges.back().start_mm = 66;
  const auto row = [&](double arc, double force, bool automatic) {
    SensingCase c;
    c.truth = c.told = finger;
    c.places = {{arc, force}};
    c.arc_spread_mm = 0;
    c.force_spread = 1e-3;
    c.automatic = automatic;
    PrintSensing(ShortNumber(arc) + "; " + ShortNumber(force) +
                     (automatic ? "; auto" : "; 1"),
                 RunSensing(c, 8 * frames));
  };
  for (const double arc : {0.0, 1e-9, 1e-3, 1.0, 5.0, 10.0, 61.0, 66.0, 84.0,
                           115.0, 125.0, 135.0, 139.0, 139.999, 140.0}) {
    row(arc, 2, false);
  }
  for (const double force : {1e-9, 1e-6, 1e-4, 1e-3, 1e-2, 0.029, 0.031, 0.1,
                             10.0, 25.0, 50.0, 100.0, 103.0, 150.0, 200.0}) {
    row(75, force, false);
    if (force < 0.1) row(75, force, true);
  }
  std::printf("\nThe same with a noise of 1e-4 of the reading, `auto`.\n\n");
  PrintSensingHeader("f_c at 75 mm, N");
  for (const double force : {1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-3, 0.02}) {
    SensingCase c;
    c.noise_of_reading = 1e-4;
    c.places = {{75, force}};
    c.automatic = true;
    PrintSensing(ShortNumber(force), RunSensing(c, 8 * frames));
  }
}

inline void ConditionTable() {
  std::printf(
      "Slopes by l_c / l_0 and f_c "
      "(relative), rows over their std of 3e-4 rad: condition number, and how "
      "many std a change by 1 along the weak direction makes.\n\n"
      "| l_c, mm | 0.1 N | 1 N | 5 N | 20 N |\n|---|---|---|---|---|\n");
  for (const double arc :
       {0.1, 1.0, 5.0, 10.0, 15.0, 25.0, 40.0, 61.0, 75.0, 90.0, 105.0, 112.0,
        115.0, 120.0, 125.0, 130.0, 135.0, 139.0, 139.9}) {
    std::printf("| %g ", arc);
    for (const double force : {0.1, 1.0, 5.0, 20.0}) {
      const SensingCondition condition =
          ConditionOf(PaperFinger(), {arc, force});
      std::printf("| %.3g, %.3g ", condition.number, condition.least);
    }
    std::printf("|\n");
  }
}

}  // namespace finray

#endif  // FINRAY_TESTS_STUDIES_SENSING_EXTREMES_TABLES_H_
