#include "finray/calib/solve/frame_pass.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "finray/calib/solve/frame_linearizer.h"
#include "finray/calib/solve/frame_surface.h"

namespace finray {
namespace {

// A thread evaluates so many frames at a time. There are some for each cell of
// a surface, whose coefficients take more memory than a core has next to it.
constexpr std::size_t kChunk = 128;
// Errors of the surface move a parameter by about so many of its std at most.
// If each of N frames has an error of e std, and all pull the same way, the
// parameter moves by e sqrt(N) of its std.
constexpr double kExact_std = 1e-2;
// A frame may leave out this in rad where gauges tell hardly anything.
constexpr double kExact_rad = 1e-7;

using Evaluate = std::function<void(int frame, FrameLinearizer* linearizer,
                                    LinearizedFrame* out)>;

// Makes the cells of the surface where the frames start, on the threads of the
// caller's arena.
void MakeCells(const std::vector<int>& frames, const Contacts& contacts,
               const CalibrationProblem& problem, const ModelSurface& surface) {
  std::vector<std::array<double, 2>> wanted;
  wanted.reserve(frames.size());
  for (const int i : frames) {
    const CalibrationFrame& frame = problem.frame(i);
    if (!FrameLinearizer::FitsSurface(frame, problem.parameters())) continue;
    wanted.push_back(frame.contact
                         ? contacts[i]
                         : FingerModel::FreeContact(problem.finger()));
  }
  surface.MakeFor(wanted);
}

FrameFit::StartState StatesOf(const ContactStore& contacts) {
  return [&contacts](const double* contact, LadderState* state) {
    *state = contacts.StateNear(contact[0], contact[1]);
  };
}

void VisitInOrder(const std::vector<int>& frames, const Plan& plan,
                  const Contacts& contacts, CalibrationProblem* problem,
                  const Evaluate& evaluate, const FrameVisitor& visit) {
  struct Chunk {
    std::size_t first, count;
    std::array<LinearizedFrame, kChunk> frames;
  };
  const EquilibriumSolver solver(problem->finger(), problem->discretization());
  std::optional<ModelSurface> surface;
  if (frames.size() >= kFramesForSurface) {
    const double exact_std =
        kExact_std / std::sqrt(static_cast<double>(frames.size()));
    surface.emplace(SurfaceOf(*problem, exact_std, kExact_rad, true));
  }
  tbb::task_arena(problem->threads()).execute([&] {
    problem->parameters().FollowHistories();
    if (surface) MakeCells(frames, contacts, *problem, *surface);
  });
  tbb::enumerable_thread_specific<FrameLinearizer> linearizers([&] {
    FrameLinearizer::Options options;
    if (surface) options.surface = &*surface;
    return FrameLinearizer(solver, plan, &problem->blocks(),
                           &problem->parameters(), options);
  });
  const int threads = problem->threads();
  // The pipeline holds at most ring.size() chunks and finishes them in order.
  std::vector<Chunk> ring(4 * static_cast<std::size_t>(threads));
  std::size_t begun = 0;
  const auto begin = [&](tbb::flow_control& control) -> Chunk* {
    const std::size_t first = begun * kChunk;
    if (first >= frames.size()) {
      control.stop();
      return nullptr;
    }
    Chunk& chunk = ring[begun++ % ring.size()];
    chunk.first = first;
    chunk.count = std::min(kChunk, frames.size() - first);
    return &chunk;
  };
  // Along the finger, so that frames of one cell follow each other.
  const auto evaluate_all = [&](Chunk* chunk) {
    FrameLinearizer& linearizer = linearizers.local();
    std::array<std::pair<double, std::size_t>, kChunk> order;
    for (std::size_t k = 0; k < chunk->count; ++k) {
      const double arc_mm = contacts[frames[chunk->first + k]][0];
      order[k] = {std::isnan(arc_mm) ? 0 : arc_mm, k};
    }
    std::sort(order.begin(), order.begin() + chunk->count);
    for (std::size_t k = 0; k < chunk->count; ++k) {
      const std::size_t i = order[k].second;
      evaluate(frames[chunk->first + i], &linearizer, &chunk->frames[i]);
    }
    return chunk;
  };
  const auto visit_all = [&](Chunk* chunk) {
    for (std::size_t k = 0; k < chunk->count; ++k) {
      visit(frames[chunk->first + k], chunk->frames[k]);
    }
  };
  using Mode = tbb::filter_mode;
  tbb::task_arena(threads).execute([&] {
    tbb::parallel_pipeline(
        ring.size(),
        tbb::make_filter<void, Chunk*>(Mode::serial_in_order, begin) &
            tbb::make_filter<Chunk*, Chunk*>(Mode::parallel, evaluate_all) &
            tbb::make_filter<Chunk*, void>(Mode::serial_in_order, visit_all));
  });
}

}  // namespace

void LinearizeFrames(const std::vector<int>& frames,
                     CalibrationProblem* problem, ContactStore* contacts,
                     const FrameVisitor& visit) {
  contacts->Guess(frames, ContactGuess::From::kObjectFirst);
  VisitInOrder(
      frames, problem->plan(), contacts->all(), problem,
      [&](int i, FrameLinearizer* linearizer, LinearizedFrame* out) {
        if (!linearizer->Linearize(problem->frame(i), (*contacts)[i],
                                   StatesOf(*contacts), out)) {
          throw std::runtime_error(
              "the model cannot be evaluated at the solution");
        }
      },
      visit);
}

void FitContacts(const std::vector<int>& frames, CalibrationProblem* problem,
                 ContactStore* contacts, const FrameVisitor& visit) {
  contacts->Guess(frames, ContactGuess::From::kAll);
  VisitInOrder(
      frames, problem->plan(), contacts->all(), problem,
      [&](int i, FrameLinearizer* linearizer, LinearizedFrame* out) {
        linearizer->FitContact(problem->frame(i), &(*contacts)[i],
                               StatesOf(*contacts), out);
      },
      visit);
}

void FitContactsRobustly(const std::vector<int>& frames,
                         CalibrationProblem* problem, ContactStore* contacts,
                         const FrameVisitor& visit) {
  for (const int i : frames) contacts->Forget(i);
  contacts->Guess(frames, ContactGuess::From::kAll);
  Plan robust = problem->plan();
  robust.loss = RobustLoss::kCauchy;
  robust.loss_scale = 1;
  VisitInOrder(
      frames, robust, contacts->all(), problem,
      [&](int i, FrameLinearizer* linearizer, LinearizedFrame* out) {
        std::array<double, 2> contact = (*contacts)[i];
        linearizer->FitContact(problem->frame(i), &contact, StatesOf(*contacts),
                               out);
      },
      visit);
}

}  // namespace finray
