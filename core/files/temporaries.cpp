#include "core/files/temporaries.h"

#include <string>
#include <system_error>
#include <utility>

#include <unistd.h>

namespace meshwind {
namespace {

// A name to be removed. Entries are never freed, so that a handler that reads one finds it whole.
struct Entry {
    std::string path;
    std::atomic<bool> registered{true};
    Entry* older = nullptr;
};

// What a signal handler reads and writes: no locks, no memory of its own.
struct State {
    std::atomic<Entry*> newest{nullptr};
    std::atomic<int> unbroken{0};
};

State& state() noexcept {
    static constinit State only;
    return only;
}

}  // namespace

bool remove_temporaries() noexcept {
    if (state().unbroken.load() != 0) {
        return false;
    }
    // Newest first: files come before the folders they are in.
    for (const Entry* entry = state().newest.load(); entry != nullptr; entry = entry->older) {
        if (entry->registered.load() && ::unlink(entry->path.c_str()) != 0) {
            ::rmdir(entry->path.c_str());
        }
    }
    return true;
}

Temporary::Temporary(const std::filesystem::path& path) {
    auto* const entry = new Entry{.path = path.string()};
    entry->older = state().newest.load();
    while (!state().newest.compare_exchange_weak(entry->older, entry)) {
    }
    registered_ = &entry->registered;
}

Temporary::~Temporary() {
    if (registered_ != nullptr) {
        registered_->store(false);
    }
}

Temporary::Temporary(Temporary&& other) noexcept
    : registered_(std::exchange(other.registered_, nullptr)) {}

Temporary& Temporary::operator=(Temporary&& other) noexcept {
    std::swap(registered_, other.registered_);
    return *this;
}

RemovedInTheEnd::RemovedInTheEnd(std::filesystem::path file)
    : file_(std::move(file)), registered_(file_) {}

RemovedInTheEnd::~RemovedInTheEnd() {
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
}

Unbroken::Unbroken() {
    ++state().unbroken;
}

Unbroken::~Unbroken() {
    --state().unbroken;
}

}  // namespace meshwind
