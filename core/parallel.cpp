#include "core/parallel.h"

#include <algorithm>
#include <memory>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_scheduler_observer.h>

#include "core/interrupt.h"

namespace meshwind {
namespace {

class WorkerStart : public tbb::task_scheduler_observer {
public:
    explicit WorkerStart(void (*enter)()) : enter_(enter) { observe(true); }

    void on_scheduler_entry(bool worker) override {
        thread_local bool entered = false;
        if (worker && !entered) {
            entered = true;
            enter_();
        }
    }

private:
    void (*enter_)();
};

}  // namespace

void on_worker_start(void (*enter)()) {
    static auto* const kOnly = new WorkerStart(enter);  // as long as the workers
    (void)kOnly;
}

void set_thread_count(int threads) {
    static std::unique_ptr<tbb::global_control> control;
    control.reset();
    if (threads > 0) {
        control = std::make_unique<tbb::global_control>(
            tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    }
}

void parallel_for(std::size_t count, std::size_t chunk,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
    const std::size_t chunks = (count + chunk - 1) / chunk;
    check_interrupt();
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
        check_interrupt();
        body(c * chunk, std::min(count, (c + 1) * chunk));
    });
}

}  // namespace meshwind
