#include "finray/chain/chain_state.h"

namespace finray {

ChainState ChainState::Straight(const ChainLayout& layout) {
  return {Eigen::VectorXd::Zero(layout.joints()),
          Eigen::VectorXd::Zero(layout.loads())};
}

ChainUnits::ChainUnits(const ChainLayout& layout) {
  const int n = layout.joints();
  const int r = static_cast<int>(layout.ribs.size());
  const double length = layout.length_unit_mm, force = layout.force_unit_N;
  const double moment = force * length;
  rows.resize(n + 3 + r);
  rows << 1, length, length, Eigen::VectorXd::Constant(n, moment),
      Eigen::VectorXd::Constant(r, length);
  columns.resize(n + 3 + r + 2);
  columns << Eigen::VectorXd::Ones(n), moment, force, force,
      Eigen::VectorXd::Constant(r, force), length, force;
}

}  // namespace finray
