// Compares two calibrations of one finger, and what they do to estimates.

#include <cmath>
#include <cstdio>

#include "app.h"
#include "finray/calib/analysis/calibration_comparison.h"
#include "finray/io/atomic_file.h"
#include "finray/io/message_text.h"

DEFINE_string(out_dir, "", "folder for comparison.yaml and comparison.csv");
DEFINE_double(most_sigma, 0,
              "gate: a parameter's difference over its std; default: none");
DEFINE_double(least_p_value, 0,
              "gate: probability of chi2 over all parameters; default: none");
DEFINE_double(
    most_force_difference_N, 0,
    "gate: force from the same readings, over the grid; default: none");
DEFINE_double(
    most_contact_difference_mm, 0,
    "gate: place from the same readings, over the grid; default: none");

namespace {

using namespace finray;

std::vector<std::string> folders;

std::vector<Gate> Gates(const Comparison& comparison) {
  const Comparison::Largest most = comparison.largest();
  const Comparison::Parameter* worst = comparison.LargestSigma();
  const auto nan = std::nan("");
  const bool any = most.points > 0;
  std::vector<Gate> gates;
  const auto at_most = [&](const char* name, double bound, double value) {
    if (bound > 0) gates.push_back({name, bound, value, value <= bound});
  };
  at_most("most_sigma", FLAGS_most_sigma,
          worst == nullptr ? nan : std::abs(worst->sigma()));
  if (FLAGS_least_p_value > 0) {
    const double p = comparison.p_value();
    gates.push_back(
        {"least_p_value", FLAGS_least_p_value, p, p >= FLAGS_least_p_value});
  }
  // A point at which only A senses a contact fails the gate.
  const auto in_field = [&](const char* name, double bound, double value) {
    if (bound == 0) return;
    gates.push_back({name, bound, any ? value : nan,
                     any && most.lost == 0 && value <= bound});
  };
  in_field("most_force_difference_N", FLAGS_most_force_difference_N,
           most.force_N);
  in_field("most_contact_difference_mm", FLAGS_most_contact_difference_mm,
           most.contact_mm);
  return gates;
}

void PrintNames(const char* what, const std::vector<std::string>& names) {
  if (!names.empty()) std::printf("%s %s\n", what, Joined(names).c_str());
}

void PrintSummary(const Comparison& comparison,
                  const std::vector<Gate>& gates) {
  std::printf("%s\n", OutPath("comparison.yaml").c_str());
  const Comparison::Parameter* worst = comparison.LargestSigma();
  std::printf("parameters     %zu, largest difference %.2f std (%s, %.4g %s)\n",
              comparison.parameters.size(), std::abs(worst->sigma()),
              worst->name.c_str(), worst->b - worst->a, worst->unit.c_str());
  PrintNames("only in A     ", comparison.only_a);
  PrintNames("only in B     ", comparison.only_b);
  PrintNames("of other logs ", comparison.of_other_logs);
  std::printf("all together   chi2/dof %.2f over %d, p %.2g",
              comparison.chi2 / comparison.dof, comparison.dof,
              comparison.p_value());
  if (comparison.shared_logs > 0) {
    std::printf("; %d log%s in common, which makes std too large",
                comparison.shared_logs, comparison.shared_logs == 1 ? "" : "s");
  }
  const Comparison::Largest most = comparison.largest();
  std::printf("\nforce          ");
  if (most.points == 0) {
    std::printf("not comparable: B senses no contact of the grid\n");
    std::printf("contact        not comparable\n");
  } else {
    std::printf(
        "%.3g N rms, %.3g N at most (%.2f std) from the same readings, %d of "
        "%zu points",
        most.force_rms_N, most.force_N, most.force_over_std, most.points,
        comparison.grid.size());
    if (most.lost > 0) std::printf("; %d more that only A senses", most.lost);
    std::printf("\n");
    std::printf("contact        %.3g mm rms, %.3g mm at most (%.2f std)\n",
                most.contact_rms_mm, most.contact_mm, most.contact_over_std);
  }
  std::printf("gates          %s\n", GateWords(gates).c_str());
}

int Run() {
  if (folders.size() != 2) {
    throw UsageError("expected two calibrations, found " +
                     std::to_string(folders.size()));
  }
  Required("out_dir", FLAGS_out_dir);
  const std::pair<const char*, double> bounds[] = {
      {"most_sigma", FLAGS_most_sigma},
      {"least_p_value", FLAGS_least_p_value},
      {"most_force_difference_N", FLAGS_most_force_difference_N},
      {"most_contact_difference_mm", FLAGS_most_contact_difference_mm}};
  for (const auto& [name, bound] : bounds) {
    if (IsGiven(name) && (!(bound > 0) || std::isinf(bound))) {
      throw UsageError(std::string("--") + name +
                       ": expected a number above 0");
    }
  }
  const Discretization discretization = DiscretizationFlags();
  const CalibrationFile a = ReadCalibration(folders[0]);
  const CalibrationFile b = ReadCalibration(folders[1]);
  const Comparison comparison = Compare(a, b, discretization);
  const std::vector<Gate> gates = Gates(comparison);
  MakeFolder(FLAGS_out_dir);
  WriteFileAtomically(OutPath("comparison.yaml"),
                      ComparisonYaml(comparison, a, b, gates));
  ComparisonGrid(comparison).Write(OutPath("comparison.csv"));
  PrintSummary(comparison, gates);
  return AllPassed(gates) ? kGood : kGateFailed;
}

}  // namespace

const finray::App finray::kApp = {
    "Difference of two calibrations over its std, and what it does to "
    "estimates.\n"
    "finray_compare A B --out_dir D [--most_sigma 4]; A and B are result "
    "folders of finray_calibrate",
    Run, &folders};
