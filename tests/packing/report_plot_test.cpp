#include "base/drawing/svg_plot.h"

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <sstream>

namespace scree {
namespace {

using testing::HasSubstr;
using testing::Not;

boost::property_tree::ptree parsed(const std::string& svg)
{
    boost::property_tree::ptree tree;
    std::istringstream stream(svg);
    boost::property_tree::read_xml(stream, tree);
    return tree;
}

Plot line_of(std::vector<double> x, std::vector<double> y)
{
    Plot plot;
    plot.series.push_back({"a < b & c", PlotSeries::Style::line, std::move(x), std::move(y), {}});
    return plot;
}

TEST(SvgPlot, IsWellFormedWithAnyText)
{
    Plot plot = line_of({0, 1, 2}, {3, 1, 2});
    plot.title = "<\"title\"> & \x01";
    plot.x_label = "x > 0";
    plot.marks = {{1, "a & b", false}, {2, "<c>", true}};
    const std::string svg = svg_of(plot);
    EXPECT_NO_THROW(parsed(svg));
    EXPECT_THAT(svg, HasSubstr("a &lt; b &amp; c"));
    EXPECT_THAT(svg, HasSubstr("x &gt; 0"));
}

TEST(SvgPlot, HasNoNumbersThatAreNone)
{
    const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
    for (const bool log : {false, true}) {
        for (const auto& ys : std::vector<std::vector<double>>{
                 {}, {0, 0, 0}, {nan, nan, nan}, {1, nan, inf}, {-1, 0, 1}, {1e-300, 1, 1e300}, {5, 5, 5}}) {
            Plot plot = line_of(ys.empty() ? std::vector<double>{} : std::vector<double>{0, 1, 2}, ys);
            plot.log_x = plot.log_y = log;
            for (const auto style : {PlotSeries::Style::line, PlotSeries::Style::dashes, PlotSeries::Style::dots,
                                     PlotSeries::Style::bars}) {
                plot.series[0].style = style;
                const std::string svg = svg_of(plot);
                EXPECT_NO_THROW(parsed(svg));
                EXPECT_EQ(svg.find("nan"), std::string::npos);
                EXPECT_EQ(svg.find("inf"), std::string::npos)
                    << svg.substr(svg.find("inf") < svg.size() ? svg.find("inf") - 80 : 0, 100);
                EXPECT_LT(svg.size(), 20000u);
            }
        }
    }
}

TEST(SvgPlot, PlacesValuesOnItsAxes)
{
    Plot plot;
    plot.x_range = {0, 10};
    plot.y_range = {0, 1};
    plot.series.push_back({"", PlotSeries::Style::dots, {0, 5, 10}, {0, 0.5, 1}, {}});
    const std::string svg = svg_of(plot);
    // The plot's area is 66 to 546 across, and 282 (bottom) to 14 (top).
    EXPECT_THAT(svg, HasSubstr("cx=\"66.00\" cy=\"282.00\""));
    EXPECT_THAT(svg, HasSubstr("cx=\"306.00\" cy=\"148.00\""));
    EXPECT_THAT(svg, HasSubstr("cx=\"546.00\" cy=\"14.00\""));
    EXPECT_THAT(svg, HasSubstr(">0.4</text>"));
}

TEST(SvgPlot, LogarithmicDecades)
{
    Plot plot = line_of({1e-3, 1, 1e3}, {1, 2, 3});
    plot.log_x = true;
    plot.x_range = {1e-3, 1e3};
    const std::string svg = svg_of(plot);
    EXPECT_THAT(svg, HasSubstr(">-3</tspan>"));
    EXPECT_THAT(svg, HasSubstr(">3</tspan>"));
    EXPECT_THAT(svg, HasSubstr("306.00 ")); // 1 is in the middle
}

TEST(SvgPlot, FewDecadesHaveLabelsOfTwoAndFive)
{
    Plot plot = line_of({0.01, 0.3}, {1, 2});
    plot.log_x = true;
    const std::string svg = svg_of(plot);
    for (const char* label : {">0.01<", ">0.02<", ">0.05<", ">0.2<"}) EXPECT_THAT(svg, HasSubstr(label));
    EXPECT_THAT(svg, Not(HasSubstr(">0.03<")));
}

TEST(SvgPlot, RingsAreDrawnOnTheEdgeWhereThereIsNoValue)
{
    Plot plot;
    plot.log_y = true;
    plot.series.push_back({"a", PlotSeries::Style::line, {1, 2, 3}, {1, 0.1, 0}, {}, {false, true, true}});
    std::string svg = svg_of(plot);
    const auto count = [&](const char* what) {
        size_t n = 0;
        for (size_t at = svg.find(what); at != std::string::npos; at = svg.find(what, at + 1)) ++n;
        return n;
    };
    EXPECT_EQ(count("<circle"), 3u);
    EXPECT_EQ(count("fill=\"#fff\""), 2u);
    EXPECT_THAT(svg, HasSubstr("cy=\"279.00\"")); // on the axis at 282
    EXPECT_EQ(count("dasharray"), 0u);
    for (int i = 0; i < 6; ++i) plot.series.push_back(plot.series[0]);
    svg = svg_of(plot);
    EXPECT_EQ(count("dasharray"), 2u); // the seventh, and its key
}

} // namespace
} // namespace scree
