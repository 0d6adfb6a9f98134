#include "report/picture/log_plot.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/text/text_number.h"
#include "core/text/xml_text.h"

namespace meshwind {
namespace {

// Pixels of the drawing.
constexpr double kPanelWidth = 172.0;
constexpr double kPanelHeight = 150.0;
constexpr double kColumnGap = 46.0;
constexpr double kRowGap = 34.0;
constexpr double kLeft = 122.0;
constexpr double kTop = 62.0;
constexpr double kRight = 14.0;
constexpr double kBottom = 46.0;
constexpr double kKeyLine = 18.0;
constexpr double kKeyWidth = 158.0;
constexpr double kCharacter = 5.6;  // mean width of a letter of 11 px

// Free room left and right of the outermost points, as a factor of x.
constexpr double kRoom = 1.25;

constexpr int kOrders = 4;
constexpr double kMaxDecades = 8.0;

// Colours that can be told apart by most eyes, on white and on black: those of Okabe and Ito.
constexpr const char* kStyle =
    "<style>"
    "text{font:11px sans-serif;fill:#24292f}.head{font-weight:bold}"
    ".title{font:bold 14px sans-serif}.small{font-size:9px;fill:#6e7781}"
    ".page{fill:#ffffff}.frame{fill:none;stroke:#8c959f}.grid{stroke:#d8dee4}"
    ".order{stroke:#8c959f;stroke-dasharray:1 3;fill:none}"
    ".line{fill:none;stroke-width:1.8}.dashed{stroke-dasharray:6 3}"
    ".c0{stroke:#0072b2}.c1{stroke:#d55e00}.c2{stroke:#009e73}"
    ".c3{stroke:#cc79a7}.c4{stroke:#b07800}.c5{stroke:#7b5ea7}"
    ".d0{fill:#0072b2}.d1{fill:#d55e00}.d2{fill:#009e73}"
    ".d3{fill:#cc79a7}.d4{fill:#b07800}.d5{fill:#7b5ea7}"
    "@media (prefers-color-scheme:dark){text{fill:#d1d7de}.small{fill:#9198a1}"
    ".page{fill:#0d1117}.grid{stroke:#262c36}.frame,.order{stroke:#656c76}"
    ".c0{stroke:#4aa3df}.d0{fill:#4aa3df}.c4{stroke:#e0a020}.d4{fill:#e0a020}"
    ".c5{stroke:#a98bd8}.d5{fill:#a98bd8}}"
    "</style>\n";
constexpr int kColours = 6;

struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = 0.0;

    void take(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    [[nodiscard]] bool empty() const { return !(high > 0.0); }
};

// What the axes span.
struct PlotRanges {
    Range x;
    std::vector<Range> y;  // per column, whole decades
};

PlotRanges ranges_of(const LogPlot& plot) {
    PlotRanges ranges{.x = {}, .y = std::vector<Range>(plot.columns.size())};
    for (std::size_t p = 0; p < plot.panels.size(); ++p) {
        for (const PlotLine& line : plot.panels[p]) {
            for (const auto& [x, y] : line.points) {
                if (y > 0.0) {
                    ranges.x.take(x);
                    ranges.y[p % plot.columns.size()].take(y);
                }
            }
        }
    }
    ranges.x = {ranges.x.low / kRoom, ranges.x.high * kRoom};
    for (Range& y : ranges.y) {  // whole decades
        const double top = std::ceil(std::log10(y.high));
        const double bottom = std::min(std::floor(std::log10(y.low)), top - 1.0);
        y = {std::pow(10.0, std::max(bottom, top - kMaxDecades)), std::pow(10.0, top)};
    }
    return ranges;
}

// Where a panel is in the drawing, px, and what its axes span.
struct Panel {
    double left = 0.0;
    double top = 0.0;
    Range x;
    Range y;

