#include "finray/estimation/pair_profile.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "finray/estimation/valley.h"
#include "finray/finger/finger.h"

namespace finray {
namespace {

constexpr int kPairUnknowns = 2 * kFittedContacts;
using PairVector = Eigen::Matrix<double, kPairUnknowns, 1>;
using PairMatrix = Eigen::Matrix<double, kPairUnknowns, kPairUnknowns>;

// Lengths, in l_0.
constexpr double kProfileStep = 0.025;
constexpr double kClamp = 0.02;      // no contact is nearer to the base
constexpr double kApart = 0.02;      // nor are contacts to each other
constexpr double kTipBay = 0.012;    // past the last rib begins so far inside
constexpr double kBaseBay = 0.1;     // near the base ends so far past the first
constexpr double kBehindRib = 0.06;  // a profile of an end begins so far inside
constexpr double kUnsure = 0.008;    // std of a contact that is profiled
constexpr double kProfiledBay = 0.12;
// A place is as good as fitted when its next change would lower chi2 by less.
constexpr double kPlaceFitted = 0.1;
constexpr int kMostRefits = 4;
// The first guess at a place changes forces by this factor at most.
constexpr double kMostFactor = 3, kNoForce_N = 1e-9;
// A minimum is suspected to have another one beside it where chi2 rises by less
// than this share of what its curvature expects, farther away than kBeside
// expects and by less than kBesideChi2: it may fall between two places.
constexpr double kBetterBeside = 0.6, kBeside = 9, kBesideChi2 = 200;
// A profile ends where it is this far above the minimum.
constexpr double kSteep = 1e3;

struct ProfiledRange {
  double low_mm, high_mm;
};

// Where a contact is profiled. Empty at its place.
ProfiledRange ProfiledPart(const Finger& finger,
                           const ContactSolution& solution, int contact,
                           double std_mm) {
  const double length = finger.front_length_mm;
  const double arc = solution.contacts[contact].arc_mm;
  const double other = solution.contacts[1 - contact].arc_mm;
  double first = length, last = 0;
  for (const Rib& rib : finger.ribs) {
    first = std::min(first, rib.front_mm);
    last = std::max(last, rib.front_mm);
  }
  ProfiledRange part{arc, arc};
  const auto widen = [&part](double low_mm, double high_mm) {
    part.low_mm = std::min(part.low_mm, low_mm);
    part.high_mm = std::max(part.high_mm, high_mm);
  };
  if (arc > last - kTipBay * length) widen(last - kBehindRib * length, length);
  if (arc < first + kBaseBay * length) widen(0, first + kProfiledBay * length);
  if (std_mm > kUnsure * length) {
    const double reach =
        kProfiledBay * length + kTwoContactsRule.farthest * std_mm;
    widen(arc - reach, arc + reach);
  }
  part.low_mm = std::max(part.low_mm, kClamp * length);
  part.high_mm = std::min(part.high_mm, length);
  if (contact == 1)
    part.low_mm = std::max(part.low_mm, other + kApart * length);
  if (contact == 0) {
    part.high_mm = std::min(part.high_mm, other - kApart * length);
  }
  return part;
}

}  // namespace

// Walks with one contact held, from place to place.
class PairProfile::Walk {
 public:
  Walk(const ContactSolution& solution, int most_iterations, RowFit* fit,
       PairProfile* profile)
      : solution_(solution),
        most_iterations_(most_iterations),
        fit_(*fit),
        profile_(*profile),
        length_mm_(fit->finger().front_length_mm) {}

  void Go(int contact, double end_mm, double variance_mm2,
          std::vector<ContactStart>* places) {
    const double begin = solution_.contacts[contact].arc_mm;
    const double way = end_mm - begin;
    if (std::abs(way) < 1e-6 * length_mm_) return;
    const int steps = static_cast<int>(
        std::ceil(std::abs(way) / (kProfileStep * length_mm_)));
    ContactStart place;
    place.count = 2;
    place.contacts = solution_.contacts;
    place.state = &solution_.state;
    information_ = solution_.information;
    double before = solution_.chi2;
    bool falling = false;
    for (int i = 1; i <= steps; ++i) {
      const ContactStart last = place;
      if (!Refit(contact, begin + way * i / steps, &place)) break;
      places->push_back(place);
      places->back().state = nullptr;
      const bool falls = place.chi2 < before;
      if (falling && !falls) Add(last, lowest_);
      const double apart_mm = place.contacts[contact].arc_mm - begin;
      const double more = place.chi2 - solution_.chi2;
      const double expected = apart_mm * apart_mm / variance_mm2;
      const bool flat = !falls && more < kBetterBeside * expected &&
                        expected > kBeside &&
                        more < kBesideChi2 + solution_.chi2;
      if (falls || flat) lowest_ = state_;
      if (flat || (falls && i == steps)) Add(place, lowest_);
      falling = falls;
      before = place.chi2;
      if (place.chi2 > solution_.chi2 + kSteep * (1 + solution_.chi2)) break;
    }
  }

