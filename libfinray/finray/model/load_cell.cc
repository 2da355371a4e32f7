#include "finray/model/load_cell.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace finray {
namespace {

// A cell starts with as many terms as do for this resolution, that of an
// estimate with gauges of usual noise. Light loads need fewer.
constexpr double kUsualResolution = 1e-10;
constexpr int kForceTerms = 11, kLightForceTerms = 9;
constexpr double kForceFall = 10;  // from term to term
// Along an element of usual length the terms fall by this factor each, to this
// share.
constexpr double kUsualLength = 0.16;  // of l_0
constexpr double kArcFall = 8, kArcShare = 3e-13;
constexpr int kMostArcTerms = PolynomialBasis::kMostTerms, kMostForceTerms = 12;
// Half a cell needs fewer terms along the side that was halved, but enough to
// see them fall.
constexpr int kFewer = 3, kLeastTerms = 7;
// A cell of the domain is halved at most so often.
constexpr int kMostHalvings = 4;
// The series goes on behind its last terms.
constexpr double kTail = 2;
// Either direction may leave out this share of the resolution.
constexpr double kShare = 0.5;
// Terms below this share of the resolution are left out. Some dozen of them are
// left out together.
constexpr double kRounding = 0.03;
// The unit of values that are 0 in all of a cell.
constexpr double kTiny = std::numeric_limits<double>::min();

// The terms along a length in l_0 where the resolution is `coarse` times the
// usual one. Half the length doubles the factor.
int ArcTerms(double length, double coarse) {
  const double fall = std::max(2.0, kArcFall * kUsualLength / length);
  const double terms =
      std::ceil(-std::log(kArcShare * coarse) / std::log(fall));
  return std::clamp(static_cast<int>(terms), kLeastTerms, kMostArcTerms);
}

int ForceTerms(int usual, double coarse) {
  const double fewer = std::log(coarse) / std::log(kForceFall);
  return std::clamp(usual - static_cast<int>(std::lround(fewer)), kLeastTerms,
                    usual);
}

// The largest coefficients of some values for each term, [arc term, force
// term], in units of each value.
Eigen::ArrayXXd TermSizes(const ChebyshevRows& c, int first,
                          const Eigen::VectorXd& units, int arc_terms,
                          int force_terms) {
  Eigen::ArrayXXd sizes(arc_terms, force_terms);
  for (int i = 0; i < arc_terms; ++i) {
    for (int j = 0; j < force_terms; ++j) {
      const auto row = c.row(i * force_terms + j).segment(first, units.size());
      sizes(i, j) = (row.array().abs() / units.transpose().array()).maxCoeff();
    }
  }
  return sizes;
}

// How large the terms of one direction are, and how they fall.
struct TermFall {
  int terms;
  double error;  // what the series leaves out
  double fall;   // from term to term

  explicit TermFall(const Eigen::ArrayXd& sizes)
      : terms(static_cast<int>(sizes.size())) {
    // Every second term may be small by symmetry.
    const double last = sizes.tail<2>().maxCoeff();
    error = kTail * last;
    constexpr int kBefore = 4;
    fall = std::pow(sizes.segment<2>(terms - 2 - kBefore).maxCoeff() / last,
                    1.0 / kBefore);
  }
  // The number of terms that leave out little enough. It is large where terms
  // do not fall.
  int Needed() const {
    if (error <= kShare) return terms;
    const double more = std::log(error / kShare) / std::log(fall);
    constexpr int kLarge = 2 * PolynomialBasis::kMostTerms;
    return fall > 1 && more < kLarge ? terms + static_cast<int>(std::ceil(more))
                                     : kLarge;
  }
};

}  // namespace

LoadCell::LoadCell(const Interval& arc_mm, const Interval& normal_N,
                   double length_mm, bool light, const LoadValues& values)
    : arc_mm_(arc_mm), normal_N_(normal_N) {
  const double coarse =
      values.resolution.size() > 0
          ? std::max(1.0, values.resolution.minCoeff() / kUsualResolution)
          : 1;
  arc_terms_ = ArcTerms((arc_mm.to - arc_mm.from) / length_mm, coarse);
  force_terms_ = ForceTerms(light ? kLightForceTerms : kForceTerms, coarse);
}

LoadCell::LoadCell(const LoadCell& whole, bool by_arc, bool upper)
    : arc_mm_(whole.arc_mm_),
      normal_N_(whole.normal_N_),
      arc_terms_(whole.arc_terms_),
      force_terms_(whole.force_terms_),
      halvings_(whole.halvings_ + 1) {
  int& terms = by_arc ? arc_terms_ : force_terms_;
  terms = std::max(kLeastTerms, terms - kFewer);
  Interval& side = by_arc ? arc_mm_ : normal_N_;
  (upper ? side.from : side.to) = side.middle();
}

void LoadCell::Halve(bool by_arc) {
  halved_by_arc_ = by_arc;
  for (const bool upper : {false, true}) {
    halves_[upper].reset(new LoadCell(*this, by_arc, upper));
  }
}

