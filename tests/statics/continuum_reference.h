#ifndef FINRAY_TESTS_STATICS_CONTINUUM_REFERENCE_H_
#define FINRAY_TESTS_STATICS_CONTINUUM_REFERENCE_H_

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "finray/io/frame_table.h"
#include "finray/io/number_text.h"
#include "finray/statics/equilibrium.h"
#include "test_finger.h"

namespace finray {

/// A file of tests/statics/reference, made by scripts/make_reference.py.
class ContinuumReference {
 public:
  explicit ContinuumReference(const std::string& file)
      : table_(FrameTable::Read(FINRAY_SOURCE_DIR "/tests/statics/reference/" +
                                file)) {}

  std::size_t rows() const { return table_.rows(); }
  const std::string& Text(const std::string& column, std::size_t row) {
    return table_.MutableText(column)[row];
  }
  /// A number of a column outside the vocabulary.
  double Parsed(const std::string& column, std::size_t row) {
    return ParseNumber(Text(column, row)).value();
  }
  double Number(const std::string& column, std::size_t row) const {
    return table_.Numbers(column)[row];
  }

  Finger FingerOf(std::size_t row) {
    Finger finger = PaperFinger();
    finger.front_stiffness_N_mm2 = Parsed("front_stiffness_N_mm2", row);
    finger.back_stiffness_N_mm2 = Parsed("back_stiffness_N_mm2", row);
    return finger;
  }

  std::vector<PointContact> Contacts(std::size_t row) const {
    std::vector<PointContact> contacts;
    for (int c = 1; table_.Has(Indexed("contact_", c, "_mm")); ++c) {
      const double arc = Number(Indexed("contact_", c, "_mm"), row);
      if (std::isnan(arc)) break;
      contacts.push_back({arc, Number(Indexed("normal_", c, "_N"), row),
                          Number(Indexed("friction_", c, ""), row)});
    }
    return contacts;
  }

  /// Largest error of a solved equilibrium: positions over l_0, angles in rad,
  /// rib tensions and gauge angles over the largest of their kind.
  double Error(std::size_t row, const EquilibriumSolver& solver) const {
    const Finger& finger = solver.model().finger();
    double worst = PoseError(row, "tip", solver.tip_pose());
    const int contacts = static_cast<int>(Contacts(row).size());
    for (int c = 0; c < contacts; ++c) {
      worst = std::max(worst, PoseError(row, Indexed("contact_", c + 1, ""),
                                        solver.contact_pose(c)));
    }
    std::vector<std::pair<double, double>> ribs, gauges;
    for (int i = 0; i < static_cast<int>(finger.ribs.size()); ++i) {
      ribs.push_back(
          {solver.rib_tension(i), Number(Indexed("rib_", i + 1, "_N"), row)});
    }
    for (int j = 0; j < static_cast<int>(finger.gauges.size()); ++j) {
      gauges.push_back({solver.gauge_angle(j),
                        Number(Indexed("gauge_", j + 1, "_rad"), row)});
    }
    return std::max({worst, OverLargest(ribs), OverLargest(gauges)});
  }

 private:
  static std::string Indexed(const std::string& before, int index,
                             const std::string& after) {
    return before + std::to_string(index) + after;
  }

  double PoseError(std::size_t row, const std::string& what,
                   const Eigen::Vector3d& pose) const {
    constexpr double kLength = 140;
    return std::max({std::abs(pose.x() - Number(what + "_x_mm", row)) / kLength,
                     std::abs(pose.y() - Number(what + "_y_mm", row)) / kLength,
                     std::abs(pose.z() - Number(what + "_angle_rad", row))});
  }

  // Of (value, reference) pairs.
  static double OverLargest(
      const std::vector<std::pair<double, double>>& pairs) {
    double error = 0, largest = 0;
    for (const auto& [value, reference] : pairs) {
      error = std::max(error, std::abs(value - reference));
      largest = std::max(largest, std::abs(reference));
    }
    return error / largest;
  }

  FrameTable table_;
};

/// Worst error and failures by group, and the table of them.
class ErrorsByGroup {
 public:
  void Add(const std::string& group, const std::string& name, double error) {
    Entry& entry = entries_[group];
    ++entry.cases;
    if (error < entry.worst) return;
    entry.worst = error;
    entry.name = name;
  }
  void AddFailure(const std::string& group) {
    ++entries_[group].cases;
    ++entries_[group].failed;
  }
  void Print(const std::string& title) const {
    std::cout << title
              << "\n| group | cases | not solved | worst error | at |\n"
              << "|---|---|---|---|---|\n"
              << std::setprecision(2);
    for (const auto& [group, entry] : entries_) {
      std::cout << "| " << group << " | " << entry.cases << " | "
                << entry.failed << " | " << entry.worst << " | " << entry.name
                << " |\n";
    }
  }

 private:
  struct Entry {
    int cases = 0, failed = 0;
    double worst = 0;
    std::string name;
  };
  std::map<std::string, Entry> entries_;
};

}  // namespace finray

#endif  // FINRAY_TESTS_STATICS_CONTINUUM_REFERENCE_H_
