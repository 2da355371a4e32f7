#include "finray/estimation/pair_table.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "finray/finger/geometry.h"
#include "finray/io/nan.h"

namespace finray {
namespace {

constexpr int kPairPlaces = 12;
// Forces in units of EI / l_0^2; for the paper's finger 1 to 16 N.
constexpr int kPairForceCount = 4;
constexpr double kPairForces[kPairForceCount] = {1.5, 5, 12, 25};
constexpr double kPlaceStep = 0.5;  // spacing over distance of places
constexpr double kForceStep = 0.6;  // spacing over force
constexpr double kFarthest = 3;     // from a node, in spacings

// Descents, with lengths in steps of the grid.
constexpr int kMostDescents = 15;
constexpr double kLongest = 0.7, kArrived = 1e-4, kSameMinimum = 1e-2;
constexpr double kBeyond = 0.25;  // the outermost nodes
constexpr std::size_t kMostMinima = 16;

// The interval of the grid that holds a force, and its length in ln f.
int Interval(double force) {
  int k = 0;
  while (k + 2 < kPairForceCount && force > kPairForces[k + 1]) ++k;
  return k;
}
double LogStep(int k) { return std::log(kPairForces[k + 1] / kPairForces[k]); }

}  // namespace

PairTable::PairTable(EquilibriumSolver* solver, double friction)
    : friction_(friction) {
  const Finger& finger = solver->model().finger();
  static_assert(kForcePairs == kPairForceCount * kPairForceCount);
  gauges_ = solver->model().gauges();
  unit_N_ = ForceUnit(finger);
  length_mm_ = finger.front_length_mm;
  step_mm_ = length_mm_ / kPairPlaces;
  for (int first = 0; first < kPairPlaces; ++first) {
    for (int second = first + 1; second < kPairPlaces; ++second) {
      Pair pair{first, second, {}, {}};
      pair.values.setConstant(kForcePairs, kColumns * gauges_, kNaN);
      for (int force = 0; force < kForcePairs; ++force) {
        if (force % kPairForceCount == 0) solver->Reset();
        const Vector at = At(pair, force);
        // Soft fingers fold over at the heavy end; the table ends there.
        if (!solver->SolveWithSensitivities(
                {{at[0], at[1], friction}, {at[2], at[3], friction}})) {
          force += kPairForceCount - 1 - force % kPairForceCount;
          continue;
        }
        for (int j = 0; j < gauges_; ++j) {
          pair.values(force, kColumns * j) = solver->outputs()[j];
          pair.values.block<1, kUnknowns>(force, kColumns * j + 1) =
              solver->d_outputs().block<1, kUnknowns>(j, 0).array() *
              Spacing(at).transpose().array();
        }
        pair.states[force] = solver->state();
      }
      pairs_.push_back(std::move(pair));
    }
  }
  solver->Reset();
}

PairTable::Vector PairTable::At(const Pair& pair, int force) const {
  return {step_mm_ * (pair.first + 0.5),
          unit_N_ * kPairForces[force / kPairForceCount],
          step_mm_ * (pair.second + 0.5),
          unit_N_ * kPairForces[force % kPairForceCount]};
}

PairTable::Vector PairTable::Spacing(const Vector& at) const {
  return {kPlaceStep * step_mm_, kForceStep * at[1], kPlaceStep * step_mm_,
          kForceStep * at[3]};
}

// By Cholesky's method without roots, for all nodes side by side.
PairTable::Rating PairTable::Rate(const Pair& pair,
                                  const Eigen::VectorXd& angles_rad,
                                  const Eigen::VectorXd& weight_per_rad) const {
  using Lanes = Eigen::Array<double, kForcePairs, 1>;
  Lanes normal[kUnknowns][kUnknowns], right[kUnknowns], rating;
  rating.setZero();
  for (int k = 0; k < kUnknowns; ++k) {
    right[k].setZero();
    for (int l = 0; l <= k; ++l) normal[k][l].setConstant(k == l);
  }
  for (int j = 0; j < gauges_; ++j) {
    const double w = weight_per_rad[j];
    if (w == 0) continue;
    const Lanes off = w * (angles_rad[j] - pair.values.col(kColumns * j));
    rating += off * off;
    for (int k = 0; k < kUnknowns; ++k) {
      const Lanes slope = w * pair.values.col(kColumns * j + 1 + k);
      right[k] += off * slope;
      for (int l = 0; l <= k; ++l) {
        normal[k][l] += slope * (w * pair.values.col(kColumns * j + 1 + l));
      }
    }
  }
  for (int k = 0; k < kUnknowns; ++k) {
    const Lanes share = 1 / normal[k][k];
    rating -= right[k] * right[k] * share;
    for (int l = k + 1; l < kUnknowns; ++l) {
      const Lanes factor = normal[l][k] * share;
      right[l] -= factor * right[k];
      for (int m = k + 1; m <= l; ++m) normal[l][m] -= factor * normal[m][k];
    }
  }
  Rating best{&pair, -1, std::numeric_limits<double>::infinity()};
  for (int force = 0; force < kForcePairs; ++force) {
    if (std::isnan(pair.values(force, 0))) continue;
    if (rating[force] < best.chi2) best = {&pair, force, rating[force]};
  }
  return best;
}

ContactStart PairTable::StartFrom(const Rating& rating,
                                  const Eigen::VectorXd& angles_rad,
                                  const Eigen::VectorXd& weight_per_rad) const {
  const Pair& pair = *rating.pair;
  Eigen::Matrix4d normal = Eigen::Matrix4d::Identity();
  Vector right = Vector::Zero();
  for (int j = 0; j < gauges_; ++j) {
    const double w = weight_per_rad[j];
    const auto row = pair.values.row(rating.force);
    const Vector slope =
        w * row.segment<kUnknowns>(kColumns * j + 1).matrix().transpose();
    normal.noalias() += slope * slope.transpose();
    if (w != 0) right += w * (angles_rad[j] - row[kColumns * j]) * slope;
  }
  const Vector steps =
      normal.llt().solve(right).cwiseMax(-kFarthest).cwiseMin(kFarthest);
  const Vector from = At(pair, rating.force);
  const Vector at = from + steps.cwiseProduct(Spacing(from));
  ContactStart start;
  start.count = kFittedContacts;
  start.chi2 = rating.chi2;
  start.state = &pair.states[rating.force];
  for (int c = 0; c < kFittedContacts; ++c) {
    start.contacts[c] = {std::clamp(at[2 * c], 0.0, length_mm_),
                         std::max(0.1 * from[2 * c + 1], at[2 * c + 1]),
                         friction_};
  }
  return start;
}

void PairTable::FindStarts(const Eigen::VectorXd& angles_rad,
                           const Eigen::VectorXd& weight_per_rad,
                           std::size_t most,
                           std::vector<ContactStart>* starts) const {
  std::array<Rating, kPairPlaces*(kPairPlaces - 1) / 2> ratings;
  auto end = ratings.begin();
  for (const Pair& pair : pairs_) {
    *end = Rate(pair, angles_rad, weight_per_rad);
    if (end->force >= 0) ++end;
  }
  std::sort(ratings.begin(), end,
            [](const Rating& a, const Rating& b) { return a.chi2 < b.chi2; });
  end = ratings.begin() +
        std::min(most, static_cast<std::size_t>(end - ratings.begin()));
  starts->clear();
  std::array<Vector, kMostMinima> minima;
  std::size_t found = 0;
  for (auto rating = ratings.begin(); rating < end; ++rating) {
    ContactStart start = StartFrom(*rating, angles_rad, weight_per_rad);
    Vector grid;
    if (found < minima.size() &&
        Descend(angles_rad, weight_per_rad, &start, &grid)) {
      const auto same = [&](const Vector& other) {
        return (other - grid).cwiseAbs().maxCoeff() < kSameMinimum;
      };
      if (std::any_of(minima.begin(), minima.begin() + found, same)) continue;
      minima[found++] = grid;
    }
    starts->push_back(start);
  }
}

const PairTable::Pair* PairTable::PairAt(const Place& place) const {
  const int first = place[0], second = place[2];
  if (first >= second) return nullptr;
  // Rows of the triangle first < second lie behind each other.
  return &pairs_[first * (2 * kPairPlaces - first - 1) / 2 + second - first -
                 1];
}

int PairTable::ForcesAt(const Place& place) {
  return place[1] * kPairForceCount + place[3];
}

PairTable::Vector PairTable::OnGrid(const ContactStart& start) const {
  Vector grid;
  for (int c = 0; c < kFittedContacts; ++c) {
    const double force = start.contacts[c].normal_N / unit_N_;
    const int k = Interval(force);
    grid[2 * c] = start.contacts[c].arc_mm / step_mm_ - 0.5;
    grid[2 * c + 1] = k + std::log(force / kPairForces[k]) / LogStep(k);
  }
  return grid;
}

bool PairTable::Descend(const Eigen::VectorXd& angles_rad,
                        const Eigen::VectorXd& weight_per_rad,
                        ContactStart* start, Vector* grid) const {
  Vector& x = *grid = OnGrid(*start);
  for (int i = 0; i < kMostDescents; ++i) {
    Place cell;
    for (int d = 0; d < kUnknowns; ++d) {
      const int last = (d % 2 == 0 ? kPairPlaces : kPairForceCount) - 1;
      if (!(x[d] > -kBeyond && x[d] < last + kBeyond)) return false;
      cell[d] = std::clamp(static_cast<int>(x[d]), 0, last - 1);
    }
    Vector change;
    if (!Descent(cell, x, angles_rad, weight_per_rad, &change)) return false;
    const double size = change.cwiseAbs().maxCoeff();
    x += std::min(1.0, kLongest / size) * change;
    if (size > kArrived) continue;
    Place near;
    for (int d = 0; d < kUnknowns; ++d) {
      near[d] = cell[d] + (x[d] - cell[d] > 0.5);
    }
    start->state = &PairAt(near)->states[ForcesAt(near)];
    for (int c = 0; c < kFittedContacts; ++c) {
      const int k = cell[2 * c + 1];
      start->contacts[c].arc_mm =
          std::clamp((x[2 * c] + 0.5) * step_mm_, 0.0, length_mm_);
      start->contacts[c].normal_N =
          kPairForces[k] * unit_N_ * std::exp((x[2 * c + 1] - k) * LogStep(k));
    }
    return true;
  }
  return false;
}

bool PairTable::Descent(const Place& cell, const Vector& x,
                        const Eigen::VectorXd& angles_rad,
                        const Eigen::VectorXd& weight_per_rad,
                        Vector* change) const {
  constexpr int kCorners = 1 << kUnknowns;
  std::array<const Pair*, kCorners> pair;
  std::array<int, kCorners> force;
  std::array<double, kCorners> share;               // N_k
  std::array<Vector, kCorners> by_grid, scale, to;  // dN_k, slopes, x - x_k
  for (int k = 0; k < kCorners; ++k) {
    Place place = cell;
    Vector side, sign;
    for (int d = 0; d < kUnknowns; ++d) {
      const bool far = k >> d & 1;
      const double within = x[d] - cell[d];
      place[d] += far;
      sign[d] = far ? 1 : -1;
      side[d] = far ? within : 1 - within;
      to[k][d] = far ? within - 1 : within;
      scale[k][d] = d % 2 == 0 ? 1 / kPlaceStep : LogStep(cell[d]) / kForceStep;
    }
    pair[k] = PairAt(place);
    force[k] = ForcesAt(place);
    if (pair[k] == nullptr || std::isnan(pair[k]->values(force[k], 0))) {
      return false;
    }
    share[k] = side.prod();
    for (int d = 0; d < kUnknowns; ++d) {
      double others = sign[d];
      for (int e = 0; e < kUnknowns; ++e) others *= e == d ? 1 : side[e];
      by_grid[k][d] = others;
    }
  }
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Vector right = Vector::Zero();
  for (int j = 0; j < gauges_; ++j) {
    const double w = weight_per_rad[j];
    if (w == 0) continue;
    double value = 0;
    Vector slope = Vector::Zero();
    for (int k = 0; k < kCorners; ++k) {
      const double* from = &pair[k]->values(force[k], kColumns * j);
      Vector half;
      for (int d = 0; d < kUnknowns; ++d) {
        half[d] = 0.5 * from[(1 + d) * kForcePairs] * scale[k][d];
      }
      const double here = *from + half.dot(to[k]);
      value += share[k] * here;
      slope += here * by_grid[k] + share[k] * half;
    }
    slope *= w;
    normal.noalias() += slope * slope.transpose();
    right += w * (angles_rad[j] - value) * slope;
  }
  const Eigen::LLT<Eigen::Matrix4d> factor(normal);
  if (factor.info() != Eigen::Success) return false;
  *change = factor.solve(right);
  return change->allFinite();
}

}  // namespace finray
