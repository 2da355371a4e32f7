#include "finray/scene/simulation.h"
#include "inside.h"

namespace finray::v1 {

struct Simulator::Inside {
  finray::Finger finger;
  finray::Scene scene;
  finray::Discretization discretization;
};

Simulator::Simulator(const Finger& finger, const Scene& scene,
                     const Discretization& discretization)
    : inside_(Guarded([&] {
        return std::unique_ptr<Inside>(new Inside{finger.inside().finger,
                                                  scene.inside().scene,
                                                  ToInternal(discretization)});
      })) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

Simulation Simulator::Simulate(const Table& frames, bool shapes) const {
  return Guarded([&] {
    FrameTable table = ToFrameTable(frames), shape_table;
    const finray::SimulationSummary summary = finray::Simulate(
        inside_->finger, inside_->scene, inside_->discretization, &table,
        shapes ? &shape_table : nullptr);
    return Simulation{FromFrameTable(table, frames.name()),
                      FromFrameTable(shape_table, frames.name()),
                      summary.contact,
                      summary.free,
                      summary.not_converged,
                      summary.first_failure};
  });
}

Table Simulator::MakeLog(const Table& simulated, const LogNoise& noise) const {
  return Guarded([&] {
    return FromFrameTable(
        finray::MakeLog(inside_->finger, ToFrameTable(simulated),
                        {noise.force_std_N, noise.object_std_mm, noise.seed,
                         noise.pin_std_mm}),
        simulated.name());
  });
}

}  // namespace finray::v1
