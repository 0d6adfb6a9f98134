/// Small multiples on logarithmic axes as SVG text.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace meshwind {

/// Style of a line: colours count from 0 and repeat after six.
struct PlotStyle {
    int colour = 0;
    bool dashed = false;
};

struct PlotLine {
    PlotStyle style;
    std::vector<std::pair<double, double>> points;  ///< x > 0; points with y <= 0 are left out
};

struct PlotKey {
    PlotStyle style;
    std::string words;
};

/// A table of panels. One x axis for all; one y axis for each column, of eight decades at most:
/// lower values leave their panel.
struct LogPlot {
    std::string title;
    std::string x_label;
    std::vector<std::string> columns;           ///< heads, with the unit of y
    std::vector<std::string> rows;              ///< heads
    std::vector<std::vector<PlotLine>> panels;  ///< rows x columns, row by row
    std::vector<std::vector<PlotKey>> keys;     ///< one line of the legend each
};

/// Dotted lines in each panel show orders 1 to 4 from its largest error down. Readable on light
/// and dark pages. The same plot gives the same bytes. \pre panels.size() == rows x columns
[[nodiscard]] std::string log_plot_svg(const LogPlot& plot);

}  // namespace meshwind
