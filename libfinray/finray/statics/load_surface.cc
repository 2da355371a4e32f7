#include "finray/statics/load_surface.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "finray/finger/geometry.h"
#include "finray/ladder/round_up.h"

namespace finray {
namespace {

// A cell starts with as many terms as do for this resolution, that of an
// estimate with gauges of usual noise. Light loads need fewer.
constexpr double kUsualResolution = 1e-10;
constexpr int kForceTerms[] = {9, 11};
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
// Cells end at these forces, in units of EI / l_0^2: heavy ones bend sharply.
constexpr double kCellEnds[] = {4, 13, 26};
// Elements longer than this have two cells.
constexpr double kLongElement = 0.2;  // of l_0
constexpr int kMostElements = 4;      // a bay
// The series goes on behind its last terms.
constexpr double kTail = 2;
// Either direction may leave out this share of the resolution.
constexpr double kShare = 0.5;
// Terms below this share of the resolution are left out. Some dozen of them are
// left out together.
constexpr double kRounding = 0.03;
// The unit of values that are 0 in all of a cell.
constexpr double kTiny = std::numeric_limits<double>::min();

using RowMajor =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// T_k(x) and its derivatives by an argument of which x has the slope `per`.
void SetBasis(double x, double per, int terms, PolynomialBasis* basis) {
  auto& [t, d, dd] = basis->by;
  t[0] = 1;
  d[0] = dd[0] = 0;
  t[1] = x;
  d[1] = 1;
  dd[1] = 0;
  for (int k = 2; k < terms; ++k) {
    t[k] = 2 * x * t[k - 1] - t[k - 2];
    d[k] = 2 * t[k - 1] + 2 * x * d[k - 1] - d[k - 2];
    dd[k] = 4 * d[k - 1] + 2 * x * dd[k - 1] - dd[k - 2];
  }
  for (int k = 0; k < terms; ++k) {
    d[k] *= per;
    dd[k] *= per * per;
  }
}

// The matrix that makes coefficients of values at the zeros of T_terms.
Eigen::MatrixXd Transform(int terms) {
  Eigen::MatrixXd of(terms, terms);
  for (int k = 0; k < terms; ++k) {
    for (int i = 0; i < terms; ++i) {
      of(k, i) =
          (k == 0 ? 1.0 : 2.0) / terms * std::cos(M_PI * k * (i + 0.5) / terms);
    }
  }
  return of;
}

// Makes coefficients of `values` at the zeros, [arc term, force term] x value.
RowMajor Coefficients(const RowMajor& values, int arc_terms, int force_terms) {
  // Zeros rise, cosines fall.
  const Eigen::MatrixXd by_arc = Transform(arc_terms).rowwise().reverse(),
                        by_force = Transform(force_terms).rowwise().reverse();
  RowMajor along(values.rows(), values.cols());
  for (int i = 0; i < arc_terms; ++i) {
    along.middleRows(i * force_terms, force_terms) =
        by_force * values.middleRows(i * force_terms, force_terms);
  }
  // A row of this has all values of all force terms.
  const Eigen::Index row = force_terms * values.cols();
  RowMajor c(values.rows(), values.cols());
  Eigen::Map<RowMajor>(c.data(), arc_terms, row) =
      by_arc * Eigen::Map<const RowMajor>(along.data(), arc_terms, row);
  return c;
}

// The largest coefficients of some values for each term, [arc term, force
// term], in units of each value.
Eigen::ArrayXXd TermSizes(const RowMajor& c, int first,
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

// The interval of rising `nodes` that holds `at`.
std::size_t IntervalOf(const std::vector<double>& nodes, double at) {
  const auto next = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, at);
  return static_cast<std::size_t>(next - nodes.begin()) - 1;
}

}  // namespace

// A rectangle of loads.
struct LoadCell {
  struct Interval {
    double from, to;

