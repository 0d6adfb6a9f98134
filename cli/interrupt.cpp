#include "cli/interrupt.h"

#include <array>
#include <atomic>
#include <csignal>
#include <deque>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include <unistd.h>

#include "core/interrupt.h"

namespace meshwind {
namespace {

// Far more than the files of any run; beyond these none is registered.
constexpr int kSlots = 1024;

// What a signal handler reads: no locks, no memory of its own. Names are never freed, so that one
// that is read is whole.
struct Registry {
    std::array<std::atomic<const char*>, kSlots> path{};
    std::atomic<int> unbroken{0};
    std::mutex mutex;  // of what follows; not the handler's
    std::deque<std::string> names;
};

Registry& registry() {
    static auto* const kOnly = new Registry;  // lives until the process ends, whoever ends it
    return *kOnly;
}

void end_at_once(int signal) {
    Registry& all = registry();
    for (int i = kSlots - 1; i >= 0; --i) {  // files before the folders they are in
        const char* path = all.path[static_cast<std::size_t>(i)].load();
        if (path != nullptr && ::unlink(path) != 0) {
            ::rmdir(path);
        }
    }
    constexpr std::string_view kWords = "\nmeshwind: ended at once\n";
    (void)!::write(STDERR_FILENO, kWords.data(), kWords.size());
    ::_exit(128 + signal);
}

void on_signal(int signal) {
    if (interrupt_requested() == 0) {
        request_interrupt(signal);
    } else if (registry().unbroken.load() == 0) {
        end_at_once(signal);
    }
}

}  // namespace

void end_on_signals() {
    (void)registry();  // made here, not by the handler
    for (const int signal : {SIGINT, SIGTERM}) {
        struct sigaction before {};
        ::sigaction(signal, nullptr, &before);
        if (before.sa_handler == SIG_IGN) {
            continue;
        }
        struct sigaction action {};
        action.sa_handler = on_signal;
        action.sa_flags = SA_RESTART;
        ::sigemptyset(&action.sa_mask);
        ::sigaction(signal, &action, nullptr);
    }
}

Temporary::Temporary(const std::filesystem::path& path) {
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    for (int i = kSlots - 1; i >= 0 && all.path[static_cast<std::size_t>(i)].load() == nullptr;
         --i) {
        slot_ = i;  // above all that are taken
    }
    if (slot_ >= 0) {
        all.names.push_back(path.string());
        all.path[static_cast<std::size_t>(slot_)].store(all.names.back().c_str());
    }
}

Temporary::~Temporary() {
    if (slot_ >= 0) {
        registry().path[static_cast<std::size_t>(slot_)].store(nullptr);
    }
}

Temporary::Temporary(Temporary&& other) noexcept : slot_(std::exchange(other.slot_, -1)) {}

Temporary& Temporary::operator=(Temporary&& other) noexcept {
    std::swap(slot_, other.slot_);
    return *this;
}

Unbroken::Unbroken() {
    ++registry().unbroken;
}

Unbroken::~Unbroken() {
    --registry().unbroken;
}

}  // namespace meshwind
