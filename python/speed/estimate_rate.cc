// Estimates a log in memory each time a line comes in, and prints the seconds
// by the clock and of the processor: the C++ side of python_speed.py.
// usage: estimate_rate FINGER.yaml GAUGES.bin FRAMES THREADS

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>

#include "finray/finray.h"

int main(int argc, char** argv) {
  if (argc != 5) return 1;
  const std::size_t frames = std::strtoul(argv[3], nullptr, 10);
  std::ifstream file(argv[2], std::ios::binary);
  finray::Table log(frames);
  for (int j = 1; j <= 4; ++j) {
    std::vector<double> volts(frames);
    file.read(reinterpret_cast<char*>(volts.data()),
              static_cast<std::streamsize>(frames * sizeof(double)));
    log.Set("gauge_" + std::to_string(j) + "_V", std::move(volts));
  }
  finray::EstimateOptions options;
  options.threads = std::atoi(argv[4]);
  const finray::Estimator estimator(finray::Finger::Read(argv[1]),
                                    finray::Scene::FromYaml("contacts: 1"),
                                    options);
  for (std::string line; std::getline(std::cin, line);) {
    const std::clock_t busy = std::clock();
    const auto start = std::chrono::steady_clock::now();
    const finray::Estimation found = estimator.Estimate(log);
    const std::chrono::duration<double> time =
        std::chrono::steady_clock::now() - start;
    if (found.rows() != frames) return 1;
    std::printf("%.9f %.9f\n", time.count(),
                static_cast<double>(std::clock() - busy) / CLOCKS_PER_SEC);
    std::fflush(stdout);
  }
}
