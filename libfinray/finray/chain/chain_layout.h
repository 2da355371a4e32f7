#ifndef FINRAY_CHAIN_CHAIN_LAYOUT_H_
#define FINRAY_CHAIN_CHAIN_LAYOUT_H_

#include <Eigen/Core>
#include <vector>

#include "finray/chain/elastic_chain.h"
#include "finray/finger/finger.h"

namespace finray {

/// How much a gauge that ends inside a segment reads of the segment's joint.
enum class GaugeRule {
  kWholeJoint,  ///< All of it if the joint lies in the gauge: S_e of (16).
  kOverlap,     ///< The share of the segment that the gauge covers.
};

/// Where a rib is hinged to the chain: L_k and R_k of (7) to (11).
struct ChainRib {
  int joints_before_left;       ///< n_L, joints from the front base to L.
  int joints_before_right;      ///< n_R >= n_L.
  Eigen::Vector2d left, right;  ///< L and R at rest.
  double length_mm;             ///< d_0; other than |L R| means prestress.
  double compliance_mm_per_N;   ///< d_0 / EA; 0 for a rigid rib.
};

/// A finger as one chain (the "^" of Fig. 5). It runs from the clamped front
/// base up to the tip and down the back beam to the back base, which is {T}.
/// Each segment of both beams' meshes has one joint in its middle, k = EI / h.
/// A rigid link turns the corner at the tip.
struct ChainLayout {
  ElasticChain chain;   ///< g_st,0 is at the back base, axes along S.
  Pose<double> target;  ///< g_t: the back base is clamped where it rests.
  std::vector<ChainRib> ribs;
  /// Arc lengths on the front beam of the front joints, which come first.
  std::vector<double> front_joint_mm;
  /// S_e of (16), m x n: gauge angles are gauges * theta. Its entries are
  /// negative on the back beam, where the chain runs from tip to base but the
  /// finger's gauge angles, theta(p + w) - theta(p), count from the base.
  Eigen::MatrixXd gauges;
  double length_unit_mm;  ///< l_0.
  double force_unit_N;    ///< ForceUnit() of the finger.

  int joints() const { return chain.joints(); }
  /// Length of the load vector (F_t, f): 3 + r.
  int loads() const { return 3 + static_cast<int>(ribs.size()); }
};

/// Lays the chain out on MakeBeamMesh(finger, side, resolution). Segments of
/// the front beam are split at the arc lengths `front_splits_mm`; a split
/// within 1e-9 l_0 of a node changes nothing. Throws InputError for a
/// resolution below 1, a split off the beam, or a beam that stretches, as rigid
/// links do not.
ChainLayout MakeChainLayout(const Finger& finger, int resolution,
                            GaugeRule gauge_rule,
                            const std::vector<double>& front_splits_mm = {});

}  // namespace finray

#endif  // FINRAY_CHAIN_CHAIN_LAYOUT_H_
