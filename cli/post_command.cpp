#include "cli/post_command.h"

#include "cli/project_files.h"

namespace meshwind {

WindRequest wind_request(const PostOptions& options) {
    WindRequest request;
    request.mandrel = find_input(options.mandrel);
    request.machine = find_input(options.machine);
    request.job = options.job.empty() ? std::filesystem::path() : find_input(options.job);
    request.out = options.out;
    request.import = ImportRequest{.points = options.points,
                                   .mandrel_frame = options.frame == "mandrel",
                                   .farthest_mm = options.within_mm};
    return request;
}

}  // namespace meshwind
