// The experiments of the paper's Figs. 11 to 13, simulated: a circle pressed
// into the finger on a 4 x 6 grid, and error by height. Each draw is a finger
// calibrated from a log of its own noise (SimulatedLab); gauges 3e-4 rad, the
// force sensor 0.02 N, the stage 0.05 mm. 100 draws if not said otherwise,
// seeds 1 and up, noise ten times each. With a folder it writes by_height.csv,
// the mean error of each place of the grid (grid.csv), the contact frames of
// the first draw (contact_frames.csv) and what it put in (conditions.yaml).
//
//   build/test/tests/paper_protocol_study [DIR [DRAWS]]

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "finray/io/atomic_file.h"
#include "studies/coverage.h"
#include "studies/paper_protocol.h"

namespace finray {
namespace {

constexpr int kDraws = 100;
constexpr int kRepeats = 10;  // of noise, for each draw

enum class Known { kTruth, kCalibrated, kNominal };  // of the finger

/// A way from what is recorded to contacts, with what it got wrong.
struct Setting {
  const char* name;
  Known finger;
  bool noise;
  bool kinetostatic = false;  // from the stage, not from gauges
  bool by_height = false;
  std::vector<ProtocolError> grid = {};
  std::vector<std::vector<ProtocolError>> heights = {};
};

std::vector<Setting> Settings() {
  return {{"noise only", Known::kTruth, true, false, true},
          {"calibration only", Known::kCalibrated, false, false, true},
          {"noise and calibration", Known::kCalibrated, true, false, true},
          {"noise, nominal finger", Known::kNominal, true},
          {"kinetostatics, calibration only", Known::kCalibrated, false, true},
          {"kinetostatics", Known::kCalibrated, true, true},
          {"kinetostatics, nominal finger", Known::kNominal, true, true}};
}

double NotOkPercent(const std::vector<ProtocolError>& errors) {
  const auto good = std::count_if(errors.begin(), errors.end(),
                                  [](const auto& e) { return e.ok; });
  return 100.0 - 100.0 * static_cast<double>(good) / errors.size();
}

void PrintGrid(const std::vector<Setting>& settings) {
  std::printf(
      "\n| 4 x 6 grid | mean place error, mm | mean angle error, deg | mean "
      "force error, N | 95 %% of places, mm | of forces, N | not ok, %% "
      "|\n|---|---|---|---|---|---|---|\n| the paper, sensed | 0.58 | 1.24 | "
      "0.15 | | | |\n| the paper, kinetostatics | 0.70 | 1.21 | | | | |\n");
  for (const Setting& setting : settings) {
    const std::vector<ProtocolError>& errors = setting.grid;
    const auto percentile = [&](double ProtocolError::*which) {
      std::vector<double> values;
      for (const ProtocolError& error : errors) values.push_back(error.*which);
      const auto at = values.begin() + values.size() * 95 / 100;
      std::nth_element(values.begin(), at, values.end());
      return *at;
    };
    std::printf("| %s | %.3f | %.3f | %.3f | %.2f | %.2f | %.1f |\n",
                setting.name, MeanOf(errors, &ProtocolError::place_mm),
                MeanOf(errors, &ProtocolError::angle_deg),
                MeanOf(errors, &ProtocolError::force_N),
                percentile(&ProtocolError::place_mm),
                percentile(&ProtocolError::force_N), NotOkPercent(errors));
  }
}

void PrintHeights(const std::vector<double>& heights,
                  const std::vector<Setting>& settings) {
  std::printf("\n| height, mm |");
  for (const Setting& s : settings) {
    if (s.by_height) std::printf(" %s: l_c, mm; f_c, N |", s.name);
  }
  std::printf("\n|---|---|---|---|\n");
  for (std::size_t h = 0; h < heights.size(); ++h) {
    std::printf("| %.0f |", heights[h]);
    for (const Setting& setting : settings) {
      if (!setting.by_height) continue;
      const std::vector<ProtocolError>& errors = setting.heights[h];
      std::printf(" %.3f; %.3f |",
                  RootMeanSquareOf(errors, &ProtocolError::arc_mm),
                  RootMeanSquareOf(errors, &ProtocolError::force_N));
    }
    std::printf("\n");
  }
}

void WriteHeights(const std::vector<double>& heights,
                  const std::vector<Setting>& settings,
                  const std::string& path) {
  std::ofstream csv(path);
  csv << "setting,height_mm,arc_rms_mm,force_rms_N,not_ok_percent\n";
  for (std::size_t h = 0; h < heights.size(); ++h) {
    for (const Setting& setting : settings) {
      if (!setting.by_height) continue;
      const std::vector<ProtocolError>& errors = setting.heights[h];
      csv << '"' << setting.name << "\"," << heights[h] << ','
          << RootMeanSquareOf(errors, &ProtocolError::arc_mm) << ','
          << RootMeanSquareOf(errors, &ProtocolError::force_N) << ','
          << NotOkPercent(errors) << '\n';
    }
  }
}

/// Errors of a setting lie in the order of the frames, again and again.
void WriteGrid(const std::vector<ProtocolFrame>& frames,
               const std::vector<Setting>& settings,
               const std::string& folder) {
  std::ofstream means(folder + "/grid.csv");
  means << "setting,height_mm,force_N,place_mean_mm,angle_mean_deg,"
           "force_error_mean_N,not_ok_percent\n";
  std::ofstream poses(folder + "/contact_frames.csv");
  poses << "setting,x_mm,y_mm,angle_deg,true_x_mm,true_y_mm,true_angle_deg\n";
  for (const Setting& setting : settings) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
      std::vector<ProtocolError> errors;
      for (std::size_t k = i; k < setting.grid.size(); k += frames.size()) {
        errors.push_back(setting.grid[k]);
      }
      means << '"' << setting.name << "\"," << frames[i].height_mm << ','
            << frames[i].contact.normal_N << ','
            << MeanOf(errors, &ProtocolError::place_mm) << ','
            << MeanOf(errors, &ProtocolError::angle_deg) << ','
            << MeanOf(errors, &ProtocolError::force_N) << ','
            << NotOkPercent(errors) << '\n';
      poses << '"' << setting.name << '"';
      for (const auto& pose : {errors[0].pose, frames[i].pose}) {
        poses << ',' << pose.x() << ',' << pose.y() << ','
              << pose[2] * 180 / M_PI;
      }
      poses << '\n';
    }
  }
}

