#include "finray/estimation/contact_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "finray/estimation/chi_squared.h"
#include "finray/estimation/valley.h"
#include "finray/finger/geometry.h"

namespace finray {
namespace {

// The search tries other starts if the p-value of chi2 is below kWellExplained.
// Without degrees of freedom it does so if chi2 is at least kNearlyNothing.
constexpr double kWellExplained = 0.01, kNearlyNothing = 4;
// A fit may end at this fraction of the chi2 that the table predicts for a
// start.
constexpr double kTableFactor = 0.25;
constexpr std::size_t kMostStarts = 4, kMostPairStarts = 12;
// A doubted pair matters only if it explains the frame, which is unobservable
// either way. Nine of ten that do are found within a quarter of this
// (doubted_pairs_study).
constexpr int kDoubtedIterations = 64;
// Contacts that need more iterations from frame to frame have jumped.
constexpr int kContinueIterations = 8;
// Pairs whose chi2 is farther above the best one do not go on.
constexpr double kContinued = 2 * ContactSearch::kSuspect;
// The table cannot rank starts where its values are wrong by more std than
// this.
constexpr double kCoarse = 1;
// An upright finger bends alike wherever it is touched, and each bay between
// ribs may hold a minimum.
constexpr double kUpright_rad = 93 * kDegree;
constexpr std::size_t kCrowded = 13;

// Few frames that the model explains have a larger chi2.
double LikelyChi2(int dof) { return dof + 3 * std::sqrt(2.0 * dof); }

// The least chi2 of rows that do not matter beside a solution: starts there are
// not tried, no contact there is a rival, and no valley reaches them. The last
// part of an interval ends between a row that counts and one that may not, so
// it may depend on this.
double ProfiledChi2(double chi2, int dof) {
  // FrameEstimate::noise_scale, or more, as LikelyChi2 is below the chi2 from
  // which on that is more than 1.
  const double scale2 =
      chi2 > LikelyChi2(dof) ? std::max(1.0, chi2 / std::max(1, dof)) : 1;
  return std::max((chi2 + ContactSearch::kWithinNoise) / kTableFactor,
                  chi2 + scale2 * Valley::kMostChi2);
}

bool HasCloseMinima(const Finger& finger) {
  return finger.back_angle_rad < kUpright_rad || finger.ribs.size() >= kCrowded;
}

}  // namespace

const char* FrameMethodName(FrameMethod method) {
  constexpr const char* kNames[] = {"fast", "ceres reduced", "ceres weighted"};
  return kNames[static_cast<int>(method)];
}

ContactSearch::ContactSearch(const Finger& finger, const Scene& scene,
                             const Discretization& discretization,
                             FrameMethod method,
                             std::shared_ptr<const SearchTables> tables)
    : tables_(tables ? std::move(tables)
                     : std::make_shared<const SearchTables>(finger, scene,
                                                            discretization)),
      found_(finger, scene.force_max_N.value_or(table().heaviest_N())),
      before_(found_),
      fit_(finger, scene, discretization, &tables_->surface(), most_force_N()),
      budget_(scene.search_iteration_limit) {
  if (method != FrameMethod::kFast) {
    problem_.emplace(finger, scene, discretization,
                     method == FrameMethod::kCeresWeighted
                         ? EquilibriumForm::kWeighted
                         : EquilibriumForm::kReduced,
                     most_force_N());
  }
}

void ContactSearch::Prepare() {
  if (!problem_) tables_->surface().MakeAll();
  if (tables_->scene().MostContacts(tables_->finger().gauges.size()) == 2) {
    tables_->Pairs();
  }
}

void ContactSearch::Begin(const Measurements& row) {
  budget_.BeginFrame();
  course_ = Course::kSearched;
  fit_.set_row(row);
  std::swap(before_, found_);
  found_.Clear();
  if (!before_.empty() && before_.best().count < 2) before_.Clear();
}

void ContactSearch::Forget() {
  found_.Clear();
  pair_starts_.clear();
}

bool ContactSearch::IsDoubted(const PackedReadings& packed) const {
  return !tables_->scene().contacts &&
         tables_->scene().MostContacts(
             static_cast<std::size_t>(packed.gauges)) == 2 &&
         packed.all <= 2 * kFittedContacts;
}

bool ContactSearch::OnSurface() const {
  return !problem_ && friction() == table().friction();
}

bool ContactSearch::IsEnough(const PackedReadings& packed,
                             double least_force_N) const {
  return !found_.empty() && IsDoubted(packed) && IsExplained(best().chi2, 0) &&
         best().LesserForce_N() >= least_force_N;
}

bool ContactSearch::IsExplained(double chi2, int dof) {
  return dof < 1 ? chi2 < kNearlyNothing
                 : ChiSquaredTail(chi2, dof) > kWellExplained;
}

bool ContactSearch::Search(int contacts, const PackedReadings& packed,
                           double least_force_N) {
  found_.Clear();
  if (contacts == 2) {
    SearchPairs(packed, least_force_N);
  } else {
    SearchOne(packed);
  }
  return !found_.empty();
}

void ContactSearch::SearchOne(const PackedReadings& packed) {
  const int dof = packed.all - 2;
  // With as many readings as unknowns, every minimum has a chi2 of zero,
  // however far the table's nodes are from it. Then chi2 cannot tell which
  // minimum is right, and all starts are tried.
  const bool always_close = dof < 1 || HasCloseMinima(tables_->finger());
  bool close = always_close;
  budget_.BeginSearch();
  // Fits on the surface cost less than the profile of all rows. With a limit no
  // start is tried twice.
  double most_chi2 =
      OnSurface() && !close && packed.camera == 0 && !budget_.limits_frames()
          ? ProfiledChi2(LikelyChi2(dof), dof)
          : GaugeTable::kAnyChi2;
  for (;;) {
    FindStarts(packed, most_chi2);
    close = always_close || (!starts_.empty() && starts_[0].chi2 < most_chi2 &&
                             starts_[0].error > kCoarse);
    double needed = GaugeTable::kAnyChi2;
    if (!close || most_chi2 == GaugeTable::kAnyChi2) {
      found_.Clear();
      needed = TryStarts(packed, most_chi2);
    }
    if (!(needed > most_chi2)) break;
    most_chi2 = needed;
  }
  // A camera's points are not in the table.
  if (found_.empty() || problem_ || packed.camera > 0) return;
  SearchRows(close);
  if (close) {
    SearchBeside();
    SearchForces(packed);
  }
}

double ContactSearch::TryStarts(const PackedReadings& packed,
                                double most_chi2) {
  const int dof = packed.all - 2;
  for (const ContactStart& start : starts_) {
    // The profile must reach farther, unless a start yet to come lowers chi2.
    if (!found_.empty() &&
        ProfiledChi2(std::min(found_.least_chi2(), kTableFactor * start.chi2),
                     dof) > most_chi2) {
      break;
    }
    // This start can neither win nor be a rival, and those behind it are worse.
    if (dof > 0 && !Matters(start, kWithinNoise)) break;
    // Wherever it is, a contact without force is the free finger.
    if (!found_.empty() && start.contacts[0].normal_N == 0) continue;
    if (!budget_.MayGoOn()) break;
    TryFit(start);
  }
  return ProfiledChi2(found_.least_chi2(), dof);
}

void ContactSearch::SearchPairs(const PackedReadings& packed,
                                double least_force_N) {
  const bool doubted = IsDoubted(packed);
  budget_.BeginSearch(doubted ? kDoubtedIterations
                              : IterationBudget::kUnlimited);
  profile_.clear();
  const bool continued = Continue(least_force_N);
  const std::ptrdiff_t known = found_.end() - found_.begin();
  if (continued) {
    if (!IsEnough(packed, least_force_N)) TryNextPair(packed);
  } else {
    FindPairStarts(packed);
    for (const ContactStart& start : pair_starts_) {
      if (!Matters(start, kSuspect) || !budget_.MayGoOn()) break;
      TryFit(start);
      if (IsEnough(packed, least_force_N)) break;
    }
    pair_starts_.clear();
  }
  if (!found_.empty() && !doubted) ProfileBest();
  if (!continued) return;
  const bool surprised = std::any_of(
      found_.begin() + known, found_.end(), [&](const ContactSolution& other) {
        return &other == &best() || found_.IsRival(other, kSuspect);
      });
  course_ = surprised ? Course::kSurprised : Course::kContinued;
}

bool ContactSearch::Continue(double least_force_N) {
  // A contact on a bound, or one that carries nothing, may be anywhere else.
  const auto is_sure = [&](const FoundSolutions& found) {
    return !found.empty() && !found.BestOnBound() &&
           found.best().LesserForce_N() >= least_force_N;
  };
  if (problem_ || !is_sure(before_)) return false;
  const auto fits = [&](const ContactSolution& pair) {
    ContactStart start;
    start.count = 2;
    start.contacts = pair.contacts;
    start.state = &pair.state;
    if (!budget_.MayGoOn() ||
        !FitEquilibria(start, std::min(budget_.left(), kContinueIterations))) {
      return false;
    }
    found_.Keep();
    return true;
  };
  if (!fits(before_.best())) return false;
  for (const ContactSolution& pair : before_) {
    if (&pair == &before_.best() ||
        pair.chi2 > before_.least_chi2() + kContinued) {
      continue;
    }
    fits(pair);
  }
  if (is_sure(found_) &&
      found_.least_chi2() < before_.least_chi2() + kSuspect) {
    return true;
  }
  found_.Clear();
  return false;
}

void ContactSearch::TryNextPair(const PackedReadings& packed) {
  if (pair_starts_.empty()) {
    FindPairStarts(packed);
    ContactStart none;
    none.chi2 = std::numeric_limits<double>::infinity();
    pair_starts_.resize(kMostPairStarts, none);
  }
  const ContactStart start = pair_starts_.back();
  pair_starts_.pop_back();
  if (Matters(start, kSuspect) && budget_.MayGoOn()) TryFit(start);
}

bool ContactSearch::Matters(const ContactStart& start, double within) const {
  return kTableFactor * start.chi2 < found_.least_chi2() + within;
}

void ContactSearch::TryFit(const ContactStart& start) {
  if (!found_.full() && Fit(start)) found_.Keep();
}

double ContactSearch::FreeChi2(const Measurements& row) {
  return problem_ ? problem_->FreeChi2(row) : fit_.FreeChi2(row);
}

void ContactSearch::FindStarts(const PackedReadings& packed, double most_chi2) {
  if (!packed.weights.isZero(0)) {
    table().Profile(packed.values, packed.weights, most_chi2, &profile_);
    GaugeTable::FindStarts(profile_, &starts_);
    if (starts_.size() > kMostStarts) starts_.resize(kMostStarts);
    return;
  }
  // With camera measurements only, starts are spread over the finger.
  profile_.clear();
  starts_.clear();
  const auto& rows = table().rows();
  for (std::size_t k = 0; k < kMostStarts; ++k) {
    const GaugeTable::Row& row =
        rows[(2 * k + 1) * rows.size() / (2 * kMostStarts)];
    const GaugeTable::Node& node = row.nodes[row.nodes.size() / 2];
    ContactStart start;
    start.count = 1;
    start.contacts[0] = {row.arc_mm, node.normal_N, table().friction()};
    start.state = &node.state;
    starts_.push_back(start);
  }
}

void ContactSearch::FindPairStarts(const PackedReadings& packed) {
  const PairTable& pairs = tables_->Pairs();
  if (!packed.weights.isZero(0)) {
    pairs.FindStarts(packed.values, packed.weights, kMostPairStarts,
                     &pair_starts_);
    return;
  }
  constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  pairs.FindStarts(packed.values, packed.weights, kAll, &pair_starts_);
  const std::size_t all = pair_starts_.size();
  if (all <= kMostPairStarts) return;
  for (std::size_t k = 0; k < kMostPairStarts; ++k) {
    pair_starts_[k] = pair_starts_[(2 * k + 1) * all / (2 * kMostPairStarts)];
  }
  pair_starts_.resize(kMostPairStarts);
}

bool ContactSearch::Fit(const ContactStart& start) {
  if (problem_) {
    if (budget_.limits_frames()) {
      problem_->set_most_iterations(budget_.left_of_frame());
    }
    const bool converged = problem_->Fit(start, fit_.row(), &found_.next());
    budget_.Spend(problem_->iterations(), converged);
    return converged;
  }
  const auto left = [this] {
    return std::min(budget_.left(), RowFit::kMostEvaluations);
  };
  if (start.count > 1 || !OnSurface() ||
      !fit_.Fit(start, RowFit::Model::kSurface, RowFit::kMostEvaluations,
                &found_.next())) {
    return FitEquilibria(start, left());
  }
  budget_.Spend(1, true);
  const ContactSolution& solution = found_.next();
  if (solution.chi2 > kNoiseless || left() < 1) return true;
  ContactStart here = start;
  here.contacts[0] = solution.contacts[0];
  here.state =
      &table().StateNear(here.contacts[0].arc_mm, here.contacts[0].normal_N);
  // The solution of the surface stays if this does not converge.
  FitEquilibria(here, left(), true);
  return true;
}

bool ContactSearch::FitEquilibria(const ContactStart& start,
                                  int most_iterations, bool known) {
  const bool converged = fit_.Fit(
      start, known ? RowFit::Model::kRounding : RowFit::Model::kEquilibria,
      most_iterations, &found_.next());
  budget_.Spend(fit_.evaluations(), known || converged);
  return converged;
}

void ContactSearch::ProfileBest() {
  const ContactSolution* profiled = nullptr;
  while (profiled != &best()) {
    if (!budget_.MayGoOn()) return;
    profiled = &best();
    pair_profile_.Profile(best(), budget_.left_of_frame(), &fit_, &profile_);
    budget_.Spend(pair_profile_.iterations(), !pair_profile_.ended());
    for (int i = 0; i < pair_profile_.count(); ++i) {
      if (!budget_.MayGoOn()) return;
      TryFit(pair_profile_.minimum(i));
    }
  }
}

}  // namespace finray
