// The experiments of the paper's Figs. 11 to 13, simulated: a circle pressed
// into the finger on a 4 x 6 grid, and error by height. Each draw is a finger
// calibrated from a log of its own noise (SimulatedLab); gauges 3e-4 rad, the
// force sensor 0.02 N, the stage 0.05 mm. 100 draws, seeds 1 to 100, noise
// ten times each. With a path it writes the errors by height as CSV.
//
//   build/test/tests/paper_protocol_study [BY_HEIGHT.csv]

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "studies/coverage.h"
#include "studies/paper_protocol.h"

namespace finray {
namespace {

constexpr int kDraws = 100;
constexpr int kRepeats = 10;  // of noise, for each draw

struct Setting {
  const char* name;
  bool calibrated, noise;
  std::vector<ProtocolError> grid;
  std::vector<std::vector<ProtocolError>> by_height;
};

void PrintGrid(const std::vector<Setting>& settings) {
  std::printf(
      "\n| 4 x 6 grid | mean place error, mm | mean angle error, deg | mean "
      "force error, N | 95 %% of places, mm | of forces, N | not ok, %% "
      "|\n|---|---|---|---|---|---|---|\n| the paper, measured | 0.58 | 1.24 | "
      "0.15 | | | |\n");
  for (const Setting& setting : settings) {
    const std::vector<ProtocolError>& errors = setting.grid;
    const auto percentile = [&](double ProtocolError::*which) {
      std::vector<double> values;
      for (const ProtocolError& error : errors) values.push_back(error.*which);
      const auto at = values.begin() + values.size() * 95 / 100;
      std::nth_element(values.begin(), at, values.end());
      return *at;
    };
    const auto good = std::count_if(errors.begin(), errors.end(),
                                    [](const auto& e) { return e.ok; });
    std::printf("| %s | %.3f | %.3f | %.3f | %.2f | %.2f | %.1f |\n",
                setting.name, MeanOf(errors, &ProtocolError::place_mm),
                MeanOf(errors, &ProtocolError::angle_deg),
                MeanOf(errors, &ProtocolError::force_N),
                percentile(&ProtocolError::place_mm),
                percentile(&ProtocolError::force_N),
                100.0 - 100.0 * good / errors.size());
  }
}

void PrintHeights(const std::vector<double>& heights,
                  const std::vector<Setting>& settings, const char* path) {
  std::ofstream csv(path);
  csv << "setting,height_mm,arc_rms_mm,force_rms_N,not_ok_percent\n";
  std::printf("\n| height, mm |");
  for (const Setting& s : settings)
    std::printf(" %s: l_c, mm; f_c, N |", s.name);
  std::printf("\n|---|---|---|---|\n");
  for (std::size_t h = 0; h < heights.size(); ++h) {
    std::printf("| %.0f |", heights[h]);
    for (const Setting& setting : settings) {
      const std::vector<ProtocolError>& errors = setting.by_height[h];
      const double arc = RootMeanSquareOf(errors, &ProtocolError::arc_mm);
      const double force = RootMeanSquareOf(errors, &ProtocolError::force_N);
      const auto good = std::count_if(errors.begin(), errors.end(),
                                      [](const auto& e) { return e.ok; });
      std::printf(" %.3f; %.3f |", arc, force);
      csv << setting.name << ',' << heights[h] << ',' << arc << ',' << force
          << ',' << 100.0 - 100.0 * good / errors.size() << '\n';
    }
    std::printf("\n");
  }
}

void Run(const char* path) {
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
  std::vector<Setting> settings = {
      {"noise only", false, true, {}, {}},
      {"calibration only", true, false, {}, {}},
      {"noise and calibration", true, true, {}, {}}};
  for (Setting& setting : settings) setting.by_height.resize(heights.size());
  const auto append = [](const std::vector<ProtocolError>& from,
                         std::vector<ProtocolError>* to) {
    to->insert(to->end(), from.begin(), from.end());
  };
  for (int draw = 1; draw <= kDraws; ++draw) {
    const Finger calibrated = lab.Calibrated(draw, 2);
    std::mt19937_64 generator(draw);
    for (Setting& setting : settings) {
      FrameEstimator estimator(setting.calibrated ? calibrated : lab.finger(),
                               one, {});
      const Finger* noise = setting.noise ? &lab.finger() : nullptr;
      const auto errors = [&](const std::vector<ProtocolFrame>& frames) {
        return ProtocolErrors(frames, noise, &estimator, &generator);
      };
      for (int repeat = 0; repeat < (noise ? kRepeats : 1); ++repeat) {
        append(errors(grid), &setting.grid);
        for (std::size_t h = 0; h < heights.size(); ++h) {
          append(errors(by_height[h]), &setting.by_height[h]);
        }
      }
    }
  }
  std::printf("%d draws of %zu frames, mean force %.2f N\n", kDraws,
              grid.size(), [&] {
                double sum = 0;
                for (const auto& frame : grid) sum += frame.contact.normal_N;
                return sum / grid.size();
              }());
  PrintGrid(settings);
  PrintHeights(heights, settings, path);
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  finray::Run(argc > 1 ? argv[1] : "/dev/null");
}
