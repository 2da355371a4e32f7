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
constexpr int kFollowIterations = 8;
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

// Fits of one pair end within this of each other, in chi2.
constexpr double kSamePair = 0.01;
// Searches for two contacts profile their solution so often, as a profile may
// lead to a better one.
constexpr int kMostProfiles = 3;

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
    : scene_(scene),
      friction_(scene.friction_coefficient),
      length_mm_(finger.front_length_mm),
      solver_(finger, discretization),
      tables_(tables ? std::move(tables)
                     : std::make_shared<const SearchTables>(
                           scene, discretization, &solver_)),
      table_(tables_->table()),
      most_force_N_(scene.force_max_N.value_or(table_.heaviest_N())),
      found_(length_mm_, most_force_N_, finger.ribs.size()),
      method_(method),
      fit_(finger, scene, discretization, &tables_->surface(), most_force_N_) {
  if (method != FrameMethod::kFast) {
    problem_.emplace(finger, scene, discretization,
                     method == FrameMethod::kCeresWeighted
                         ? EquilibriumForm::kWeighted
                         : EquilibriumForm::kReduced,
                     most_force_N_);
  }
}

void ContactSearch::Prepare() {
  if (method_ == FrameMethod::kFast) tables_->surface().MakeAll();
  if (scene_.MostContacts(solver_.model().finger().gauges.size()) == 2) {
    tables_->Pairs(&solver_);
  }
}

bool ContactSearch::IsDoubted(const PackedReadings& packed) const {
  return !scene_.contacts &&
         scene_.MostContacts(static_cast<std::size_t>(packed.gauges)) == 2 &&
         packed.all <= 2 * kFittedContacts;
}

void ContactSearch::Spend(int iterations, bool converged) {
  iterations_ += iterations;
  spent_ += iterations;
  const auto& limit = scene_.search_iteration_limit;
  ended_ |= limit && spent_ >= *limit && !converged;
}

int ContactSearch::LeftOfLimit() const {
  const auto& limit = scene_.search_iteration_limit;
  return limit ? *limit - spent_ : std::numeric_limits<int>::max();
}

int ContactSearch::Left() const {
  return std::min({LeftOfLimit(), RowFit::kMostEvaluations,
                   most_iterations_ - iterations_});
}

bool ContactSearch::MayGoOn() {
  if (iterations_ >= most_iterations_) return false;
  if (!scene_.search_iteration_limit) return true;
  const int left = LeftOfLimit();
  ended_ |= left < 1;
  if (problem_) problem_->set_most_iterations(left);
  return left > 0;
}

bool ContactSearch::IsEnough(const PackedReadings& packed,
                             double least_force_N) const {
  return !found_.empty() && best().count == 2 && IsDoubted(packed) &&
         IsExplained(best().chi2, 0) &&
         std::min(best().contacts[0].normal_N, best().contacts[1].normal_N) >=
             least_force_N;
}

bool ContactSearch::IsExplained(double chi2, int dof) {
  return dof < 1 ? chi2 < kNearlyNothing
                 : ChiSquaredTail(chi2, dof) > kWellExplained;
}

