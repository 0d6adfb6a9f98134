/// report.html: the page that viewer/ builds, with the data of a run in it.
#pragma once

#include <string>
#include <string_view>

namespace meshwind {

/// The page without data, as viewer/ built it; empty in a program that was built without it.
[[nodiscard]] std::string_view page_template();

/// The page with `data` (page_data.h) in it, packed by gzip as base64: one file that needs no
/// network. \pre page_template() is not empty
[[nodiscard]] std::string report_page(std::string_view data);

}  // namespace meshwind