    [[nodiscard]] double bottom() const { return top + kPanelHeight; }
    [[nodiscard]] double x_px(double value) const {
        return left + kPanelWidth * std::log(value / x.low) / std::log(x.high / x.low);
    }
    [[nodiscard]] double y_px(double value) const {
        return top + kPanelHeight * std::log(y.high / value) / std::log(y.high / y.low);
    }
};

double left_of(std::size_t column) {
    return kLeft + static_cast<double>(column) * (kPanelWidth + kColumnGap);
}

double top_of(std::size_t row, double top) {
    return top + static_cast<double>(row) * (kPanelHeight + kRowGap);
}

std::string px_text(double value) {
    return fixed(value, 1);
}

std::string words_svg(double x, double y, const char* kind, const char* anchor,
                      const std::string& text) {
    return "<text class=\"" + std::string(kind) + "\" text-anchor=\"" + anchor + "\" x=\"" +
           px_text(x) + "\" y=\"" + px_text(y) + "\">" + xml_text(text) + "</text>\n";
}

std::string stroke_svg(const std::string& kind, double x1, double y1, double x2, double y2) {
    return "<path class=\"" + kind + "\" d=\"M" + px_text(x1) + " " + px_text(y1) + "L" +
           px_text(x2) + " " + px_text(y2) + "\"/>\n";
}

std::string line_class(const PlotStyle& style) {
    return "line c" + std::to_string(style.colour % kColours) + (style.dashed ? " dashed" : "");
}

std::string legend_svg(const LogPlot& plot) {
    std::string svg;
    for (std::size_t k = 0; k < plot.keys.size(); ++k) {
        const double y = 44.0 + kKeyLine * static_cast<double>(k);
        double x = 14.0;
        for (const PlotKey& key : plot.keys[k]) {
            svg += stroke_svg(line_class(key.style), x, y - 4.0, x + 26.0, y - 4.0);
            svg += words_svg(x + 32.0, y, "key", "start", key.words);
            x += std::max(kKeyWidth, 50.0 + kCharacter * static_cast<double>(key.words.size()));
        }
    }
    return svg;
}

std::string axes_svg(const Panel& panel) {
    std::string svg;
    const int first = static_cast<int>(std::lround(std::log10(panel.y.low)));
    const int last = static_cast<int>(std::lround(std::log10(panel.y.high)));
    const int step = std::max(1, (last - first + 4) / 5);
    for (int decade = first; decade <= last; decade += step) {
        const double y = panel.y_px(std::pow(10.0, decade));
        svg += stroke_svg("grid", panel.left, y, panel.left + kPanelWidth, y);
        svg += words_svg(panel.left - 4.0, y + 3.0, "small", "end",
                         decade < -3 ? "1e" + std::to_string(decade)
                                     : fixed(std::pow(10.0, decade), std::max(0, -decade)));
    }
    for (int decade = -3; decade <= 4; ++decade) {
        for (const int digit : {1, 2, 5}) {
            const double x = digit * std::pow(10.0, decade);
            if (x < panel.x.low || x > panel.x.high) {
                continue;
            }
            const double px = panel.x_px(x);
            svg += stroke_svg("grid", px, panel.top, px, panel.bottom());
            svg += words_svg(px, panel.bottom() + 11.0, "small", "middle",
                             fixed(x, std::max(0, -decade)));
        }
    }
    return svg;
}

// Slopes of the orders of convergence, from the highest point of the lines.
std::string orders_svg(const Panel& panel, const std::vector<PlotLine>& lines) {
    double x = 0.0;
    double y = 0.0;
    for (const PlotLine& line : lines) {
        for (const auto& point : line.points) {
            if (point.second > y) {
                x = point.first;
                y = point.second;
            }
        }
    }
    std::string svg;
    for (int order = 1; y > 0.0 && order <= kOrders; ++order) {
        // To the left edge or to the bottom, whichever is nearer.
        const double x_end =
            std::max(panel.x.low, x * std::pow(panel.y.low / y, 1.0 / static_cast<double>(order)));
        const double y_end = y * std::pow(x_end / x, order);
        const double px = panel.x_px(x_end);
        const double py = std::min(panel.y_px(y_end), panel.bottom());
        svg += stroke_svg("order", panel.x_px(x), panel.y_px(y), px, py);
        svg += words_svg(px + 3.0, py - 3.0, "small", "start", std::to_string(order));
    }
    return svg;
}

std::string line_svg(const Panel& panel, const PlotLine& line) {
    const std::string dot =
        "<circle class=\"d" + std::to_string(line.style.colour % kColours) + "\" r=\"2.2\" cx=\"";
    std::string path;
    std::string dots;
    for (const auto& [x, y] : line.points) {
        if (y > 0.0) {
            const std::string px = px_text(panel.x_px(x));
            const std::string py = px_text(panel.y_px(y));
            path.append(path.empty() ? "M" : "L").append(px).append(" ").append(py);
            dots.append(dot).append(px).append("\" cy=\"").append(py).append("\"/>\n");
        }
    }
    return path.empty()
               ? path
               : "<path class=\"" + line_class(line.style) + "\" d=\"" + path + "\"/>\n" + dots;
}

// \param number of the panel in the plot
std::string panel_svg(const Panel& panel, const std::vector<PlotLine>& lines, std::size_t number) {
    std::string svg;
    if (!panel.y.empty() && std::isfinite(panel.y.low)) {
        svg += axes_svg(panel);
    }
    const std::string box = "x=\"" + px_text(panel.left) + "\" y=\"" + px_text(panel.top) +
                            "\" width=\"" + px_text(kPanelWidth) + "\" height=\"" +
                            px_text(kPanelHeight) + "\"/>";
    const std::string id = "panel" + std::to_string(number);
    svg += "<rect class=\"frame\" " + box + "\n";
    svg += "<clipPath id=\"" + id + "\"><rect " + box + "</clipPath>\n<g clip-path=\"url(#" + id +
           ")\">\n";
    svg += orders_svg(panel, lines);
    for (const PlotLine& line : lines) {
        svg += line_svg(panel, line);
    }
    return svg + "</g>\n";
}

// Heads of the columns, and the rows. \param top px, of the first row
std::string panels_svg(const LogPlot& plot, double top) {
    const PlotRanges ranges = ranges_of(plot);
    const std::size_t columns = plot.columns.size();
    std::string svg;
    for (std::size_t c = 0; c < columns; ++c) {
        svg += words_svg(left_of(c) + 0.5 * kPanelWidth, top - 10.0, "head", "middle",
                         plot.columns[c]);
    }
    for (std::size_t r = 0; r < plot.rows.size(); ++r) {
        svg += words_svg(14.0, top_of(r, top) + 14.0, "head", "start", plot.rows[r]);
        for (std::size_t c = 0; c < columns; ++c) {
            const std::size_t number = r * columns + c;
            svg += panel_svg({left_of(c), top_of(r, top), ranges.x, ranges.y[c]},
                             plot.panels[number], number);
        }
    }
    return svg;
}

}  // namespace

std::string log_plot_svg(const LogPlot& plot) {
    assert(plot.panels.size() == plot.columns.size() * plot.rows.size());
    const double top = kTop + kKeyLine * static_cast<double>(plot.keys.size());
    const auto columns = static_cast<double>(plot.columns.size());
    const auto rows = static_cast<double>(plot.rows.size());
    const double width = kLeft + columns * (kPanelWidth + kColumnGap) - kColumnGap + kRight;
    const double height = top + rows * (kPanelHeight + kRowGap) - kRowGap + kBottom;
    std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + px_text(width) +
                      " " + px_text(height) + "\" width=\"" + px_text(width) + "\" height=\"" +
                      px_text(height) + "\">\n" + kStyle +
                      "<rect class=\"page\" width=\"100%\" height=\"100%\"/>\n";
    svg += words_svg(14.0, 24.0, "title", "start", plot.title);
    svg += legend_svg(plot);
    svg += panels_svg(plot, top);
    svg += words_svg(kLeft + 0.5 * (width - kLeft), height - 10.0, "head", "middle", plot.x_label);
    return svg + "</svg>\n";
}

}  // namespace meshwind
