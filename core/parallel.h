/// Parallel loops whose result does not depend on the number of threads.
#pragma once

#include <cstddef>
#include <functional>

namespace meshwind {

/// Number of threads that parallel loops use from here on; 0 means one per core.
/// \pre no parallel loop is running
void set_thread_count(int threads);

/// Makes every further worker thread of parallel loops call `enter` when it begins. Call it once in
/// a process.
void on_worker_start(void (*enter)());

/// Calls `body(begin, end)` on consecutive chunks of [0, count), each at most `chunk` long.
/// The chunks depend on `count` and `chunk` alone; a body that writes only to its own indices gives
/// the same bytes for any number of threads. Exceptions of the bodies reach the caller. Each chunk
/// is a cancellation point (core/interrupt.h). \throws Interrupted
void parallel_for(std::size_t count, std::size_t chunk,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace meshwind
