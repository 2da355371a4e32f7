#include "finray/calib/solve/outliers.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "finray/calib/problem/median.h"
#include "finray/calib/solve/frame_pass.h"
#include "finray/estimation/chi_squared.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

struct FrameChi2 {
  int frame;
  double chi2;
  int dof;
};

// Wilson and Hilferty's approximation.
double MedianOfChi2(int dof) { return dof * std::pow(1 - 2.0 / (9 * dof), 3); }

int Dof(const CalibrationProblem& problem, int frame, std::size_t rows) {
  return static_cast<int>(rows) - (problem.frame(frame).contact ? 2 : 0);
}

std::vector<FrameChi2> OfFittedFrames(const Linearization& at,
                                      const CalibrationProblem& problem) {
  std::vector<FrameChi2> frames;
  for (std::size_t i = 0; i < at.rows.size();) {
    const int frame = at.rows[i].frame;
    double chi2 = 0;
    const std::size_t first = i;
    for (; i < at.rows.size() && at.rows[i].frame == frame; ++i) {
      chi2 += at.residuals[i] * at.residuals[i];
    }
    frames.push_back({frame, chi2, Dof(problem, frame, i - first)});
  }
  return frames;
}

std::string Name(const LinearizedFrame::Row& row) {
  switch (row.family) {
    case ResidualFamily::kGauge:
    case ResidualFamily::kBench:
      return "gauge " + std::to_string(row.gauge + 1);
    case ResidualFamily::kForce:
      return "force";
    case ResidualFamily::kObject:
      return "object's place";
    case ResidualFamily::kContact:
      return "contact's place";
    case ResidualFamily::kPin:
      return "a pin";
    case ResidualFamily::kTip:
      return "tip";
    case ResidualFamily::kEquilibrium:
      break;
  }
  return "";
}

// Says why a frame is an outlier. It blames one measurement if the others agree
// with each other.
std::string Reason(const LinearizedFrame& robust, double chi2, int dof,
                   double scale, double threshold) {
  std::map<std::string, std::pair<double, int>> parts;  // chi2, rows
  double all = 0;
  for (std::size_t i = 0; i < robust.rows.size(); ++i) {
    const double r = robust.residuals[static_cast<Eigen::Index>(i)];
    auto& [part, rows] = parts[Name(robust.rows[i])];
    part += r * r;
    all += r * r;
    ++rows;
  }
  const auto worst = std::max_element(parts.begin(), parts.end(),
                                      [](const auto& a, const auto& b) {
                                        return a.second.first < b.second.first;
                                      });
  const auto [part, rows] = worst->second;
  const int rest = dof - rows;
  if (rest < 1 ||
      ChiSquaredTail((all - part) / (scale * scale), rest) > threshold) {
    return FormatText("%s is off by %.3g std", worst->first.c_str(),
                      std::sqrt(part));
  }
  return FormatText(
      "measurements contradict each other (chi2 %.3g, %d degrees "
      "of freedom), %s most of all",
      chi2, dof, worst->first.c_str());
}

bool IsOutlier(const FrameChi2& frame, double scale, double threshold) {
  return frame.dof >= 1 &&
         ChiSquaredTail(frame.chi2 / (scale * scale), frame.dof) <= threshold;
}

// Fits the contact of each frame. Frames that cannot be evaluated go to
// `reasons`. `found->scale` is the scale as far as it is known.
std::vector<FrameChi2> Refit(const std::vector<int>& frames,
                             CalibrationProblem* problem,
                             ContactStore* contacts, Outliers* found) {
  const double threshold =
      Outliers::kFalseAlarms / static_cast<double>(frames.size());
  std::vector<FrameChi2> refitted;
  found->rest.emplace(static_cast<int>(problem->parameters().free().size()),
                      frames.size());
  FitContacts(frames, problem, contacts,
              [&](int frame, const LinearizedFrame& at) {
                if (at.rows.empty()) {
                  found->reasons.emplace(
                      frame, "the finger cannot carry what the frame shows");
                  return;
                }
                refitted.push_back({frame, at.residuals.squaredNorm(),
                                    Dof(*problem, frame, at.rows.size())});
                if (IsOutlier(refitted.back(), found->scale, threshold)) return;
                found->rest->Add(frame, problem->frame(frame).log, at);
                contacts->Move(frame, at.move.now);
              });
  found->rest->Finish();
  return refitted;
}

void SetScale(const std::vector<FrameChi2>& frames, Outliers* found) {
  std::vector<double> ratios;
  for (const FrameChi2& frame : frames) {
    if (frame.dof > 0) ratios.push_back(frame.chi2 / MedianOfChi2(frame.dof));
  }
  if (ratios.empty()) return;
  found->scale = std::sqrt(std::max(1.0, Median(ratios)));
}

void Judge(const std::vector<FrameChi2>& frames, CalibrationProblem* problem,
           ContactStore* contacts, Outliers* found) {
  const auto count = static_cast<double>(frames.size() + found->reasons.size());
  const double threshold = Outliers::kFalseAlarms / count;
  std::vector<int> unexplained;
  std::map<int, FrameChi2> chi2_of;
  for (const FrameChi2& frame : frames) {
    if (!IsOutlier(frame, found->scale, threshold)) continue;
    unexplained.push_back(frame.frame);
    chi2_of.emplace(frame.frame, frame);
  }
  found->too_many =
      static_cast<double>(unexplained.size() + found->reasons.size()) >
      Outliers::kMostShare * count;
  if (found->too_many) {
    found->reasons.clear();
    return;
  }
  FitContactsRobustly(
      unexplained, problem, contacts,
      [&](int frame, const LinearizedFrame& at) {
        if (at.rows.empty()) return;
        const FrameChi2& its = chi2_of.at(frame);
        found->reasons.emplace(
            frame, Reason(at, its.chi2, its.dof, found->scale, threshold));
      });
}

}  // namespace

Outliers FindOutliers(const Linearization& at_solution,
                      CalibrationProblem* problem, ContactStore* contacts) {
  Outliers found;
  std::vector<FrameChi2> frames = OfFittedFrames(at_solution, *problem);
  SetScale(frames, &found);
  std::vector<int> rejected;
  for (const auto& [frame, reason] : problem->rejected()) {
    if (problem->impossible().count(frame) == 0) rejected.push_back(frame);
  }
  for (const FrameChi2& frame : Refit(rejected, problem, contacts, &found)) {
    frames.push_back(frame);
  }
  Judge(frames, problem, contacts, &found);
  found.reasons.insert(problem->impossible().begin(),
                       problem->impossible().end());
  return found;
}

Outliers FindOutliersAmong(const std::vector<int>& frames,
                           double expected_scale, CalibrationProblem* problem,
                           ContactStore* contacts) {
  Outliers found;
  found.scale = expected_scale;
  const std::vector<FrameChi2> refitted =
      Refit(frames, problem, contacts, &found);
  SetScale(refitted, &found);
  Judge(refitted, problem, contacts, &found);
  return found;
}

}  // namespace finray
