// Contacts and wandering gauge offsets of whole logs (LogEstimator): simulated
// logs of ten minutes, offsets that wander by 1 mV per square root of a second,
// touches of 5 to 15 s and gaps of 2 to 6 s. Compares the whole-log problem
// with offsets that are interpolated between the gaps, known from the truth,
// and with frames by themselves.
//
//   build/test/tests/joint_study [logs] [rate_Hz] [first seed] [others: 1]
//   build/test/tests/joint_study write <frames> <log.csv>
//
// Without the others (0), only the whole-log problem is solved. The second form
// writes one such log, of any length, for finray_estimate.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "estimation/wandering_log.h"
#include "finray/estimation/frame_estimator.h"
#include "finray/estimation/log_estimator.h"
#include "test_finger.h"

namespace finray {
namespace {

struct Tally {
  std::size_t touching = 0, ok = 0, unobservable = 0, missed = 0, imagined = 0,
              unsolved = 0, unexplained = 0;
  double squares_N2 = 0, ok_squares_N2 = 0;
  std::size_t solved = 0;
  // Of l_c and f_c: frames within 1 and 1.96 std. Errors within a touch are
  // nearly one error, so touches are counted one by one.
  struct Touch {
    double ok = 0, within[2][2] = {};
  };
  std::vector<Touch> touches;
  bool touching_before = false;

