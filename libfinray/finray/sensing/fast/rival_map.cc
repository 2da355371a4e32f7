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
// The map needs a rival's chi2, but not its exact place. A fit that creeps and
// ends without a result counts as a possible rival, and each frame near its
// node would be searched.
constexpr double kFitTolerance = 1e-5;
// The largest std of l_c, in row spacings.
constexpr double kWidest = 0.5;
// A valley is straight to within this factor (Valley::kSlack).
constexpr double kStraight = 1.25;
// Starts within this many rows of the node's own are the same contact.
constexpr double kSameRows = 1.5;

}  // namespace

RivalMap::RivalMap(const GaugeTable& table, const Eigen::VectorXd& weights,
                   ContactFit* fit)
    : table_(table) {
  fit->set_tolerance(kFitTolerance);
  for (const GaugeTable::Row& row : table.rows()) {
    std::vector<double>& distances = distance_per_N_.emplace_back();
    for (std::size_t k = 1; k < row.nodes.size(); ++k) {
      distances.push_back(DistancePerN(row.nodes[k], row.arc_mm, weights, fit));
    }
  }
}

double RivalMap::DistancePerN(const GaugeTable::Node& node, double arc_mm,
                              const Eigen::VectorXd& weights, ContactFit* fit) {
  const double same_mm = kSameRows * table_.row_spacing_mm();
  double least = std::numeric_limits<double>::infinity();
  std::vector<PointContact> contact(1);
  table_.Profile(node.values, weights, &profile_);
  GaugeTable::FindStarts(profile_, &starts_);
  for (const ContactStart& start : starts_) {
    contact[0] = start.contacts[0];
    if (std::abs(contact[0].arc_mm - arc_mm) <= same_mm) continue;
    double chi2 = kTableFactor * start.chi2;
    if (chi2 < kFarAbove) {
      fit->set_state(*start.state);
      if (fit->Fit(node.values, weights, &contact)) {
        if (std::abs(contact[0].arc_mm - arc_mm) <= same_mm) continue;
        chi2 = fit->chi2();
      }
    }
    least = std::min(least, chi2);
  }
  // Places that the node's std puts farther away than their chi2 does
  // (Valley).
  contact[0] = {arc_mm, node.normal_N, table_.friction()};
  fit->set_state(node.state);
  if (!fit->Fit(node.values, weights, &contact)) return 0;
  const ContactMatrix covariance = CovarianceOf(fit->information());
  for (const ContactStart& place : profile_) {
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
    least = std::min({least, distance_per_N_[i][k - 1],
                      distance_per_N_[i][k > 1 ? k - 2 : 0]});
  }
  return kBetweenNodes * least * normal_N >
         std::sqrt(chi2) + std::sqrt(chi2 + within_noise);
}

}  // namespace finray