bool ContactSearch::Search(int contacts, const PackedReadings& packed,
                           double least_force_N) {
  const int dof = packed.all - 2 * contacts;
  // The surface's contacts have the scene's friction.
  on_surface_ = method_ == FrameMethod::kFast && contacts == 1 &&
                friction_ == scene_.friction_coefficient;
  // With as many readings as unknowns, every minimum has a chi2 of zero,
  // however far the table's nodes are from it. Then chi2 cannot tell which
  // minimum is right, and all starts are tried.
  exact_fit_ = contacts == 1 && dof < 1;
  const bool always_close =
      exact_fit_ || HasCloseMinima(solver_.model().finger());
  bool close = always_close;
  iterations_ = 0;
  const bool doubted = contacts == 2 && IsDoubted(packed);
  most_iterations_ =
      doubted ? kDoubtedIterations : std::numeric_limits<int>::max();
  // Fits on the surface cost less than the profile of all rows. With a limit no
  // start is tried twice.
  double most_chi2 = on_surface_ && !close && packed.camera == 0 &&
                             !scene_.search_iteration_limit
                         ? ProfiledChi2(LikelyChi2(dof), dof)
                         : GaugeTable::kAnyChi2;
  for (;;) {
    FindStarts(contacts, packed, most_chi2);
    close = always_close ||
            (contacts == 1 && !starts_.empty() && starts_[0].chi2 < most_chi2 &&
             starts_[0].error > kCoarse);
    double needed = GaugeTable::kAnyChi2;
    if (!close || most_chi2 == GaugeTable::kAnyChi2) {
      found_.Clear();
      needed = TryStarts(contacts, packed, most_chi2, least_force_N);
    }
    if (!(needed > most_chi2)) break;
    most_chi2 = needed;
  }
  if (contacts == 2 && !found_.empty() && packed.camera == 0 && !doubted) {
    ProfileBest(packed);
  }
  suspect_ = contacts == 2 && found_.rival(kSuspect) != nullptr;
  // A camera's points are not in the table.
  if (contacts == 1 && !found_.empty() && method_ == FrameMethod::kFast &&
      packed.camera == 0) {
    SearchRows(close);
    if (close) {
      SearchBeside();
      SearchForces(packed);
    }
  }
  return !found_.empty();
}

double ContactSearch::TryStarts(int contacts, const PackedReadings& packed,
                                double most_chi2, double least_force_N) {
  const int dof = packed.all - 2 * contacts;
  // A rival may be hidden by noise, and two contacts are followed from here.
  const double within = contacts == 2 ? kSuspect : kWithinNoise;
  for (const ContactStart& start : contacts == 2 ? pair_starts_ : starts_) {
    // The profile must reach farther, unless a start yet to come lowers chi2.
    if (!found_.empty() &&
        ProfiledChi2(std::min(found_.least_chi2(), kTableFactor * start.chi2),
                     dof) > most_chi2) {
      break;
    }
    // This start can neither win nor be a rival, and those behind it are worse.
    if (!exact_fit_ &&
        kTableFactor * start.chi2 >= found_.least_chi2() + within) {
      break;
    }
    // Wherever it is, a contact without force is the free finger.
    if (contacts == 1 && !found_.empty() && start.contacts[0].normal_N == 0) {
      continue;
    }
    if (!MayGoOn()) break;
    if (problem_) {
      if (FitByCeres(start)) found_.Keep();
      continue;
    }
    if (Fit(start)) {
      const ContactSolution& next = found_.next();
      if (!on_surface_ || !found_.Knows(next.contacts[0], next.chi2)) {
        found_.Keep();
      }
    }
    if (IsEnough(packed, least_force_N)) break;
  }
  return ProfiledChi2(found_.least_chi2(), dof);
}

double ContactSearch::FreeChi2(const Measurements& row) {
  return problem_ ? problem_->FreeChi2(row) : fit_.FreeChi2(row);
}

