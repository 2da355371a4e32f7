// Compliance, Figs. 19 and 20 of the paper, simulated: five springs, five
// trials, 20 steps of 1 mm in and out, and six objects squeezed between two
// fingers, sorted from stiff to soft. Gauges 3e-4 rad, stage 0.02 mm, slider
// friction 0.1 N. The plant has elements four times as fine as the estimator's
// and parameters drawn as a calibration leaves them (EI 1 %, gains 0.3 %, ribs
// 0.03 mm; with `rough` 2 %, 1 %, 0.05 mm); each trial has a plant of its own.
//
//   build/test/tests/compliance_study [DRAWS]
//   build/test/tests/compliance_study write DIR [SEED]
//
// The second one writes the logs of one draw instead, with conditions.yaml:
// what was put in and the true stiffness of each thing.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>

#include "finray/io/atomic_file.h"
#include "finray/io/error.h"
#include "finray/perception/compliance.h"
#include "perception/simulated_slider.h"
#include "test_finger.h"

namespace finray {
namespace {

struct ModelError {
  const char* name;
  double stiffness, gain, rib_mm;
};
constexpr ModelError kNone{"none", 0, 0, 0};
constexpr ModelError kCalibrated{"calibrated", 0.01, 0.003, 0.03};
constexpr ModelError kRough{"rough", 0.02, 0.01, 0.05};

Finger Plant(const ModelError& error, std::mt19937_64* generator) {
  std::normal_distribution<double> normal;
  Finger finger = PaperFinger();
  finger.front_stiffness_N_mm2 *= 1 + error.stiffness * normal(*generator);
  finger.back_stiffness_N_mm2 *= 1 + error.stiffness * normal(*generator);
  for (Gauge& gauge : finger.gauges) {
    gauge.gain_V_per_rad *= 1 + error.gain * normal(*generator);
  }
  for (Rib& rib : finger.ribs) {
    rib.length_mm += error.rib_mm * normal(*generator);
  }
  return finger;
}

// Finer than the estimator's, which starts from 12 elements.
constexpr double kStage_mm = 0.02;
Discretization Fine() { return {Scheme::kTaylor, 48}; }

ComplianceFinger Estimator() {
  ComplianceFinger estimator{PaperFinger(), Scene()};
  estimator.scene.contacts = 1;
  estimator.scene.object = RigidObject{Outline(CircleOutline{10}), {}};
  return estimator;
}

constexpr double kSprings[] = {0.2, 0.5, 1.0, 2.0, 4.0};
constexpr double kFriction_N = 0.1;

std::string SpringName(double stiffness) {
  char name[40];
  std::snprintf(name, sizeof(name), "spring_%.1f", stiffness);
  return name;
}

FrameTable SpringLog(double stiffness, const ModelError& error,
                     std::mt19937_64* generator) {
  SliderProtocol protocol;
  protocol.friction_N = kFriction_N;
  return SimulateSlider(Plant(error, generator),
                        [=](double u) { return stiffness * u; }, Fine(),
                        protocol, {true, kStage_mm, (*generator)()});
}

void Springs(const ModelError& error, int draws) {
  std::printf(
      "\nfive springs, five trials each, %d draws, model error: %s\n"
      "| k, N/mm | mean, N/mm | rms error, %% | largest error of a trial, %% | "
      "largest error of five, %% | errors within 1, 1.96 std, %% | friction, N "
      "| refused |\n|---|---|---|---|---|---|---|---|\n",
      draws, error.name);
  const ComplianceFinger estimator = Estimator();
  for (const double stiffness : kSprings) {
    double sum = 0, squares = 0, worst = 0, worst_of_five = 0, friction = 0;
    int refused = 0, trials = 0, in_1 = 0, in_2 = 0;
    std::mt19937_64 generator(1);
    for (int draw = 0; draw < draws; ++draw) {
      std::vector<ComplianceLog> logs;
      for (int trial = 0; trial < 5; ++trial) {
        FrameTable log = SpringLog(stiffness, error, &generator);
        log.MutableText("object").assign(log.rows(), "spring");
        log.MutableText("trial").assign(log.rows(), std::to_string(trial + 1));
        logs.push_back({"spring", {log}});
      }
      ComplianceSettings settings;
      settings.most_degree = 1;
      settings.direction_rad = M_PI;
      Compliance found;
      try {
        found = MeasureCompliance(logs, {estimator}, {}, settings);
      } catch (const InputError&) {
        ++refused;
        continue;
      }
      for (const ComplianceTrial& trial : found.trials) {
        const double off = trial.stiffness.N_per_mm / stiffness - 1;
        sum += trial.stiffness.N_per_mm;
        squares += off * off;
        worst = std::max(worst, std::abs(off));
        friction += trial.fit.friction_N();
        const double stds = std::abs(off) * stiffness / trial.stiffness.std;
        in_1 += stds <= 1;
        in_2 += stds <= 1.96;
        ++trials;
      }
      worst_of_five =
          std::max(worst_of_five,
                   std::abs(found.objects[0].mean.N_per_mm / stiffness - 1));
    }
    std::printf(
        "| %.1f | %.4f | %.2f | %.2f | %.2f | %.0f, %.0f | %.3f | "
        "%d |\n",
        stiffness, sum / trials, 100 * std::sqrt(squares / trials), 100 * worst,
        100 * worst_of_five, 100.0 * in_1 / trials, 100.0 * in_2 / trials,
        friction / trials, refused);
    std::fflush(stdout);
  }
}

// Displacement by force of half a dozen things as in Fig. 20, the paper gives
// no numbers: mm at F N.
struct SoftObject {
  const char* name;
  double linear_mm_per_N, bend_mm_per_N2;
};
// u = linear F + bend F^2: stiffening if bend < 0, softening if above.
constexpr SoftObject kObjects[] = {{"solid silicone cylinder", 0.22, -0.008},
                                   {"hollow silicone cylinder", 0.40, -0.015},
                                   {"plastic bottle", 0.60, 0.02},
                                   {"aluminium can", 0.80, 0.03},
                                   {"napkin package", 1.70, -0.12},
                                   {"paper cup", 2.20, 0.10}};

// Between these forces objects are compared.
constexpr double kFrom_N = 1, kTo_N = 3;

double Secant(const SoftObject& object, double from_N, double to_N) {
  return (to_N - from_N) /
         (object.linear_mm_per_N * (to_N - from_N) +
          object.bend_mm_per_N2 * (to_N * to_N - from_N * from_N));
}

SqueezeLogs ObjectLogs(const SoftObject& object, const ModelError& error,
                       std::mt19937_64* generator) {
  const Finger first = Plant(error, generator);
  const Finger second = Plant(error, generator);
  SliderProtocol protocol;
  return SimulateSqueeze(
      first, second,
      [&](double f) {
        return object.linear_mm_per_N * f + object.bend_mm_per_N2 * f * f;
      },
      Fine(), protocol, 4, {true, kStage_mm, (*generator)()});
}

void Squeeze(const ModelError& error, int draws) {
  constexpr std::size_t kCount = std::size(kObjects);
  std::printf("\nsix objects between two fingers, %d draws, model error: %s\n",
              draws, error.name);
  double sum[kCount] = {}, squares[kCount] = {}, truth[kCount] = {};
  double pair[kCount] = {}, whole = 0;
  int right = 0, refused = 0, degrees[kCount] = {};
  const ComplianceFinger estimator = Estimator();
  std::mt19937_64 generator(2);
  for (int draw = 0; draw < draws; ++draw) {
    std::vector<ComplianceLog> logs;
    for (const SoftObject& object : kObjects) {
      SqueezeLogs both = ObjectLogs(object, error, &generator);
      logs.push_back({object.name, {both.first, both.second}});
    }
    ComplianceSettings settings;
    settings.from_N = kFrom_N;
    settings.to_N = kTo_N;
    // Both fingers push the object's half along their own -x.
    settings.direction_rad = M_PI;
    Compliance found;
    try {
      found = MeasureCompliance(logs, {estimator, estimator}, {}, settings);
    } catch (const InputError&) {
      ++refused;
      continue;
    }
    bool sorted = true;
    for (std::size_t i = 0; i < kCount; ++i) {
      sorted = sorted && found.objects[i].name == kObjects[i].name;
      truth[i] = Secant(kObjects[i], kFrom_N, kTo_N);
      for (const ComplianceTrial& trial : found.trials) {
        if (trial.object != kObjects[i].name) continue;
        const double off = trial.stiffness.N_per_mm / truth[i] - 1;
        sum[i] += trial.stiffness.N_per_mm;
        squares[i] += off * off;
        degrees[i] += trial.fit.law.degree;
      }
      if (i + 1 < kCount) pair[i] += found.pair_confidence[i];
    }
    right += sorted;
    whole += found.order_confidence;
  }
  const int done = draws - refused;
  std::printf(
      "| object | k from 1 to 3 N, N/mm | found, N/mm | rms error, %% | "
      "mean degree | P(stiffer than the next) |\n"
      "|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < kCount; ++i) {
    std::printf("| %s | %.3f | %.3f | %.2f | %.1f |", kObjects[i].name,
                truth[i], sum[i] / done, 100 * std::sqrt(squares[i] / done),
                static_cast<double>(degrees[i]) / done);
    if (i + 1 < kCount) std::printf(" %.4f", pair[i] / done);
    std::printf(" |\n");
  }
  std::printf(
      "whole order right in %d of %d draws, mean confidence %.3f; "
      "%d refused\n",
      right, done, whole / done, refused);
}

void WriteConditions(const std::string& path) {
  const Gauge gauge = PaperFinger().gauges[0];
  std::ofstream conditions(path);
  conditions << "gauge_noise_rad: " << 1 / gauge.AngleWeight()
             << "\nstage_std_mm: " << kStage_mm
             << "\nslider_friction_N: " << kFriction_N
             << "\nmodel_error: {stiffness_std_percent: "
             << 100 * kCalibrated.stiffness
             << ", gauge_gain_std_percent: " << 100 * kCalibrated.gain
             << ", rib_length_std_mm: " << kCalibrated.rib_mm
             << "}\nfrom_N: " << kFrom_N << "\nto_N: " << kTo_N
             << "\nsprings:\n";
  for (const double stiffness : kSprings) {
    conditions << "  - {name: " << SpringName(stiffness)
               << ", N_per_mm: " << stiffness << "}\n";
  }
  conditions << "objects:\n";
  for (const SoftObject& object : kObjects) {
    conditions << "  - {name: " << object.name
               << ", N_per_mm: " << Secant(object, kFrom_N, kTo_N) << "}\n";
  }
}

void Write(const std::string& folder, unsigned seed) {
  MakeFolder(folder);
  WriteConditions(folder + "/conditions.yaml");
  std::mt19937_64 generator(seed);
  for (const double stiffness : kSprings) {
    for (int trial = 1; trial <= 5; ++trial) {
      FrameTable log = SpringLog(stiffness, kCalibrated, &generator);
      log.MutableText("trial").assign(log.rows(), std::to_string(trial));
      log.MutableText("object").assign(log.rows(), SpringName(stiffness));
      log.Write(folder + "/" + SpringName(stiffness) + "_" +
                std::to_string(trial) + ".csv");
    }
  }
  for (const SoftObject& object : kObjects) {
    SqueezeLogs both = ObjectLogs(object, kCalibrated, &generator);
    std::string stem = object.name;
    for (char& c : stem) c = c == ' ' ? '_' : c;
    both.first.Write(folder + "/" + stem + ".left.csv");
    both.second.Write(folder + "/" + stem + ".right.csv");
  }
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  if (argc >= 3 && std::string(argv[1]) == "write") {
    finray::Write(argv[2], argc > 3 ? std::atoi(argv[3]) : 1);
    return 0;
  }
  const int draws = argc > 1 ? std::atoi(argv[1]) : 10;
  for (const auto& error :
       {finray::kNone, finray::kCalibrated, finray::kRough}) {
    finray::Springs(error, draws);
    finray::Squeeze(error, draws);
  }
}
