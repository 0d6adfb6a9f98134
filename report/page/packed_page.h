/// Packs data into the pages that viewer/ builds.
#pragma once

#include <string>
#include <string_view>

namespace meshwind {

/// The pages without data, as built by viewer/: of report.html, of `inspect --page`, and of
/// `strength`. Empty in a program that was built without them.
[[nodiscard]] std::string_view report_page_template();
[[nodiscard]] std::string_view part_page_template();
[[nodiscard]] std::string_view strength_page_template();

/// The page with `data` (page_arrays.h) in it, packed by gzip as base64: one file that needs no
/// network. \pre the page is not empty
[[nodiscard]] std::string packed_page(std::string_view page, std::string_view data);

}  // namespace meshwind
