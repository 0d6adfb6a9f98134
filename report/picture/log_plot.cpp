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
constexpr double kMostDecades = 8.0;

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

class Drawing {
public:
    explicit Drawing(const LogPlot& plot) : plot_(plot), y_(plot.columns.size()) {
        assert(plot.panels.size() == plot.columns.size() * plot.rows.size());
        for (std::size_t p = 0; p < plot.panels.size(); ++p) {
            for (const PlotLine& line : plot.panels[p]) {
                for (const auto& [x, y] : line.points) {
                    if (y > 0.0) {
                        x_.take(x);
                        y_[p % plot.columns.size()].take(y);
                    }
                }
            }
        }
        x_ = {x_.low / kRoom, x_.high * kRoom};
        for (Range& y : y_) {  // whole decades
            const double top = std::ceil(std::log10(y.high));
            const double bottom = std::min(std::floor(std::log10(y.low)), top - 1.0);
            y = {std::pow(10.0, std::max(bottom, top - kMostDecades)), std::pow(10.0, top)};
        }
    }

    std::string text() {
        const double keys = kKeyLine * static_cast<double>(plot_.keys.size());
        top_ = kTop + keys;
        const auto columns = static_cast<double>(plot_.columns.size());
        const auto rows = static_cast<double>(plot_.rows.size());
        const double width = kLeft + columns * (kPanelWidth + kColumnGap) - kColumnGap + kRight;
        const double height = top_ + rows * (kPanelHeight + kRowGap) - kRowGap + kBottom;
        svg_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(width) + " " +
               number(height) + "\" width=\"" + number(width) + "\" height=\"" + number(height) +
               "\">\n" + kStyle + "<rect class=\"page\" width=\"100%\" height=\"100%\"/>\n";
        words(14.0, 24.0, "title", "start", plot_.title);
        legend();
        for (std::size_t c = 0; c < plot_.columns.size(); ++c) {
            words(left_of(c) + 0.5 * kPanelWidth, top_ - 10.0, "head", "middle", plot_.columns[c]);
        }
        for (std::size_t r = 0; r < plot_.rows.size(); ++r) {
            words(14.0, top_of(r) + 14.0, "head", "start", plot_.rows[r]);
            for (std::size_t c = 0; c < plot_.columns.size(); ++c) {
                panel(r, c);
            }
        }
        words(kLeft + 0.5 * (width - kLeft), height - 10.0, "head", "middle", plot_.x_label);
        return svg_ + "</svg>\n";
    }

private:
    static std::string number(double value) { return fixed(value, 1); }

    [[nodiscard]] double left_of(std::size_t column) const {
        return kLeft + static_cast<double>(column) * (kPanelWidth + kColumnGap);
    }
    [[nodiscard]] double top_of(std::size_t row) const {
        return top_ + static_cast<double>(row) * (kPanelHeight + kRowGap);
    }
    [[nodiscard]] double x_px(std::size_t column, double x) const {
        return left_of(column) + kPanelWidth * std::log(x / x_.low) / std::log(x_.high / x_.low);
    }
    [[nodiscard]] double y_px(std::size_t row, std::size_t column, double y) const {
        const Range& range = y_[column];
        return top_of(row) +
               kPanelHeight * std::log(range.high / y) / std::log(range.high / range.low);
    }

    void words(double x, double y, const char* kind, const char* anchor, const std::string& text) {
        svg_ += "<text class=\"" + std::string(kind) + "\" text-anchor=\"" + anchor + "\" x=\"" +
                number(x) + "\" y=\"" + number(y) + "\">" + xml_text(text) + "</text>\n";
    }

    void stroke(const std::string& kind, double x1, double y1, double x2, double y2) {
        svg_ += "<path class=\"" + kind + "\" d=\"M" + number(x1) + " " + number(y1) + "L" +
                number(x2) + " " + number(y2) + "\"/>\n";
    }

    static std::string class_of(const PlotStyle& style) {
        return "line c" + std::to_string(style.colour % kColours) + (style.dashed ? " dashed" : "");
    }

    void legend() {
        for (std::size_t k = 0; k < plot_.keys.size(); ++k) {
            const double y = 44.0 + kKeyLine * static_cast<double>(k);
            double x = 14.0;
            for (const PlotKey& key : plot_.keys[k]) {
                stroke(class_of(key.style), x, y - 4.0, x + 26.0, y - 4.0);
                words(x + 32.0, y, "key", "start", key.words);
                x += std::max(kKeyWidth, 50.0 + kCharacter * static_cast<double>(key.words.size()));
            }
        }
    }