 private:
  void Add(const ContactStart& start, const LadderState& state) {
    if (profile_.count_ == kMostMinima) return;
    ContactStart& added = profile_.minima_[profile_.count_];
    LadderState& its = profile_.states_[profile_.count_];
    added = start;
    its = state;
    added.state = &its;
    ++profile_.count_;
  }

  // Where the others go from a place where they are fitted when the held one
  // moves, to first order.
  PairVector Change(const ContactStart& place, int held, double moved) const {
    PairMatrix system = information_;
    PairVector right = -information_.col(held) * moved;
    for (int k = 0; k < kPairUnknowns; ++k) {
      // Keeps what the gauges do not determine where it is.
      const double size =
          k % 2 == 0 ? 0.2 * length_mm_
                     : std::max(kNoForce_N, 2 * place.contacts[k / 2].normal_N);
      system(k, k) += 1 / (size * size);
    }
    system.row(held).setZero();
    system.col(held).setZero();
    system(held, held) = 1;
    right[held] = moved;
    return system.ldlt().solve(right);
  }

  // Goes to a place and fits the others there.
  bool Refit(int contact, double to_mm, ContactStart* place) {
    profile_.ended_ |= profile_.iterations_ >= most_iterations_;
    if (profile_.ended_) return false;
    const int held = 2 * contact, other = 2 - held;
    const double apart = kApart * length_mm_;
    ContactBounds bounds = fit_.Bounds(kFittedContacts);
    bounds.low[other] = contact == 0 ? to_mm + apart : kClamp / 2 * length_mm_;
    if (contact == 1) bounds.high[other] = to_mm - apart;
    bounds.low[other] = std::min(bounds.low[other], bounds.high[other]);
    const PairVector change =
        Change(*place, held, to_mm - place->contacts[contact].arc_mm);
    if (!change.allFinite()) return false;
    for (int c = 0; c < kFittedContacts; ++c) {
      PointContact& at = place->contacts[c];
      at.arc_mm = std::clamp(at.arc_mm + change[2 * c], bounds.low[2 * c],
                             bounds.high[2 * c]);
      at.normal_N = std::min(
          std::clamp(at.normal_N + change[2 * c + 1], at.normal_N / kMostFactor,
                     at.normal_N * kMostFactor),
          bounds.high[2 * c + 1]);
    }
    place->contacts[contact].arc_mm = bounds.low[held] = bounds.high[held] =
        to_mm;
    const int most =
        std::min(kMostRefits, most_iterations_ - profile_.iterations_);
    const bool fitted = fit_.FitWithin(bounds, kPlaceFitted, most, place);
    profile_.iterations_ += fit_.evaluations();
    profile_.ended_ |= most < kMostRefits && !fit_.converged();
    if (!fitted || profile_.ended_) return false;
    information_ = fit_.information();
    state_ = fit_.state();
    place->state = &state_;
    return true;
  }

  const ContactSolution& solution_;
  int most_iterations_;
  RowFit& fit_;
  PairProfile& profile_;
  double length_mm_;
  // At the last place, and at the lowest one.
  ContactMatrix information_;
  LadderState state_, lowest_;
};

void PairProfile::Profile(const ContactSolution& solution, int most_iterations,
                          RowFit* fit, std::vector<ContactStart>* places) {
  places->clear();
  count_ = iterations_ = 0;
  ended_ = false;
  const ContactMatrix covariance = CovarianceOf(solution.information);
  if (!std::isfinite(covariance(0, 0))) return;
  Walk walk(solution, most_iterations, fit, this);
  for (int c = 0; c < kFittedContacts; ++c) {
    const ProfiledRange part = ProfiledPart(
        fit->finger(), solution, c, std::sqrt(covariance(2 * c, 2 * c)));
    for (const double end_mm : {part.high_mm, part.low_mm}) {
      walk.Go(c, end_mm, covariance(2 * c, 2 * c), places);
    }
  }
}

}  // namespace finray
