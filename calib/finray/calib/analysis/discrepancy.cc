#include "finray/calib/analysis/discrepancy.h"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "finray/calib/analysis/cross_validation.h"
#include "finray/calib/analysis/validation.h"
#include "finray/calib/solve/contact_store.h"
#include "finray/calib/solve/frame_pass.h"
#include "finray/estimation/chi_squared.h"
#include "finray/fit/calibration_errors.h"
#include "finray/io/number_text.h"

namespace finray {
namespace {

// The loads and the numbers of places that are tried.
constexpr double kLoads_N[] = {0.3, 1, 3, 10, 100};
constexpr int kPlaces[] = {1, 3, 5};
// A model has as many numbers as its criterion charges; fewer errors than this
// for each of them say nothing.
constexpr double kLeastErrors = 2;
constexpr int kRounds = 50;
// A rejected frame counts if errors so many times larger explain it with this
// probability; else something else was wrong with it.
constexpr double kWide = 3, kOutlier = 1e-3;

struct Model {
  GaugeDiscrepancy discrepancy;
  double log_likelihood = -std::numeric_limits<double>::infinity();
};

// -2 of it is ln det C + e' C^-1 e.
double LogLikelihood(const GaugeError& at, const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  const Eigen::MatrixXd l = root.matrixL();
  return -l.diagonal().array().log().sum() -
         0.5 * root.matrixL().solve(at.error_rad).squaredNorm();
}

double LogLikelihood(const std::vector<GaugeError>& errors,
                     const GaugeDiscrepancy* discrepancy) {
  double sum = 0;
  for (const GaugeError& at : errors) {
    Eigen::MatrixXd covariance = at.expected;
    if (discrepancy != nullptr) {
      discrepancy->AddTo(at.place_mm, at.force_N, &covariance);
    }
    sum += LogLikelihood(at, covariance);
  }
  return sum;
}

double SizeAt(double force_N, double load_N) {
  return 1 + force_N * force_N / (load_N * load_N);
}

// The covariance of a place: the maximum of the likelihood over these errors,
// by expectation and maximisation. With `kGauges` the compiler knows the sizes.
template <int kGauges>
Eigen::MatrixXd FitCovariance(const GaugeError* errors, std::size_t count,
                              double load_N) {
  using Square = Eigen::Matrix<double, kGauges, kGauges>;
  using Column = Eigen::Matrix<double, kGauges, 1>;
  const auto gauges = errors[0].error_rad.size();
  Square a = Square::Zero(gauges, gauges);
  for (std::size_t i = 0; i < count; ++i) {
    const Column error = errors[i].error_rad;
    a += error * error.transpose() / SizeAt(errors[i].force_N, load_N);
  }
  a /= static_cast<double>(count);
  // Work space, as small matrices cost less than their memory. A product or a
  // solve by all columns would pack them first.
  Square next(gauges, gauges), both(gauges, gauges), share(gauges, gauges);
  Column mean(gauges);
  Eigen::LLT<Square> root(gauges);
  for (int round = 0; round < kRounds; ++round) {
    next.setZero();
    for (std::size_t i = 0; i < count; ++i) {
      const GaugeError& at = errors[i];
      const double s = SizeAt(at.force_N, load_N);
      // The discrepancy of this frame, given its error.
      both = at.expected + s * a;
      root.compute(both);
      share = a;
      for (Eigen::Index j = 0; j < gauges; ++j) root.solveInPlace(share.col(j));
      share *= s;
      mean.noalias() = share.transpose().lazyProduct(at.error_rad);
      next += a;
      next.noalias() += mean.lazyProduct(mean.transpose()) / s;
      next.noalias() -= share.transpose().lazyProduct(a);
    }
    a = 0.5 / static_cast<double>(count) * (next + next.transpose());
  }
  return a;
}

// The places are the middles of as many lengths with equally many errors.
Model FitModel(const std::vector<GaugeError>& errors, double load_N,
               int places) {
  Model model;
  model.discrepancy.load_N = load_N;
  const std::size_t n = errors.size();
  for (int p = 0; p < places; ++p) {
    const std::size_t first = n * p / places, last = n * (p + 1) / places;
    double middle = 0;
    for (std::size_t i = first; i < last; ++i) middle += errors[i].place_mm;
    const auto fit = errors[0].error_rad.size() == 4
                         ? FitCovariance<4>  // the usual finger
                         : FitCovariance<Eigen::Dynamic>;
    model.discrepancy.places.push_back(
        {middle / static_cast<double>(last - first),
         fit(&errors[first], last - first, load_N)});
  }
  model.log_likelihood = LogLikelihood(errors, &model.discrepancy);
  return model;
}

// The frames of a problem at its values, which have not seen them.
void AddErrors(CalibrationProblem* problem, const Finger& finger,
               const std::vector<int>& frames, const Contacts& contacts,
               std::vector<GaugeError>* errors) {
  const Plan& plan = problem->plan();
  CalibrationLogs logs;
  logs.paths = problem->logs().paths;
  logs.names = problem->logs().names;
  for (const int i : frames) logs.frames.push_back(problem->frame(i));
  logs = problem->parameters().Corrected(logs, finger);
  const double coefficient = problem->parameters().friction();
  CalibrationErrors calibration(finger, Scene::OfGauges(coefficient),
                                problem->discretization(),
                                CalibrationErrors::Surface::kNone);
  const Eigen::MatrixXd factor = finger.calibration->Factor();
  const auto gauges = static_cast<Eigen::Index>(finger.gauges.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const CalibrationFrame& frame = logs.frames[k];
    const auto [arc_mm, fitted_N] = contacts[frames[k]];
    const double friction = frame.FrictionOr(coefficient);
    const double measured_N =
        frame.Force().magnitude_N / std::hypot(1, friction);
    const bool sensed = std::isfinite(measured_N);
    const double normal_N = sensed ? measured_N : fitted_N;
    if (!(normal_N > 0) || std::isnan(arc_mm)) continue;
    Eigen::VectorXd weights(gauges);
    bool all = true;
    for (Eigen::Index j = 0; j < gauges; ++j) {
      const Gauge& gauge = finger.gauges[j];
      all &= gauge.IsMeasured(frame.gauges_V[j]);
      weights[j] = gauge.Slope(gauge.Angle(frame.gauges_V[j])) /
                   frame.GaugeStd_V(static_cast<std::size_t>(j), gauge.noise_V);
    }
    if (!all) continue;
    const LinearizedFrame* const at =
        calibration.Linearize({{arc_mm, normal_N, friction}}, frame);
    if (at == nullptr) continue;
    // From std to angles.
    const auto std_rad = weights.cwiseInverse().asDiagonal();
    Eigen::Vector2d reference(0, sensed ? frame.ForceStd_N(plan) : 0);
    if (std::isfinite(frame.contact_mm)) {
      reference[0] = plan.contact_std_mm;
    } else if (frame.object_mm.allFinite()) {
      reference[0] = plan.object_std_mm;
    }
    const Eigen::MatrixXd by_reference =
        std_rad * at->by_contact * reference.asDiagonal();
    const Eigen::MatrixXd by_factor =
        std_rad * calibration.ByParameter() * factor;
    GaugeError error{arc_mm, normal_N, std_rad * at->residuals,
                     by_factor * by_factor.transpose() +
                         by_reference * by_reference.transpose()};
    error.expected.diagonal() += weights.cwiseInverse().cwiseAbs2();
    errors->push_back(std::move(error));
  }
}

std::vector<int> Spread(const std::vector<int>& frames, std::size_t most) {
  std::vector<int> spread;
  const std::size_t count = std::min(frames.size(), most);
  for (std::size_t k = 0; k < count; ++k) {
    spread.push_back(frames[k * frames.size() / count]);
  }
  return spread;
}

// Returns the covariance for frames that the model has not seen: if n errors of
// m gauges make an estimate A, the expected covariance is A n / (n - m - 1),
// the mean of the inverse Wishart distribution. At least half of the errors
// count, as few of them tell the factor no better.
GaugeDiscrepancy ForOtherFrames(GaugeDiscrepancy found, std::size_t errors) {
  const double each =
      static_cast<double>(errors) / static_cast<double>(found.places.size());
  for (GaugeDiscrepancy::Place& at : found.places) {
    const double gauges = static_cast<double>(at.covariance_rad2.rows());
    at.covariance_rad2 *= each / std::max(each - gauges - 1, each / 2);
  }
  return found;
}

// The model with the best criterion; nothing if that is better without one.
std::optional<GaugeDiscrepancy> BestFit(std::vector<GaugeError> errors) {
  std::stable_sort(
      errors.begin(), errors.end(),
      [](const auto& a, const auto& b) { return a.place_mm < b.place_mm; });
  if (errors.empty()) return {};
  const auto gauges = static_cast<double>(errors[0].error_rad.size());
  const auto values = gauges * static_cast<double>(errors.size());
  std::optional<GaugeDiscrepancy> best;
  double best_criterion = -2 * LogLikelihood(errors, nullptr);
  for (const int places : kPlaces) {
    const double numbers = 1 + places * gauges * (gauges + 1) / 2;
    if (values < kLeastErrors * numbers) break;
    // What depends on the place shows without it, too.
    if (places > kPlaces[0] && !best) break;
    std::array<Model, std::size(kLoads_N)> models;
    tbb::parallel_for(std::size_t{0}, models.size(), [&](std::size_t i) {
      models[i] = FitModel(errors, kLoads_N[i], places);
    });
    for (const Model& model : models) {
      const double criterion = -2 * model.log_likelihood + 2 * numbers;
      if (criterion >= best_criterion) continue;
      best_criterion = criterion;
      best = model.discrepancy;
    }
  }
  if (best) best = ForOtherFrames(std::move(*best), errors.size());
  return best;
}

}  // namespace

HeldOutErrors GaugeErrorsOf(const CalibrationProblem& problem,
                            const CalibrationSolution& solution,
                            const Identifiability& found,
                            const WideLinearization& wide) {
  HeldOutErrors errors;
  for (const std::vector<int>& frames : wide.frames) {
    if (frames.empty()) return errors;
  }
  const auto touches = [&](int i) {
    return !problem.frame(i).IsBench() && problem.frame(i).contact;
  };
  std::array<std::vector<GaugeError>, WideLinearization::kFolds> of_fold;
  std::atomic<bool> all_known = true;
  ForEachFold(problem, wide, [&](int fold, const LeftOut& left) {
    std::vector<int> frames;
    for (const int i : wide.frames[fold]) {
      if (touches(i)) frames.push_back(i);
    }
    frames = Spread(frames, kMostErrors / WideLinearization::kFolds);
    if (frames.empty()) return;
    const LeftOutFinger without(problem, found, left, frames);
    if (without.finger.calibration) {
      AddErrors(without.part.get(), without.finger, frames, solution.contacts,
                &of_fold[fold]);
    } else {
      all_known = false;
    }
  });
  if (!all_known) return {};
  for (std::vector<GaugeError>& of : of_fold) {
    std::move(of.begin(), of.end(), std::back_inserter(errors.fitted));
  }
  std::vector<int> rejected;
  for (const auto& [i, reason] : problem.rejected()) {
    if (touches(i)) rejected.push_back(i);
  }
  rejected = Spread(rejected, kMostErrors);
  if (rejected.empty()) return errors;
  const auto part = problem.Part(rejected, problem.threads());
  Finger finger = part->parameters().Apply(problem.finger());
  KeepCovariance(part->parameters(), found, &finger);
  ContactStore contacts(part.get());
  FitContacts(rejected, part.get(), &contacts,
              [](int, const LinearizedFrame&) {});
  AddErrors(part.get(), finger, rejected, contacts.all(), &errors.rejected);
  return errors;
}

std::optional<GaugeDiscrepancy> FitDiscrepancy(const HeldOutErrors& errors) {
  std::optional<GaugeDiscrepancy> found = BestFit(errors.fitted);
  if (!found) return found;
  std::vector<GaugeError> all = errors.fitted;
  for (const GaugeError& at : errors.rejected) {
    Eigen::MatrixXd wide =
        Eigen::MatrixXd::Zero(at.expected.rows(), at.expected.cols());
    found->AddTo(at.place_mm, at.force_N, &wide);
    wide = kWide * kWide * wide + at.expected;
    const Eigen::LLT<Eigen::MatrixXd> root(wide);
    const double chi2 = root.matrixL().solve(at.error_rad).squaredNorm();
    const auto gauges = static_cast<int>(at.error_rad.size());
    if (ChiSquaredTail(chi2, gauges) > kOutlier) all.push_back(at);
  }
  return all.size() > errors.fitted.size() ? BestFit(all) : found;
}

std::string WordsOf(const GaugeDiscrepancy& discrepancy) {
  constexpr double force_N = 5;  // as contacts usually have
  double largest = 0, place = 0;
  for (const GaugeDiscrepancy::Place& at : discrepancy.places) {
    const double variance = at.covariance_rad2.diagonal().maxCoeff();
    if (variance <= largest) continue;
    largest = variance;
    place = at.place_mm;
  }
  const double load = force_N / discrepancy.load_N;
  return FormatText(
      "gauges are off by up to %.2g mrad rms under %.2g N at %.0f "
      "mm",
      1e3 * std::sqrt(largest * (1 + load * load)), force_N, place);
}

}  // namespace finray
