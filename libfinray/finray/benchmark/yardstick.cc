#include <array>
#include <ctime>

#include "finray/benchmark/statistics.h"

namespace finray {
namespace {

constexpr int kSize = 48;
constexpr int kRow = 56;  // whole cache lines
constexpr int kTimes = 2;

// Returns the sum of the solution, so that no compiler leaves the work out.
[[gnu::noinline]] double Eliminate(double shift) {
  // Aligned data, like aligned code (CMakeLists.txt), takes the same time in
  // every build.
  alignas(64) static thread_local std::array<std::array<double, kRow>, kSize> a;
  for (int i = 0; i < kSize; ++i) {
    for (int j = 0; j <= kSize; ++j) {
      a[i][j] = 1. / (1 + i + j) + (i == j ? 2 + shift : 0);
    }
  }
  for (int k = 0; k < kSize; ++k) {
    for (int i = 0; i < kSize; ++i) {
      if (i == k) continue;
      const double factor = a[i][k] / a[k][k];
      for (int j = k; j <= kSize; ++j) a[i][j] -= factor * a[k][j];
    }
  }
  double sum = 0;
  for (int k = 0; k < kSize; ++k) sum += a[k][kSize] / a[k][k];
  return sum;
}

volatile double result;

}  // namespace

double ThreadSeconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) +
         1e-9 * static_cast<double>(now.tv_nsec);
}

double YardstickUs() {
  const double start = ThreadSeconds();
  double sum = 0;
  for (int i = 0; i < kTimes; ++i) sum += Eliminate(sum);
  result = sum;
  return 1e6 * (ThreadSeconds() - start);
}

}  // namespace finray