    double middle() const { return 0.5 * (from + to); }
    // The rising zeros of T_terms.
    double Zero(int i, int terms) const {
      return middle() - 0.5 * (to - from) * std::cos(M_PI * (i + 0.5) / terms);
    }
    double slope() const { return 2 / (to - from); }
    double At(double x) const {
      return std::clamp((x - middle()) * slope(), -1.0, 1.0);
    }
  };
  struct Group {
    std::vector<int> force_terms;  // LoadPolynomial
    std::vector<double> c;
  };

  Interval arc, force;
  int arc_terms = 0, force_terms = kForceTerms[1];
  int halvings = 0;
  std::once_flag made;
  // Afterwards: the groups, or the halves, or neither where there is no
  // equilibrium.
  std::vector<Group> groups;
  double error = 0;
  bool halved_by_arc = false;
  std::unique_ptr<LoadCell> halves[2];

  // Computes the values at all zeros. Returns false at the first one without an
  // equilibrium; `*lightest` says whether that is the first of all.
  bool Sample(const LoadSurface::Sampler& sample, RowMajor* values,
              bool* lightest) const {
    for (int i = 0; i < arc_terms; ++i) {
      for (int k = 0; k < force_terms; ++k) {
        // To and fro, so that each equilibrium is near the one before.
        const int j = i % 2 == 0 ? k : force_terms - 1 - k;
        if (!sample(arc.Zero(i, arc_terms), force.Zero(j, force_terms),
                    values->row(i * force_terms + j).data())) {
          *lightest = i + j == 0;
          return false;
        }
      }
    }
    return true;
  }

  // Keeps `size` values from `first` on, but for terms of a size below `least`
  // that none of the others follows.
  void Keep(const RowMajor& c, int first, int size,
            const Eigen::ArrayXXd& sizes, double least) {
    Group group;
    for (int i = 0; i < arc_terms; ++i) {
      int count = force_terms;
      while (count > 0 && sizes(i, count - 1) < least) --count;
      group.force_terms.push_back(count);
    }
    while (!group.force_terms.empty() && group.force_terms.back() == 0) {
      group.force_terms.pop_back();
    }
    const int padded = LoadSurface::Padded(size);
    const int terms =
        std::accumulate(group.force_terms.begin(), group.force_terms.end(), 0);
    group.c.assign(static_cast<std::size_t>(terms) * padded, 0);
    double* to = group.c.data();
    for (std::size_t i = 0; i < group.force_terms.size(); ++i) {
      for (int j = 0; j < group.force_terms[i]; ++j, to += padded) {
        const auto row = static_cast<Eigen::Index>(i) * force_terms + j;
        std::copy_n(c.row(row).data() + first, size, to);
      }
    }
    groups.push_back(std::move(group));
  }

  LoadPolynomial Polynomial(int group, int size) const {
    const Group& g = groups[group];
    return {static_cast<int>(g.force_terms.size()), g.force_terms.data(),
            LoadSurface::Padded(size), g.c.data()};
  }