const LoadCell* LoadCell::PartAt(double arc_mm, double normal_N,
                                 const LoadValues& values) {
  LoadCell* cell = this;
  for (;;) {
    cell->Need(values);
    if (!cell->halves_[0]) return cell;
    const bool upper = cell->halved_by_arc_
                           ? arc_mm > cell->arc_mm_.middle()
                           : normal_N > cell->normal_N_.middle();
    cell = cell->halves_[upper].get();
  }
}

void LoadCell::MakeWhole(const LoadValues& values) {
  Need(values);
  for (const auto& half : halves_) {
    if (half) half->MakeWhole(values);
  }
}

void LoadCell::Need(const LoadValues& values) {
  std::call_once(made_, [&] {
    while (!Make(values)) {
    }
  });
}

bool LoadCell::Make(const LoadValues& values) {
  groups_.clear();  // an exception may have ended another try
  const int arc_terms = arc_terms_, force_terms = force_terms_;
  const bool may_halve = halvings_ < kMostHalvings;
  ChebyshevRows samples(
      arc_terms * force_terms,
      std::accumulate(values.sizes.begin(), values.sizes.end(), 0));
  bool lightest = false;
  if (!Sample(values.make_sampler(), &samples, &lightest)) {
    // The part of lighter loads may have equilibria.
    if (may_halve && !lightest) Halve(false);
    return true;
  }
  const ChebyshevRows c =
      ChebyshevCoefficients(samples, arc_terms, force_terms);
  const Eigen::ArrayXXd sizes =
      TermSizes(c, 0, values.resolution, arc_terms, force_terms);
  const TermFall arc(sizes.rowwise().maxCoeff());
  const TermFall force(sizes.colwise().maxCoeff().transpose());
  error_ = arc.error + force.error;
  if (error_ > 1) {
    const int arcs = arc.Needed(), forces = force.Needed();
    const bool enough = arcs <= kMostArcTerms && forces <= kMostForceTerms;
    if (enough || !may_halve) {
      arc_terms_ = std::min(arcs, kMostArcTerms);
      force_terms_ = std::min(forces, kMostForceTerms);
      if (arc_terms_ != arc_terms || force_terms_ != force_terms) return false;
    } else {
      Halve(arcs > kMostArcTerms &&
            (forces <= kMostForceTerms || arc.error > force.error));
      return true;
    }
  }
  Keep(c, 0, values.sizes[0], sizes, kRounding);
  int first = values.sizes[0];
  for (std::size_t g = 1; g < values.sizes.size(); ++g) {
    const int size = values.sizes[g];
    const Eigen::VectorXd largest = c.middleCols(first, size)
                                        .cwiseAbs()
                                        .colwise()
                                        .maxCoeff()
                                        .cwiseMax(kTiny)
                                        .transpose();
    Keep(c, first, size, TermSizes(c, first, largest, arc_terms, force_terms),
         values.negligible);
    first += size;
  }
  return true;
}

bool LoadCell::Sample(const LoadSampler& sample, ChebyshevRows* samples,
                      bool* lightest) const {
  for (int i = 0; i < arc_terms_; ++i) {
    for (int k = 0; k < force_terms_; ++k) {
      // To and fro, so that each equilibrium is near the one before.
      const int j = i % 2 == 0 ? k : force_terms_ - 1 - k;
      if (!sample(arc_mm_.Zero(i, arc_terms_), normal_N_.Zero(j, force_terms_),
                  samples->row(i * force_terms_ + j).data())) {
        *lightest = i + j == 0;
        return false;
      }
    }
  }
  return true;
}

void LoadCell::Keep(const ChebyshevRows& c, int first, int size,
                    const Eigen::ArrayXXd& sizes, double least) {
  Group group;
  for (int i = 0; i < arc_terms_; ++i) {
    int count = force_terms_;
    while (count > 0 && sizes(i, count - 1) < least) --count;
    group.force_terms.push_back(count);
  }
  while (!group.force_terms.empty() && group.force_terms.back() == 0) {
    group.force_terms.pop_back();
  }
  group.values = LoadPolynomial::Padded(size);
  const int terms =
      std::accumulate(group.force_terms.begin(), group.force_terms.end(), 0);
  group.c.assign(static_cast<std::size_t>(terms) * group.values, 0);
  double* to = group.c.data();
  for (std::size_t i = 0; i < group.force_terms.size(); ++i) {
    for (int j = 0; j < group.force_terms[i]; ++j, to += group.values) {
      const auto row = static_cast<Eigen::Index>(i) * force_terms_ + j;
      std::copy_n(c.row(row).data() + first, size, to);
    }
  }
  groups_.push_back(std::move(group));
}

void LoadCell::SetBasis(double arc_mm, double normal_N,
                        PolynomialBasis* basis) const {
  SetChebyshev({arc_mm_.At(arc_mm), normal_N_.At(normal_N)},
               {arc_mm_.slope(), normal_N_.slope()},
               std::max(arc_terms_, force_terms_), basis);
}

LoadPolynomial LoadCell::Polynomial(int group) const {
  const Group& g = groups_[group];
  return {static_cast<int>(g.force_terms.size()), g.force_terms.data(),
          g.values, g.c.data()};
}

}  // namespace finray