double Percent(double ratio) { return std::round(1000 * (ratio - 1)) / 10; }

void WriteConditions(const SimulatedLab& lab, int draws,
                     const std::string& path) {
  const Finger nominal = lab.Nominal();
  const Finger& truth = lab.finger();
  double rib_mm = 0;
  for (std::size_t i = 0; i < truth.ribs.size(); ++i) {
    rib_mm = std::max(
        rib_mm, std::abs(nominal.ribs[i].length_mm - truth.ribs[i].length_mm));
  }
  std::ofstream(path)
      << "gauge_noise_rad: " << SimulatedLab::kNoise_rad
      << "\nstage_std_mm: " << lab.stage_std_mm()
      << "\nforce_sensor_std_N: " << lab.force_std_N()
      << "\ncircle_radius_mm: " << SimulatedLab::kRadius_mm
      << "\nnominal_error: {front_stiffness_percent: "
      << Percent(nominal.front_stiffness_N_mm2 / truth.front_stiffness_N_mm2)
      << ", back_stiffness_percent: "
      << Percent(nominal.back_stiffness_N_mm2 / truth.back_stiffness_N_mm2)
      << ", largest_rib_length_mm: " << rib_mm << "}\ndraws: " << draws
      << "\nrepeats: " << kRepeats << '\n';
}

void Run(const std::string& folder, int draws) {
  const SimulatedLab lab;
  Scene one;
  one.contacts = 1;
  const std::vector<double> heights = Range(20, 110, 19);
  const std::vector<ProtocolFrame> grid =
      lab.Press({30, 45, 60, 75, 90, 105}, {1.5, 2.5, 3.5, 4.5});
  std::vector<std::vector<ProtocolFrame>> by_height;
  for (const double height : heights) {
    by_height.push_back(lab.Press({height}, {1.5, 2.5, 3.5, 4.5}));
  }
  std::vector<Setting> settings = Settings();
  for (Setting& setting : settings) setting.heights.resize(heights.size());
  const auto append = [](const std::vector<ProtocolError>& from,
                         std::vector<ProtocolError>* to) {
    to->insert(to->end(), from.begin(), from.end());
  };
  for (int draw = 1; draw <= draws; ++draw) {
    const Finger calibrated = lab.Calibrated(draw, 2);
    std::mt19937_64 generator(draw);
    for (Setting& setting : settings) {
      const Finger finger = setting.finger == Known::kTruth ? lab.finger()
                            : setting.finger == Known::kCalibrated
                                ? calibrated
                                : lab.Nominal();
      FrameEstimator estimator(finger, one, {});
      EquilibriumSolver solver(finger, {});
      const Finger* noise = setting.noise ? &lab.finger() : nullptr;
      const auto errors = [&](const std::vector<ProtocolFrame>& frames) {
        return setting.kinetostatic
                   ? KinetostaticErrors(frames, lab.object(),
                                        noise ? lab.stage_std_mm() : 0, &solver,
                                        &generator)
                   : ProtocolErrors(frames, noise, &estimator, &generator);
      };
      for (int repeat = 0; repeat < (noise ? kRepeats : 1); ++repeat) {
        append(errors(grid), &setting.grid);
        for (std::size_t h = 0; setting.by_height && h < heights.size(); ++h) {
          append(errors(by_height[h]), &setting.heights[h]);
        }
      }
    }
  }
  std::printf("%d draws of %zu frames, mean force %.2f N\n", draws, grid.size(),
              [&] {
                double sum = 0;
                for (const auto& frame : grid) sum += frame.contact.normal_N;
                return sum / grid.size();
              }());
  PrintGrid(settings);
  PrintHeights(heights, settings);
  if (folder.empty()) return;
  MakeFolder(folder);
  WriteHeights(heights, settings, folder + "/by_height.csv");
  WriteGrid(grid, settings, folder);
  WriteConditions(lab, draws, folder + "/conditions.yaml");
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  finray::Run(argc > 1 ? argv[1] : "",
              argc > 2 ? std::atoi(argv[2]) : finray::kDraws);
}
