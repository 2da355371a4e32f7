#ifndef FINRAY_RESIDUALS_PARALLEL_FRAMES_H_
#define FINRAY_RESIDUALS_PARALLEL_FRAMES_H_

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace finray {

/// Calls `visit(i, local)` for each i below `count`, on so many threads.
/// `local` is the thread's own copy of `prototype`.
template <class Local, class Visit>
void VisitInParallel(std::size_t count, int threads, const Local& prototype,
                     const Visit& visit) {
  tbb::enumerable_thread_specific<Local> locals(prototype);
  tbb::task_arena(threads).execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 16),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        Local& local = locals.local();
                        for (std::size_t i = range.begin(); i < range.end();
                             ++i) {
                          visit(i, &local);
                        }
                      });
  });
}

}  // namespace finray

#endif  // FINRAY_RESIDUALS_PARALLEL_FRAMES_H_
