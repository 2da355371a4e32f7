#include "finray/sensing/fast/rival_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace finray {
namespace {

// Between nodes d may be smaller by this factor (RivalMapTest).
constexpr double kBetweenNodes = 0.8;
// Without a fit, the true chi2 may be this fraction of the table's. A start is
// not fitted if that is far above anything that noise can do.
constexpr double kTableFactor = 0.25, kFarAbove = 400;
// The largest std of l_c, in row spacings.
constexpr double kWidest = 0.5;
// A valley is straight to within this factor (Valley::kSlack).
constexpr double kStraight = 1.25;
// Starts within this many rows of the node's own are the same contact.
constexpr double kSameRows = 1.5;

}  // namespace

RivalMap::RivalMap(const GaugeTable& table, const GaugeSurface& surface,
                   const Eigen::VectorXd& weights, double most_force_N)
    : table_(table),
      surface_(surface),
      weights_(weights),
      most_force_N_(most_force_N) {
  for (const GaugeTable::Row& row : table.rows()) {
    nodes_.emplace_back(row.nodes.size() - 1);
  }
}

double RivalMap::DistancePerN(std::size_t row, std::size_t node) const {
  Node& of = nodes_[row][node - 1];
  std::call_once(of.judged, [&] {
    const GaugeTable::Row& at = table_.rows()[row];
    of.distance_per_N = Judge(at.nodes[node], at.arc_mm);
  });
  return of.distance_per_N;
}

void RivalMap::Prepare() const {
  for (std::size_t row = 0; row < nodes_.size(); ++row) {
    for (std::size_t node = 1; node <= nodes_[row].size(); ++node) {
      DistancePerN(row, node);
    }
  }
}

double RivalMap::Judge(const GaugeTable::Node& node, double arc_mm) const {
  const double same_mm = kSameRows * table_.row_spacing_mm();
  double least = std::numeric_limits<double>::infinity();
  ContactSolution fit;
  const auto fits = [&](const PointContact& start) {
    return surface_.Fit(node.values, weights_, most_force_N_, start, &fit);
  };
  std::vector<ContactStart> profile, starts;
  table_.Profile(node.values, weights_, GaugeTable::kAnyChi2, &profile);
  GaugeTable::FindStarts(profile, &starts);
  for (const ContactStart& start : starts) {
    const PointContact& contact = start.contacts[0];
    if (std::abs(contact.arc_mm - arc_mm) <= same_mm) continue;
    double chi2 = kTableFactor * start.chi2;
    if (chi2 < kFarAbove && fits(contact)) {
      if (std::abs(fit.contacts[0].arc_mm - arc_mm) <= same_mm) continue;
      chi2 = fit.chi2;
    }
    least = std::min(least, chi2);
  }
  // Places that the node's std puts farther away than their chi2 does
  // (Valley).
  if (!fits({arc_mm, node.normal_N, table_.friction()})) return 0;
  const ContactMatrix covariance = CovarianceOf(fit.information);
  for (const ContactStart& place : profile) {
    const double arc_away = std::abs(place.contacts[0].arc_mm - arc_mm);
    const double normal_away =
        std::abs(place.contacts[0].normal_N - node.normal_N);
    const double d = std::sqrt(place.chi2);
    if (arc_away <= same_mm) continue;
    if (arc_away > kStraight * d * std::sqrt(covariance(0, 0)) ||
        normal_away > kStraight * d * std::sqrt(covariance(1, 1))) {
      least = std::min(least, place.chi2);
    }
  }
  return std::sqrt(least) / node.normal_N;
}

bool RivalMap::IsUnique(double arc_mm, double arc_std_mm, double normal_N,
                        double chi2, double within_noise) const {
  if (!(arc_std_mm < kWidest * table_.row_spacing_mm())) return false;
  const std::vector<GaugeTable::Row>& rows = table_.rows();
  const auto above = std::lower_bound(
      rows.begin(), rows.end(), arc_mm,
      [](const GaugeTable::Row& row, double arc) { return row.arc_mm < arc; });
  if (above == rows.begin() || above == rows.end()) return false;
  double least = std::numeric_limits<double>::infinity();
  for (const std::ptrdiff_t i :
       {above - rows.begin(), above - rows.begin() - 1}) {
    const std::vector<GaugeTable::Node>& nodes = rows[i].nodes;
    std::size_t k = 1;
    while (k < nodes.size() && nodes[k].normal_N < normal_N) ++k;
    if (k == nodes.size()) return false;  // beyond the table
    const auto row = static_cast<std::size_t>(i);
    least = std::min(
        {least, DistancePerN(row, k), DistancePerN(row, k > 1 ? k - 1 : 1)});
  }
  return kBetweenNodes * least * normal_N >
         std::sqrt(chi2) + std::sqrt(chi2 + within_noise);
}

}  // namespace finray
