#include "finray/sensing/rival_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace finray {
namespace {

// A table of 2.5 mm and ten forces knows distances to this factor.
constexpr double kTableFactor = 0.5;
// A valley's std in rows.
constexpr double kWidest = 0.5;
// Starts this many rows from the node's own are the same contact.
constexpr double kSameRows = 1.5;

}  // namespace

RivalMap::RivalMap(const GaugeTable& table, const Eigen::VectorXd& weights)
    : table_(table) {
  std::vector<ContactStart> starts;
  for (const GaugeTable::Row& row : table.rows()) {
    std::vector<double>& rivals = rival_chi2_.emplace_back();
    for (const GaugeTable::Node& node : row.nodes) {
      table.FindStarts(node.values, weights, &starts);
      double least = std::numeric_limits<double>::infinity();
      for (const ContactStart& start : starts) {
        const double rows = std::abs(start.contacts[0].arc_mm - row.arc_mm) /
                            table.row_spacing_mm();
        if (rows > kSameRows) least = std::min(least, start.chi2);
      }
      rivals.push_back(least);
    }
  }
}

bool RivalMap::IsUnique(double arc_mm, double arc_std_mm, double normal_N,
                        double chi2, double within_noise) const {
  if (!(arc_std_mm < kWidest * table_.row_spacing_mm())) return false;
  const std::vector<GaugeTable::Row>& rows = table_.rows();
  const auto above = std::lower_bound(
      rows.begin(), rows.end(), arc_mm,
      [](const GaugeTable::Row& row, double arc) { return row.arc_mm < arc; });
  if (above == rows.begin() || above == rows.end()) return false;
  const double needed = std::sqrt(chi2) + std::sqrt(chi2 + within_noise);
  for (const std::size_t i :
       {static_cast<std::size_t>(above - rows.begin()),
        static_cast<std::size_t>(above - rows.begin()) - 1}) {
    const std::vector<GaugeTable::Node>& nodes = rows[i].nodes;
    std::size_t k = 0;
    while (k < nodes.size() && nodes[k].normal_N < normal_N) ++k;
    // Beyond the table, or as light as its first force.
    if (k < 2 || k == nodes.size()) return false;
    for (const std::size_t n : {k - 1, k}) {
      if (kTableFactor * std::sqrt(rival_chi2_[i][n]) < needed) return false;
    }
  }
  return true;
}

}  // namespace finray