  void Halve(bool by_arc) {
    halved_by_arc = by_arc;
    for (int i = 0; i < 2; ++i) {
      halves[i] = std::make_unique<LoadCell>();
      LoadCell& half = *halves[i];
      half.arc = arc;
      half.force = force;
      half.halvings = halvings + 1;
      half.arc_terms = arc_terms;
      half.force_terms = force_terms;
      int& terms = by_arc ? half.arc_terms : half.force_terms;
      terms = std::max(kLeastTerms, terms - kFewer);
      Interval& side = by_arc ? half.arc : half.force;
      (i == 0 ? side.to : side.from) = side.middle();
    }
  }
};

double LoadSurface::Place::error() const { return cell_->error; }

int LoadSurface::Padded(int size) {
  return RoundUp(size, LoadPolynomial::kPadding);
}

LoadSurface::Domain LoadSurface::DomainOf(const Finger& finger,
                                          const BeamMesh& front,
                                          double heaviest_N) {
  Domain domain;
  const auto bays = static_cast<int>(front.bay_node.size()) - 1;
  if (front.elements() > kMostElements * bays) return domain;
  std::vector<double>& arcs = domain.arcs_mm;
  for (const double end_mm : front.nodes_mm) {
    if (!arcs.empty() &&
        end_mm - arcs.back() > kLongElement * finger.front_length_mm) {
      arcs.push_back(0.5 * (arcs.back() + end_mm));
    }
    arcs.push_back(end_mm);
  }
  for (const Gauge& gauge : finger.gauges) {
    if (gauge.beam != Side::kFront) continue;
    arcs.push_back(gauge.start_mm);
    arcs.push_back(gauge.start_mm + gauge.length_mm);
  }
  std::sort(arcs.begin(), arcs.end());
  const double same_mm = 1e-6 * finger.front_length_mm;
  const double end_mm = arcs.back();
  arcs.erase(std::unique(arcs.begin(), arcs.end(),
                         [&](double a, double b) { return b - a < same_mm; }),
             arcs.end());
  arcs.back() = end_mm;
  domain.forces_N = {0};
  for (const double force : kCellEnds) {
    const double end_N = force * ForceUnit(finger);
    if (end_N < heaviest_N) domain.forces_N.push_back(end_N);
  }
  domain.forces_N.push_back(heaviest_N);
  return domain;
}

LoadSurface::LoadSurface(Domain domain, std::vector<int> sizes,
                         Eigen::VectorXd resolution,
                         std::function<Sampler()> make_sampler,
                         double negligible)
    : domain_(std::move(domain)),
      sizes_(std::move(sizes)),
      resolution_(std::move(resolution)),
      make_sampler_(std::move(make_sampler)),
      negligible_(negligible) {
  const double coarse =
      resolution_.size() > 0
          ? std::max(1.0, resolution_.minCoeff() / kUsualResolution)
          : 1;
  for (std::size_t i = 0; i + 1 < domain_.arcs_mm.size(); ++i) {
    for (std::size_t k = 0; k + 1 < domain_.forces_N.size(); ++k) {
      auto cell = std::make_unique<LoadCell>();
      cell->arc = {domain_.arcs_mm[i], domain_.arcs_mm[i + 1]};
      cell->force = {domain_.forces_N[k], domain_.forces_N[k + 1]};
      cell->arc_terms = ArcTerms((domain_.arcs_mm[i + 1] - domain_.arcs_mm[i]) /
                                     domain_.arcs_mm.back(),
                                 coarse);
      cell->force_terms = ForceTerms(kForceTerms[k == 0 ? 0 : 1], coarse);
      cells_.push_back(std::move(cell));
    }
  }
}

LoadSurface::~LoadSurface() = default;

std::size_t LoadSurface::CellOf(double arc_mm, double normal_N) const {
  // Written so that a NaN lies outside.
  if (cells_.empty() ||
      !(arc_mm >= domain_.arcs_mm.front() && arc_mm <= domain_.arcs_mm.back() &&
        normal_N >= 0 && normal_N <= domain_.forces_N.back())) {
    return cells_.size();
  }
  return IntervalOf(domain_.arcs_mm, arc_mm) * (domain_.forces_N.size() - 1) +
         IntervalOf(domain_.forces_N, normal_N);
}

const LoadCell* LoadSurface::PartOf(LoadCell* cell, double arc_mm,
                                    double normal_N) const {
  for (;;) {
    Need(cell);
    if (!cell->halves[0]) return cell;
    const bool upper = cell->halved_by_arc ? arc_mm > cell->arc.middle()
                                           : normal_N > cell->force.middle();
    cell = cell->halves[upper].get();
  }
}

bool LoadSurface::Locate(double arc_mm, double normal_N, Place* place) const {
  const std::size_t of_domain = CellOf(arc_mm, normal_N);
  if (of_domain == cells_.size()) return false;
  const LoadCell* const cell =
      PartOf(cells_[of_domain].get(), arc_mm, normal_N);
  if (cell->groups.empty()) return false;
  place->cell_ = cell;
  SetBasis(cell->arc.At(arc_mm), cell->arc.slope(), cell->arc_terms,
           &place->arc_);
  SetBasis(cell->force.At(normal_N), cell->force.slope(), cell->force_terms,
           &place->force_);
  return true;
}

void LoadSurface::Need(LoadCell* cell) const {
  std::call_once(cell->made, [&] {
    while (!Make(cell)) {
    }
  });
}

void LoadSurface::MakeAll() const {
  for (const auto& cell : cells_) MakeWhole(cell.get());
}

void LoadSurface::MakeWhole(LoadCell* cell) const {
  Need(cell);
  for (const auto& half : cell->halves) {
    if (half) MakeWhole(half.get());
  }
}

void LoadSurface::MakeFor(
    const std::vector<std::array<double, 2>>& loads) const {
  std::vector<std::vector<std::array<double, 2>>> loads_of(cells_.size() + 1);
  for (const auto& load : loads) {
    loads_of[CellOf(load[0], load[1])].push_back(load);
  }
  tbb::parallel_for(std::size_t{0}, cells_.size(), [&](std::size_t i) {
    for (const auto& load : loads_of[i]) {
      PartOf(cells_[i].get(), load[0], load[1]);
    }
  });
}

bool LoadSurface::Make(LoadCell* cell) const {
  const int arc_terms = cell->arc_terms, force_terms = cell->force_terms;
  const bool may_halve = cell->halvings < kMostHalvings;
  RowMajor values(arc_terms * force_terms,
                  std::accumulate(sizes_.begin(), sizes_.end(), 0));
  bool lightest = false;
  if (!cell->Sample(make_sampler_(), &values, &lightest)) {
    // The part of lighter loads may have equilibria.
    if (may_halve && !lightest) cell->Halve(false);
    return true;
  }
  const RowMajor c = Coefficients(values, arc_terms, force_terms);
  const Eigen::ArrayXXd sizes =
      TermSizes(c, 0, resolution_, arc_terms, force_terms);
  const TermFall arc(sizes.rowwise().maxCoeff());
  const TermFall force(sizes.colwise().maxCoeff().transpose());
  cell->error = arc.error + force.error;
  if (cell->error > 1) {
    const int arcs = arc.Needed(), forces = force.Needed();
    const bool enough = arcs <= kMostArcTerms && forces <= kMostForceTerms;
    if (enough || !may_halve) {
      cell->arc_terms = std::min(arcs, kMostArcTerms);
      cell->force_terms = std::min(forces, kMostForceTerms);
      if (cell->arc_terms != arc_terms || cell->force_terms != force_terms) {
        return false;
      }
    } else {
      cell->Halve(arcs > kMostArcTerms &&
                  (forces <= kMostForceTerms || arc.error > force.error));
      return true;
    }
  }
  cell->Keep(c, 0, sizes_[0], sizes, kRounding);
  int first = sizes_[0];
  for (std::size_t g = 1; g < sizes_.size(); ++g) {
    const Eigen::VectorXd largest = c.middleCols(first, sizes_[g])
                                        .cwiseAbs()
                                        .colwise()
                                        .maxCoeff()
                                        .cwiseMax(kTiny)
                                        .transpose();
    cell->Keep(c, first, sizes_[g],
               TermSizes(c, first, largest, arc_terms, force_terms),
               negligible_);
    first += sizes_[g];
  }
  return true;
}

void LoadSurface::Values(const Place& place, int group, double* values) const {
  EvaluateValues(place.cell_->Polynomial(group, sizes_[group]), place.arc_,
                 place.force_, values);
}

void LoadSurface::Jets(const Place& place, int group, double* jets) const {
  EvaluateJets(place.cell_->Polynomial(group, sizes_[group]), place.arc_,
               place.force_, jets);
}

}  // namespace finray
