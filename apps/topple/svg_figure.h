#pragma once
// Figures of the study's page as SVG: axes with round numbers, bars, lines, bands. Plain text that prints.
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace topple::app {

/// The text for HTML and SVG.
[[nodiscard]] std::string escaped(std::string_view text);
/// Four digits, as a person reads a number.
[[nodiscard]] std::string short_text(double value);

class SvgFigure {
 public:
  using Points = std::vector<std::pair<double, double>>;
  /// The ranges of both axes; the y axis begins at 0 where `from_zero` is.
  SvgFigure(std::string x_label, std::string y_label, std::array<double, 2> x, std::array<double, 2> y);
  void bar(double from, double to, double height, const char* colour);
  void line(const Points& points, const char* colour, bool dashed = false);
  void band(const Points& low, const Points& high, const char* colour);
  void vertical(double x, const char* colour, bool dashed);
  /// A point with its interval.
  void mark(double x, double y, double low, double high, const char* colour);
  [[nodiscard]] std::string svg() const;

 private:
  [[nodiscard]] double at_x(double x) const;
  [[nodiscard]] double at_y(double y) const;
  std::string x_label_, y_label_, body_;
  std::array<double, 2> x_, y_;
};

}  // namespace topple::app