  void Add(const PointContact& truth, const FrameEstimate& estimate) {
    const double force = estimate.contact[0].normal_N;
    if (truth.normal_N > 0 && !touching_before) touches.emplace_back();
    touching_before = truth.normal_N > 0;
    if (truth.normal_N <= 0) {
      imagined += estimate.contacts > 0;
      return;
    }
    ++touching;
    missed += estimate.status == FrameStatus::kNoContact;
    unobservable += estimate.status == FrameStatus::kUnobservable;
    if (std::isnan(force)) {
      ++unsolved;
      return;
    }
    const double error = force - truth.normal_N;
    ++solved;
    squares_N2 += error * error;
    if (estimate.status != FrameStatus::kOk) return;
    ++ok;
    unexplained += estimate.p_value() < FrameEstimate::kUnexplained;
    ok_squares_N2 += error * error;
    const double off[2] = {(estimate.contact[0].arc_mm - truth.arc_mm) /
                               estimate.contact[0].arc_std_mm,
                           error / estimate.contact[0].normal_std_N};
    Touch& touch = touches.back();
    ++touch.ok;
    for (int i = 0; i < 2; ++i) {
      touch.within[i][0] += std::abs(off[i]) < 1;
      touch.within[i][1] += std::abs(off[i]) < 1.96;
    }
  }
  // "68.0 +- 1.2": percent of the frames, and its std over touches.
  std::string Coverage(int unknown, int level) const {
    double frames = 0, within = 0, squares = 0;
    for (const Touch& touch : touches) {
      frames += touch.ok;
      within += touch.within[unknown][level];
    }
    const double share = within / frames;
    for (const Touch& touch : touches) {
      squares += std::pow(touch.within[unknown][level] - share * touch.ok, 2);
    }
    char text[40];
    std::snprintf(text, sizeof(text), "%.1f +- %.1f", 100 * share,
                  100 * std::sqrt(squares) / frames);
    return text;
  }
  void Print(const char* name) const {
    std::printf(
        "| %s | %.3f | %.3f | %s, %s | %s, %s | %zu | %zu | %zu | %zu | %zu | "
        "%zu |\n",
        name, std::sqrt(squares_N2 / static_cast<double>(solved)),
        std::sqrt(ok_squares_N2 / static_cast<double>(ok)),
        Coverage(0, 0).c_str(), Coverage(0, 1).c_str(), Coverage(1, 0).c_str(),
        Coverage(1, 1).c_str(), touching, ok, missed, imagined, unsolved,
        unexplained);
    std::fflush(stdout);
  }
};

std::vector<FrameEstimate> Joint(const Finger& finger, const Scene& scene,
                                 const std::vector<Measurements>& rows) {
  std::vector<FrameEstimate> estimates;
  LogEstimator estimator(finger, scene, {}, 1, [&](const FrameEstimate& e) {
    estimates.push_back(e);
  });
  for (const Measurements& row : rows) estimator.Add(row);
  estimator.Finish();
  return estimates;
}

// Offsets between the means of the gaps on both sides, which the truth tells,
// then every frame by itself.
std::vector<FrameEstimate> Interpolated(const Finger& finger,
                                        const WanderingLog& log,
                                        bool known_offsets) {
  FrameEstimator estimator(finger, Scene(), {});
  EquilibriumSolver free(finger, {});
  free.Solve({});
  struct Gap {
    double time_s;
    std::vector<double> offset_V;
  };
  std::vector<Gap> gaps;
  const std::size_t gauges = finger.gauges.size();
  for (std::size_t t = 0; t < log.rows.size();) {
    std::size_t end = t;
    Gap gap{0, std::vector<double>(gauges)};
    for (; end < log.rows.size() && log.truth[end].normal_N <= 0; ++end) {
      gap.time_s += log.rows[end].time_s;
      for (std::size_t j = 0; j < gauges; ++j) {
        gap.offset_V[j] +=
            log.rows[end].gauges_V[j] -
            finger.gauges[j].Volts(free.gauge_angle(static_cast<int>(j)));
      }
    }
    const auto count = static_cast<double>(end - t);
    if (end > t) {
      gap.time_s /= count;
      for (double& b : gap.offset_V) b /= count;
      gaps.push_back(gap);
    }
    t = end + 1;
  }
  std::vector<FrameEstimate> estimates;
  std::size_t next = 0;
  for (std::size_t t = 0; t < log.rows.size(); ++t) {
    Measurements row = log.rows[t];
    while (next < gaps.size() && gaps[next].time_s < row.time_s) ++next;
    const Gap& before = gaps[next == 0 ? 0 : next - 1];
    const Gap& after = gaps[std::min(next, gaps.size() - 1)];
    const double share =
        after.time_s > before.time_s
            ? (row.time_s - before.time_s) / (after.time_s - before.time_s)
            : 0;
    for (std::size_t j = 0; j < gauges; ++j) {
      row.gauges_V[j] -=
          known_offsets ? log.offsets_V[t][j]
                        : before.offset_V[j] +
                              share * (after.offset_V[j] - before.offset_V[j]);
    }
    estimates.push_back(estimator.Estimate(row));
  }
  return estimates;
}

std::vector<FrameEstimate> Alone(const Finger& finger,
                                 const std::vector<Measurements>& rows) {
  FrameEstimator estimator(finger, Scene(), {});
  std::vector<FrameEstimate> estimates;
  for (const Measurements& row : rows) {
    estimates.push_back(estimator.Estimate(row));
  }
  return estimates;
}

void Run(const char* plant_name, const Finger& plant,
         const Discretization& discretization, int logs, double rate_Hz,
         unsigned first_seed, bool others) {
  const Finger finger = PaperFinger();
  Scene scene;
  scene.gauge_offset_walk = {0.05, 0.001};
  Tally joint, interpolated, known, alone;
  double seconds = 0;
  std::size_t frames = 0;
  for (int i = 0; i < logs; ++i) {
    WanderingLogSettings settings;
    settings.rate_Hz = rate_Hz;
    settings.seed = first_seed + static_cast<unsigned>(i);
    const WanderingLog log(plant, discretization, settings);
    const auto start = std::chrono::steady_clock::now();
    const std::vector<FrameEstimate> by_joint = Joint(finger, scene, log.rows);
    seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
            .count();
    frames += log.rows.size();
    for (std::size_t t = 0; t < log.rows.size(); ++t) {
      joint.Add(log.truth[t], by_joint[t]);
    }
    if (!others) continue;
    const auto by_gaps = Interpolated(finger, log, false);
    const auto by_truth = Interpolated(finger, log, true);
    const auto by_frame = Alone(finger, log.rows);
    for (std::size_t t = 0; t < log.rows.size(); ++t) {
      interpolated.Add(log.truth[t], by_gaps[t]);
      known.Add(log.truth[t], by_truth[t]);
      alone.Add(log.truth[t], by_frame[t]);
    }
  }
  std::printf(
      "\n%s, %d logs at %g Hz; the whole-log problem takes %.3g ms a frame on "
      "one thread\n\n",
      plant_name, logs, rate_Hz, 1e3 * seconds / static_cast<double>(frames));
  std::printf(
      "| offsets | rms N | rms of ok | l_c within 1, 1.96 std, %% | f_c within "
      "1, 1.96 std, %% | touching | ok | missed | imagined | unsolved | "
      "unexplained |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  joint.Print("whole log (--joint)");
  if (!others) return;
  interpolated.Print("interpolated between gaps");
  known.Print("known");
  alone.Print("the finger's");
}

int Write(int frames, const char* path) {
  WanderingLogSettings settings;
  settings.duration_s = frames / settings.rate_Hz;
  const WanderingLog log(PaperFinger(), {Scheme::kTaylor12, 96}, settings);
  std::ofstream out(path);
  out.precision(9);
  out << "time_s,gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V,force_N\n";
  for (const Measurements& row : log.rows) {
    out << row.time_s;
    for (const double volts : row.gauges_V) out << ',' << volts;
    out << ',' << row.force_N << '\n';
  }
  return out.good() ? 0 : 1;
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  using namespace finray;
  if (argc == 4 && std::string(argv[1]) == "write") {
    return Write(std::atoi(argv[2]), argv[3]);
  }
  const int logs = argc > 1 ? std::atoi(argv[1]) : 20;
  const double rate_Hz = argc > 2 ? std::atof(argv[2]) : 10;
  const unsigned seed =
      argc > 3 ? static_cast<unsigned>(std::atoi(argv[3])) : 1;
  const bool others = argc <= 4 || std::atoi(argv[4]) != 0;
  const Finger finger = PaperFinger();
  Run("the same finger, other elements", finger, {Scheme::kTaylor12, 96}, logs,
      rate_Hz, seed, others);
  Finger other = finger;
  other.front_stiffness_N_mm2 *= 1.01;
  other.back_stiffness_N_mm2 *= 0.99;
  Run("rigid links, stiffness 1 % off", other, {Scheme::kRigidChain, 400}, logs,
      rate_Hz, seed, others);
}
