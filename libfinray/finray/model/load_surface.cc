#include "finray/model/load_surface.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "finray/finger/geometry.h"

namespace finray {
namespace {

// Cells end at these forces, in units of EI / l_0^2: heavy ones bend sharply.
constexpr double kCellEnds[] = {4, 13, 26};
// Elements longer than this have two cells.
constexpr double kLongElement = 0.2;  // of l_0
constexpr int kMostElements = 4;      // a bay

// The interval of rising `nodes` that holds `at`.
std::size_t IntervalOf(const std::vector<double>& nodes, double at) {
  const auto next = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, at);
  return static_cast<std::size_t>(next - nodes.begin()) - 1;
}

}  // namespace

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

LoadSurface::LoadSurface(Domain domain, LoadValues values)
    : domain_(std::move(domain)), values_(std::move(values)) {
  const auto &arcs = domain_.arcs_mm, &forces = domain_.forces_N;
  for (std::size_t i = 0; i + 1 < arcs.size(); ++i) {
    for (std::size_t k = 0; k + 1 < forces.size(); ++k) {
      cells_.push_back(std::make_unique<LoadCell>(
          LoadCell::Interval{arcs[i], arcs[i + 1]},
          LoadCell::Interval{forces[k], forces[k + 1]}, arcs.back(), k == 0,
          values_));
    }
  }
}

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

bool LoadSurface::Locate(double arc_mm, double normal_N, Place* place) const {
  const std::size_t of_domain = CellOf(arc_mm, normal_N);
  if (of_domain == cells_.size()) return false;
  place->cell_ = cells_[of_domain]->PartAt(arc_mm, normal_N, values_);
  if (!place->cell_->has_values()) return false;
  place->cell_->SetBasis(arc_mm, normal_N, &place->basis_);
  return true;
}

void LoadSurface::MakeAll() const {
  for (const auto& cell : cells_) cell->MakeWhole(values_);
}

void LoadSurface::MakeFor(
    const std::vector<std::array<double, 2>>& loads) const {
  std::vector<std::vector<std::array<double, 2>>> loads_of(cells_.size() + 1);
  for (const auto& load : loads) {
    loads_of[CellOf(load[0], load[1])].push_back(load);
  }
  tbb::parallel_for(std::size_t{0}, cells_.size(), [&](std::size_t i) {
    for (const auto& load : loads_of[i]) {
      cells_[i]->PartAt(load[0], load[1], values_);
    }
  });
}

void LoadSurface::Values(const Place& place, int group, double* values) const {
  EvaluateValues(place.cell_->Polynomial(group), place.basis_, values);
}

void LoadSurface::Gradients(const Place& place, int group,
                            double* gradients) const {
  EvaluateGradients(place.cell_->Polynomial(group), place.basis_, gradients);
}

}  // namespace finray
