#include "cli/ending.h"

#include <algorithm>
#include <csignal>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "report/report_error.h"

namespace meshwind {
namespace {

int refused(const ErrorReport& error, bool json) {
    std::cerr << one_line("meshwind: " + error.words) << '\n';
    if (json) {
        std::cout << error_json(error);
    }
    return error.exit_code;
}

}  // namespace

int run_to_the_end(const std::function<int()>& run, std::span<const std::string> arguments) {
    const bool json = std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
    try {
        return run();
    } catch (const Interrupted&) {
        end_interrupted();
    } catch (const NumericalError& error) {
        return refused({error.code(), error.place(), error.what(), kInternalError}, json);
    } catch (const Error& error) {
        return refused({error.code(), error.place(), error.what(), kBadInput}, json);
    } catch (const std::filesystem::filesystem_error& error) {
        const std::string file = error.path1().string();
        return refused(
            {"io.file_system", file,
             file + ": " + error.code().message() + "; check the name and the rights", kBadInput},
            json);
    } catch (const std::bad_alloc&) {
        return refused({"internal.memory", "", "out of memory", kInternalError}, json);
    } catch (const std::exception& error) {
        return refused(
            {"internal.error", "", std::string("internal error: ") + error.what(), kInternalError},
            json);
    }
}

int shown(HeldOutput& output, int code) {
    const std::string reason = output.write_out();
    if (interrupt_requested() == SIGPIPE) {
        return kInterrupted + SIGPIPE;
    }
    if (reason.empty()) {
        return code;
    }
    return refused({"output.unwritable", "standard output",
                    "standard output: cannot be written (" + reason +
                        "); files that were named with -o are not concerned",
                    kInternalError},
                   false);
}

}  // namespace meshwind
