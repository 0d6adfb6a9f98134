/// Escapes text for XML, SVG and HTML.
#pragma once

#include <string>
#include <string_view>

namespace meshwind {

/// Escaped text that shows as `raw` between tags and in quoted attributes.
[[nodiscard]] std::string xml_text(std::string_view raw);

}  // namespace meshwind
