// What gauges can tell of two contacts: the Cramer-Rao bounds of both places
// and forces over pairs of places, noise 1e-4 rad, four gauges on the back beam
// against eight on both; then whether "auto" counts 0, 1 and 2 contacts, drawn
// where the bounds are small enough, seed 1. With a path it writes the bounds
// of all pairs as CSV.
//
//   build/test/tests/two_contacts_study [BOUNDS.csv]

#include <cstdio>
#include <fstream>

#include "finray/estimation/frame_estimator.h"
#include "finray/finger/finger_yaml.h"
#include "studies/gauge_frames.h"

namespace finray {
namespace {

constexpr double kNoise_rad = 1e-4;

struct Layout {
  const char* name;
  Finger finger;
};

Layout Read(const char* name, const std::string& file) {
  Layout layout{name, ReadFinger(FINRAY_SOURCE_DIR "/configs/fingers/" + file)};
  for (Gauge& gauge : layout.finger.gauges) gauge.noise_V = kNoise_rad;
  return layout;
}

// Std of l_1, f_1, l_2, f_2; infinite where the gauges tell nothing to
// rounding.
Eigen::VectorXd Bounds(const std::vector<PointContact>& contacts,
                       EquilibriumSolver* solver) {
  const Eigen::VectorXd variance =
      CramerRaoCovariance(contacts, solver).diagonal();
  return (variance.array() > 0)
      .select(variance.array().sqrt(), std::numeric_limits<double>::infinity());
}

// Places to 5 % of l_0 and forces to a quarter, the limits of
// FrameStatus::kUnobservable.
bool IsUsable(const Finger& finger, const std::vector<PointContact>& contacts,
              const Eigen::VectorXd& bounds) {
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (!(bounds[2 * c] <
          FrameEstimator::kLargestArcStd * finger.front_length_mm) ||
        !(bounds[2 * c + 1] <
          FrameEstimator::kLargestForceStd * contacts[c].normal_N)) {
      return false;
    }
  }
  return true;
}

void PrintBounds(const Layout& layout, double force_N) {
  EquilibriumSolver solver(layout.finger, {});
  std::printf(
      "\n%s, %g N each\n\n| l_1, l_2, mm | std of l_1, l_2, mm | std of f_1, "
      "f_2, N | usable |\n|---|---|---|---|\n",
      layout.name, force_N);
  for (int first = 20; first <= 100; first += 20) {
    for (int second = first + 20; second <= 120; second += 20) {
      const std::vector<PointContact> contacts = {{double(first), force_N, 0},
                                                  {double(second), force_N, 0}};
      const Eigen::VectorXd b = Bounds(contacts, &solver);
      std::printf("| %d, %d | %.2f, %.2f | %.3f, %.3f | %s |\n", first, second,
                  b[0], b[2], b[1], b[3],
                  IsUsable(layout.finger, contacts, b) ? "yes" : "no");
    }
  }
}

void PrintShares(const std::vector<Layout>& layouts, std::ofstream* csv) {
  *csv << "gauges,force_N,contact_1_mm,contact_2_mm,contact_1_std_mm,"
          "contact_2_std_mm,normal_1_std_N,normal_2_std_N,usable\n";
  std::printf(
      "\n| gauges | force, N | pairs | usable | median of the larger std of l, "
      "mm, and of f, %% |\n|---|---|---|---|---|\n");
  for (const Layout& layout : layouts) {
    EquilibriumSolver solver(layout.finger, {});
    for (const double force : {1.0, 3.0, 8.0}) {
      int usable = 0;
      std::vector<double> arc, share;
      for (double first = 16; first <= 128; first += 2) {
        for (double second = first + 4; second <= 128; second += 2) {
          const std::vector<PointContact> contacts = {{first, force, 0},
                                                      {second, force, 0}};
          const Eigen::VectorXd b = Bounds(contacts, &solver);
          const bool use = IsUsable(layout.finger, contacts, b);
          usable += use;
          arc.push_back(std::max(b[0], b[2]));
          share.push_back(100 * std::max(b[1], b[3]) / force);
          *csv << layout.finger.gauges.size() << ',' << force << ',' << first
               << ',' << second << ',' << b[0] << ',' << b[2] << ',' << b[1]
               << ',' << b[3] << ',' << use << '\n';
        }
      }
      const auto median = [](std::vector<double> v) {
        std::nth_element(v.begin(), v.begin() + v.size() / 2, v.end());
        return v[v.size() / 2];
      };
      std::printf("| %s | %g | %zu | %.0f %% | %.2f, %.1f |\n", layout.name,
                  force, arc.size(), 100.0 * usable / arc.size(), median(arc),
                  median(share));
    }
  }
}

// Contacts at random, 10 mm apart or more and 1 to 8 N each, until they are
// usable.
std::vector<PointContact> Draw(int count, EquilibriumSolver* solver,
                               std::mt19937_64* generator) {
  std::uniform_real_distribution<double> uniform;
  for (;;) {
    std::vector<PointContact> contacts;
    for (int c = 0; c < count; ++c) {
      const double arc = 16 + 112 * uniform(*generator);
      contacts.push_back({arc, std::pow(8, uniform(*generator)), 0});
    }
    if (count == 2 && contacts[1].arc_mm < contacts[0].arc_mm + 10) continue;
    if (count == 0 || IsUsable(solver->model().finger(), contacts,
                               Bounds(contacts, solver))) {
      return contacts;
    }
  }
}

void PrintCounts(const Layout& layout) {
  constexpr int kFrames = 2000;
  EquilibriumSolver solver(layout.finger, {});
  FrameEstimator estimator(layout.finger, Scene(), {});
  std::mt19937_64 generator(1);
  std::printf(
      "\n%s, contacts: auto, %d frames each\n\n| true contacts | found 0 | 1 | "
      "2 | not solved | right, %% | of these l_c and f_c within 1.96 std, %% "
      "|\n|---|---|---|---|---|---|---|\n",
      layout.name, kFrames);
  for (int count = 0; count <= 2; ++count) {
    int found[3] = {}, unsolved = 0, within = 0, numbers = 0;
    for (int i = 0; i < kFrames; ++i) {
      const std::vector<PointContact> contacts =
          Draw(count, &solver, &generator);
      solver.Solve(contacts);
      const FrameEstimate estimate = estimator.Estimate(
          WithNoise(CleanReadings(solver), layout.finger, &generator));
      if (estimate.status == FrameStatus::kNotConverged) {
        ++unsolved;
        continue;
      }
      ++found[estimate.contacts];
      if (estimate.contacts != count) continue;
      for (int c = 0; c < count; ++c) {
        const ContactEstimate& e = estimate.contact[c];
        within += std::abs(e.arc_mm - contacts[c].arc_mm) < 1.96 * e.arc_std_mm;
        within +=
            std::abs(e.normal_N - contacts[c].normal_N) < 1.96 * e.normal_std_N;
        numbers += 2;
      }
    }
    std::printf("| %d | %d | %d | %d | %d | %.1f | ", count, found[0], found[1],
                found[2], unsolved, 100.0 * found[count] / kFrames);
    std::printf(numbers > 0 ? "%.1f |\n" : "|\n", 100.0 * within / numbers);
    std::fflush(stdout);
  }
}

void Run(const char* csv_path) {
  const std::vector<Layout> layouts = {
      Read("4 back", "paper_140mm.yaml"),
      Read("4 back, 4 front", "paper_140mm_eight_gauges.yaml")};
  for (const Layout& layout : layouts) PrintBounds(layout, 3);
  std::ofstream csv(csv_path);
  PrintShares(layouts, &csv);
  for (const Layout& layout : layouts) PrintCounts(layout);
}

}  // namespace
}  // namespace finray

int main(int argc, char** argv) {
  finray::Run(argc > 1 ? argv[1] : "/dev/null");
}
