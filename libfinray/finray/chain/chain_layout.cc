#include "finray/chain/chain_layout.h"

#include <algorithm>
#include <string>

#include "finray/finger/geometry.h"
#include "finray/finger/mesh.h"
#include "finray/io/error.h"

namespace finray {
namespace {

struct Segment {
  double from_mm, to_mm;
  double stiffness_ratio;
};

std::vector<Segment> Segments(const BeamMesh& mesh,
                              const std::vector<double>& splits_mm) {
  const double hair = 1e-9 * mesh.nodes_mm.back();
  std::vector<double> splits = splits_mm;
  std::sort(splits.begin(), splits.end());
  std::vector<Segment> segments;
  for (int k = 0; k < mesh.elements(); ++k) {
    const double ratio = mesh.stiffness_ratio[k];
    double from = mesh.nodes_mm[k];
    const double to = mesh.nodes_mm[k + 1];
    for (const double split : splits) {
      if (split <= from + hair || split >= to - hair) continue;
      segments.push_back({from, split, ratio});
      from = split;
    }
    segments.push_back({from, to, ratio});
  }
  return segments;
}

double GaugeWeight(const Gauge& gauge, const Segment& segment, GaugeRule rule) {
  const double start = gauge.start_mm;
  const double end = gauge.start_mm + gauge.length_mm;
  if (rule == GaugeRule::kWholeJoint) {
    const double joint = 0.5 * (segment.from_mm + segment.to_mm);
    return start <= joint && joint < end ? 1 : 0;
  }
  const double overlap =
      std::min(end, segment.to_mm) - std::max(start, segment.from_mm);
  return std::max(0.0, overlap) / (segment.to_mm - segment.from_mm);
}

void CheckArguments(const Finger& finger, int resolution,
                    const std::vector<double>& splits_mm) {
  if (resolution < 1) {
    throw InputError("chain: resolution is " + std::to_string(resolution) +
                     ", expected at least 1");
  }
  for (const double split : splits_mm) {
    // Written so that a NaN fails.
    if (!(split >= 0 && split <= finger.front_length_mm)) {
      throw InputError("chain: a split at " + std::to_string(split) +
                       " mm is off the front beam");
    }
  }
  if (Stretches(finger)) {
    throw InputError(
        "chain: rigid links do not stretch, but a beam has a finite "
        "axial_stiffness_N");
  }
  for (const Side side : {Side::kFront, Side::kBack}) {
    if (ClampCompliance(finger, side) != 0) {
      throw InputError(
          "chain: its clamps are rigid, but a beam has a "
          "clamp_stiffness_N_mm_per_rad");
    }
    if (SurfaceOffset(finger, side) != 0) {
      throw InputError(
          "chain: contacts act on its beams, but a beam has a "
          "surface_offset_mm");
    }
  }
  for (const Rib& rib : finger.ribs) {
    if (!rib.HasMoments()) continue;
    throw InputError(std::string("chain: its hinges turn freely, but a rib has "
                                 "a ") +
                     (rib.Bends() ? "bending_stiffness_N_mm2"
                                  : "hinge_stiffness_N_mm_per_rad"));
  }
}

// Number of segments that end at or before an arc length.
int SegmentsBefore(const std::vector<Segment>& segments, double arc_mm) {
  int count = 0;
  for (const Segment& segment : segments) count += segment.to_mm <= arc_mm;
  return count;
}

}  // namespace

ChainLayout MakeChainLayout(const Finger& finger, int resolution,
                            GaugeRule gauge_rule,
                            const std::vector<double>& front_splits_mm) {
  CheckArguments(finger, resolution, front_splits_mm);
  const BeamMesh front_mesh = MakeBeamMesh(finger, Side::kFront, resolution);
  const BeamMesh back_mesh = MakeBeamMesh(finger, Side::kBack, resolution);
  const auto front = Segments(front_mesh, front_splits_mm);
  const auto back = Segments(back_mesh, {});
  const int n = static_cast<int>(front.size() + back.size());

  ChainLayout layout;
  layout.length_unit_mm = finger.front_length_mm;
  layout.force_unit_N = ForceUnit(finger);
  layout.gauges.setZero(finger.gauges.size(), n);
  const auto add_joint = [&](Side side, const Segment& segment, double sign) {
    const double arc = 0.5 * (segment.from_mm + segment.to_mm);
    const double length = segment.to_mm - segment.from_mm;
    for (std::size_t j = 0; j < finger.gauges.size(); ++j) {
      if (finger.gauges[j].beam != side) continue;
      layout.gauges(j, layout.joints()) =
          sign * GaugeWeight(finger.gauges[j], segment, gauge_rule);
    }
    layout.chain.Add(
        UndeformedPoint(finger, side, arc),
        BendingStiffness(finger, side) * segment.stiffness_ratio / length);
  };
  for (const Segment& segment : front) {
    layout.front_joint_mm.push_back(0.5 * (segment.from_mm + segment.to_mm));
    add_joint(Side::kFront, segment, 1);
  }
  for (auto segment = back.rbegin(); segment != back.rend(); ++segment) {
    add_joint(Side::kBack, *segment, -1);
  }
  layout.chain.tip_rest.t = BeamBase(finger, Side::kBack);
  layout.target = layout.chain.tip_rest;

  for (std::size_t k = 0; k < finger.ribs.size(); ++k) {
    const Rib& rib = finger.ribs[k];
    // Compared with the nodes' own numbers: rounding must not move a rib by a
    // segment.
    const double left = front_mesh.nodes_mm[front_mesh.rib_node[k]];
    const double right = back_mesh.nodes_mm[back_mesh.rib_node[k]];
    layout.ribs.push_back(
        {SegmentsBefore(front, left), n - SegmentsBefore(back, right),
         UndeformedPoint(finger, Side::kFront, rib.front_mm),
         UndeformedPoint(finger, Side::kBack, rib.back_mm), rib.length_mm,
         rib.length_mm / rib.axial_stiffness_N});
  }
  return layout;
}

}  // namespace finray
