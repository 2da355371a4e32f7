#include "finray/estimation/smoothing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/estimation/block_tridiagonal.h"
#include "finray/estimation/log_problem.h"

namespace finray {
namespace {

// A frame is elsewhere if its own chi2 is so far above that of the frame alone:
// two degrees of freedom, p = 0.001.
constexpr double kElsewhere = 13.8;

using Std = Eigen::Array2d;  // of l_c and f_c

Std StdOf(const FrameEstimate& estimate) {
  return {estimate.contact[0].arc_std_mm, estimate.contact[0].normal_std_N};
}

void Widen(const Std& least, FrameEstimate* estimate) {
  ContactEstimate& contact = estimate->contact[0];
  contact.arc_std_mm = std::max(contact.arc_std_mm, least[0]);
  contact.normal_std_N = std::max(contact.normal_std_N, least[1]);
}

// Smooths the runs of a block.
class Smoother {
 public:
  Smoother(const Finger& finger, const Scene& scene,
           const Discretization& discretization, const Measurements* readings,
           FrameEstimate* estimates, std::vector<char>* sure)
      : finger_(finger),
        scene_(scene),
        discretization_(discretization),
        readings_(readings),
        estimates_(estimates),
        sure_(*sure) {}

  // Smooths the frames [begin, end), which have one contact each.
  LogPrior Run(std::size_t begin, std::size_t end, const LogPrior& before);

 private:
  std::vector<LogFrame> Frames(std::size_t begin, std::size_t end) const;
  LogPrior Parts(std::size_t begin, const std::vector<bool>& elsewhere);
  void Judge(std::size_t begin, const std::vector<Std>& alone);

  const Finger& finger_;
  const Scene& scene_;
  const Discretization& discretization_;
  const Measurements* readings_;
  FrameEstimate* estimates_;
  std::vector<char>& sure_;
};

std::vector<LogFrame> Smoother::Frames(std::size_t begin,
                                       std::size_t end) const {
  const Eigen::VectorXd offsets_V = GaugeOffsets(finger_);
  std::vector<LogFrame> frames;
  for (std::size_t t = begin; t < end; ++t) {
    LogFrame& frame = frames.emplace_back();
    frame.row = readings_[t];
    frame.role = LogFrame::Role::kTouching;
    frame.noise_scale = estimates_[t].noise_scale();
    frame.arc_mm = estimates_[t].contact[0].arc_mm;
    frame.normal_N = frame.expected_N = estimates_[t].contact[0].normal_N;
    frame.offset_V = offsets_V;
  }
  return frames;
}

LogPrior Smoother::Run(std::size_t begin, std::size_t end,
                       const LogPrior& before) {
  const std::size_t count = end - begin;
  std::vector<LogFrame> frames = Frames(begin, end);
  LogProblem problem(finger_, scene_, discretization_, 1, &frames, before);
  problem.Solve();
  if (!problem.converged()) return {};  // the frames remain what they are
  const std::vector<LogMarginal> marginals = problem.Marginals();
  std::vector<bool> elsewhere(count);
  for (std::size_t t = 0; t < count; ++t) {
    const double scale = frames[t].noise_scale;
    const double alone = estimates_[begin + t].chi2 / (scale * scale);
    elsewhere[t] = !(marginals[t].chi2 - alone < kElsewhere);
  }
  if (std::find(elsewhere.begin(), elsewhere.end(), true) != elsewhere.end()) {
    const bool alone = count == 1 && before.mean.size() == 0;
    return alone ? LogPrior() : Parts(begin, elsewhere);
  }
  // A frame alone has nothing to be smoothed with, but the next may have.
  if (count > 1 || before.mean.size() > 0) {
    std::vector<Std> alone;
    for (std::size_t t = 0; t < count; ++t) {
      FrameEstimate& estimate = estimates_[begin + t];
      alone.push_back(StdOf(estimate));
      frames[t].CopyTo(marginals[t].covariance, &estimate);
      estimate.change_chi2 = marginals[t].change_chi2;
      estimate.change_dof = marginals[t].change_dof;
    }
    if (before.mean.size() > 0) {
      // The change from what the frames before predict.
      const Eigen::Vector2d change =
          Eigen::Vector2d(frames[0].arc_mm, frames[0].normal_N) - before.mean;
      estimates_[begin].change_chi2 = change.dot(before.information * change);
      estimates_[begin].change_dof =
          2 - (marginals[0].covariance * before.information).trace();
    }
    Judge(begin, alone);
  }
  Eigen::MatrixXd next = marginals.back().covariance;
  next(0, 0) += std::pow(scene_.smoothing->contact_mm, 2);
  next(1, 1) += std::pow(scene_.smoothing->normal_N, 2);
  return {Eigen::Vector2d(frames.back().arc_mm, frames.back().normal_N),
          InverseInformation(next)};
}

// A run that takes frames elsewhere joins two places. Its parts are smoothed
// each by itself. If all frames are elsewhere, each frame is a part.
LogPrior Smoother::Parts(std::size_t begin,
                         const std::vector<bool>& elsewhere) {
  const bool all =
      std::find(elsewhere.begin(), elsewhere.end(), false) == elsewhere.end();
  LogPrior known;
  for (std::size_t from = 0; from < elsewhere.size();) {
    std::size_t to = from + 1;
    while (!all && to < elsewhere.size() && elsewhere[to] == elsewhere[from]) {
      ++to;
    }
    known = Run(begin + from, begin + to, {});
    from = to;
  }
  return known;
}

// Neighbours do not narrow what is ambiguous, because they may all be wrong
// alike. A frame in a valley keeps its std. A frame that is not sure by itself
// is known no better than the nearest one that is, and the way between them.
void Smoother::Judge(std::size_t begin, const std::vector<Std>& alone) {
  const Std unknown = Std::Constant(std::numeric_limits<double>::infinity());
  const Std walk(scene_.smoothing->contact_mm, scene_.smoothing->normal_N);
  const std::size_t count = alone.size();
  std::vector<Std> least(count, unknown);
  const auto spread = [&](const auto& at) {
    Std known = unknown;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t t = at(i);
      FrameEstimate& estimate = estimates_[begin + t];
      if (sure_[begin + t] && estimate.noise_scale() == 1) {
        if (estimate.valley) Widen(alone[t], &estimate);
        known = StdOf(estimate);
      } else {
        known = (known.square() + walk.square()).sqrt();
        least[t] = least[t].min(known);
      }
    }
  };
  spread([](std::size_t i) { return i; });
  spread([count](std::size_t i) { return count - 1 - i; });
  for (std::size_t t = 0; t < count; ++t) {
    FrameEstimate& estimate = estimates_[begin + t];
    if (sure_[begin + t] && estimate.noise_scale() == 1) continue;
    const bool told = std::isfinite(least[t][0]);
    sure_[begin + t] = told;
    Widen(told ? least[t] : alone[t], &estimate);
  }
}

}  // namespace

LogPrior Smooth(const Finger& finger, const Scene& scene,
                const Discretization& discretization,
                const Measurements* readings, std::size_t count,
                const LogPrior& before, FrameEstimate* estimates,
                std::vector<char>* sure) {
  Smoother smoother(finger, scene, discretization, readings, estimates, sure);
  LogPrior known = before;
  for (std::size_t begin = 0; begin < count;) {
    std::size_t end = begin;
    while (end < count && estimates[end].contacts == 1) ++end;
    if (end > begin) known = smoother.Run(begin, end, known);
    if (end < count) known = {};
    begin = std::max(end, begin + 1);
  }
  return known;
}

}  // namespace finray