void ContactSearch::FindStarts(int contacts, const PackedReadings& packed,
                               double most_chi2) {
  // A frame with camera measurements only has its starts spread over the
  // finger.
  const bool spread = packed.weights.isZero(0);
  if (contacts == 1 && spread) {
    profile_.clear();
    starts_.clear();
    const auto& rows = table_.rows();
    for (std::size_t k = 0; k < kMostStarts; ++k) {
      const GaugeTable::Row& row =
          rows[(2 * k + 1) * rows.size() / (2 * kMostStarts)];
      const GaugeTable::Node& node = row.nodes[row.nodes.size() / 2];
      ContactStart start;
      start.count = 1;
      start.contacts[0] = {row.arc_mm, node.normal_N,
                           scene_.friction_coefficient};
      start.state = &node.state;
      starts_.push_back(start);
    }
    return;
  }
  if (contacts == 1) {
    table_.Profile(packed.values, packed.weights, most_chi2, &profile_);
    GaugeTable::FindStarts(profile_, &starts_);
    if (starts_.size() > kMostStarts) starts_.resize(kMostStarts);
    return;
  }
  profile_.clear();
  const PairTable& pairs = tables_->Pairs(&solver_);
  if (!spread) {
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
  if (!on_surface_ || !fit_.Fit(start, RowFit::Model::kSurface,
                                RowFit::kMostEvaluations, &found_.next())) {
    return FitEquilibria(start, Left());
  }
  Spend(1, true);
  const ContactSolution& solution = found_.next();
  const int left = Left();
  if (solution.chi2 > kNoiseless || left < 1) return true;
  ContactStart here = start;
  here.contacts[0] = solution.contacts[0];
  here.state =
      &table_.StateNear(here.contacts[0].arc_mm, here.contacts[0].normal_N);
  // The solution of the surface stays if this does not converge.
  FitEquilibria(here, left, true);
  return true;
}

bool ContactSearch::FitEquilibria(const ContactStart& start, int most,
                                  bool known) {
  const bool converged = fit_.Fit(
      start, known ? RowFit::Model::kRounding : RowFit::Model::kEquilibria,
      most, &found_.next());
  Spend(fit_.evaluations(), known || converged);
  return converged;
}

bool ContactSearch::BeginFollowing() {
  if (method_ != FrameMethod::kFast || suspect_) return false;
  followed_.count = 2;
  followed_.contacts = best().contacts;
  followed_.state = &followed_state_;
  followed_state_ = best().state;
  searched_chi2_ = best().chi2;
  turn_ = 0;
  return true;
}

bool ContactSearch::Follow(const PackedReadings& packed) {
  found_.Clear();
  profile_.clear();
  iterations_ = 0;
  most_iterations_ = std::numeric_limits<int>::max();
  on_surface_ = false;
  if (!MayGoOn()) return false;
  if (!FitEquilibria(followed_, std::min(Left(), kFollowIterations)) ||
      found_.next().chi2 > searched_chi2_ + kSuspect) {
    return false;
  }
  followed_.contacts = found_.next().contacts;
  followed_state_ = found_.next().state;
  found_.Keep();
  if (turn_ == kMostPairStarts) {
    FindStarts(2, packed);
    turn_ = 0;
  }
  if (turn_ < pair_starts_.size() && MayGoOn() &&
      kTableFactor * pair_starts_[turn_].chi2 < best().chi2 + kSuspect &&
      FitEquilibria(pair_starts_[turn_], Left())) {
    found_.Keep();
  }
  ++turn_;
  if (packed.camera == 0 && !IsDoubted(packed)) {
    ProfileBest(packed);
  }
  suspect_ = found_.rival(kSuspect) != nullptr;
  return !suspect_ && found_.first().chi2 < best().chi2 + kWithinNoise;
}

void ContactSearch::ProfileBest(const PackedReadings& packed) {
  for (int round = 0; round < kMostProfiles && MayGoOn(); ++round) {
    ProfilePair(best(), packed, friction_, most_force_N_, LeftOfLimit(),
                &solver_, &pair_profile_, &profile_);
    Spend(pair_profile_.iterations, !pair_profile_.ended);
    const double before = found_.least_chi2();
    for (int i = 0; i < pair_profile_.count && !found_.full(); ++i) {
      if (!MayGoOn()) return;
      const ContactStart& start = pair_profile_.minima[i];
      if (problem_ ? FitByCeres(start) : FitEquilibria(start, Left())) {
        found_.Keep();
      }
    }
    if (!(found_.least_chi2() < before - kSamePair)) return;
  }
}

bool ContactSearch::FitByCeres(const ContactStart& start) {
  const bool converged = problem_->Fit(start, *row_, &found_.next());
  Spend(problem_->iterations(), converged);
  return converged;
}

}  // namespace finray