    void panel(std::size_t r, std::size_t c) {
        const double left = left_of(c);
        const double top = top_of(r);
        const double bottom = top + kPanelHeight;
        if (!y_[c].empty() && std::isfinite(y_[c].low)) {
            axes(r, c);
        }
        svg_ += "<rect class=\"frame\" x=\"" + number(left) + "\" y=\"" + number(top) +
                "\" width=\"" + number(kPanelWidth) + "\" height=\"" + number(kPanelHeight) +
                "\"/>\n";
        const std::vector<PlotLine>& lines = plot_.panels[r * plot_.columns.size() + c];
        const std::string id = "panel" + std::to_string(r * plot_.columns.size() + c);
        svg_ += "<clipPath id=\"" + id + "\"><rect x=\"" + number(left) + "\" y=\"" + number(top) +
                "\" width=\"" + number(kPanelWidth) + "\" height=\"" + number(kPanelHeight) +
                "\"/></clipPath>\n<g clip-path=\"url(#" + id + ")\">\n";
        orders(r, c, lines, bottom);
        for (const PlotLine& line : lines) {
            draw(r, c, line);
        }
        svg_ += "</g>\n";
    }

    void axes(std::size_t r, std::size_t c) {
        const double left = left_of(c);
        const double bottom = top_of(r) + kPanelHeight;
        const int first = static_cast<int>(std::lround(std::log10(y_[c].low)));
        const int last = static_cast<int>(std::lround(std::log10(y_[c].high)));
        const int step = std::max(1, (last - first + 4) / 5);
        for (int decade = first; decade <= last; decade += step) {
            const double y = y_px(r, c, std::pow(10.0, decade));
            stroke("grid", left, y, left + kPanelWidth, y);
            words(left - 4.0, y + 3.0, "small", "end",
                  decade < -3 ? "1e" + std::to_string(decade)
                              : fixed(std::pow(10.0, decade), std::max(0, -decade)));
        }
        for (int decade = -3; decade <= 4; ++decade) {
            for (const int digit : {1, 2, 5}) {
                const double x = digit * std::pow(10.0, decade);
                if (x < x_.low || x > x_.high) {
                    continue;
                }
                stroke("grid", x_px(c, x), top_of(r), x_px(c, x), bottom);
                words(x_px(c, x), bottom + 11.0, "small", "middle", fixed(x, std::max(0, -decade)));
            }
        }
    }

    void orders(std::size_t r, std::size_t c, const std::vector<PlotLine>& lines, double bottom) {
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
        for (int order = 1; y > 0.0 && order <= kOrders; ++order) {
            // To the left edge or to the bottom, whichever is nearer.
            const double x_end =
                std::max(x_.low, x * std::pow(y_[c].low / y, 1.0 / static_cast<double>(order)));
            const double y_end = y * std::pow(x_end / x, order);
            const double px = x_px(c, x_end);
            const double py = std::min(y_px(r, c, y_end), bottom);
            stroke("order", x_px(c, x), y_px(r, c, y), px, py);
            words(px + 3.0, py - 3.0, "small", "start", std::to_string(order));
        }
    }

    void draw(std::size_t r, std::size_t c, const PlotLine& line) {
        const std::string dot = "<circle class=\"d" + std::to_string(line.style.colour % kColours) +
                                "\" r=\"2.2\" cx=\"";
        std::string path;
        std::string dots;
        for (const auto& [x, y] : line.points) {
            if (y > 0.0) {
                const std::string px = number(x_px(c, x));
                const std::string py = number(y_px(r, c, y));
                path.append(path.empty() ? "M" : "L").append(px).append(" ").append(py);
                dots.append(dot).append(px).append("\" cy=\"").append(py).append("\"/>\n");
            }
        }
        if (!path.empty()) {
            svg_ += "<path class=\"" + class_of(line.style) + "\" d=\"" + path + "\"/>\n" + dots;
        }
    }

    const LogPlot& plot_;
    Range x_;
    std::vector<Range> y_;  // per column
    double top_ = 0.0;
    std::string svg_;
};

}  // namespace

std::string log_plot_svg(const LogPlot& plot) {
    return Drawing(plot).text();
}

}  // namespace meshwind
