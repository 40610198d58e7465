#include "svg_figure.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace topple::app {

namespace {

constexpr double width = 460, height = 260, left = 76, right = 14, top = 12, bottom = 44;

/// Round numbers within a range, five or so.
std::vector<double> ticks(const std::array<double, 2>& range) {
  const double rough = (range[1] - range[0]) / 5, power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= rough) {
      step = factor * power;
      break;
    }
  std::vector<double> result;
  const double slack = 1e-9 * step;
  for (double at = std::ceil(range[0] / step - 1e-9) * step; at <= range[1] + slack; at += step)
    result.push_back(std::abs(at) < slack ? 0 : at);
  return result;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

std::array<double, 2> widened(std::array<double, 2> range) {
  if (range[1] > range[0]) return range;
  const double by = range[0] == 0 ? 1 : 0.1 * std::abs(range[0]);
  return {range[0] - by, range[0] + by};
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else if (c == '\'')
      result += "&#39;";
    else
      result += c;
  }
  return result;
}

std::string short_text(double value) {
  if (!std::isfinite(value)) return "no number";
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

SvgFigure::SvgFigure(std::string x_label, std::string y_label, std::array<double, 2> x, std::array<double, 2> y)
    : x_label_(std::move(x_label)), y_label_(std::move(y_label)), x_(widened(x)), y_(widened(y)) {}

double SvgFigure::at_x(double x) const { return left + (x - x_[0]) / (x_[1] - x_[0]) * (width - left - right); }
double SvgFigure::at_y(double y) const {
  return height - bottom - (std::clamp(y, y_[0], y_[1]) - y_[0]) / (y_[1] - y_[0]) * (height - top - bottom);
}

void SvgFigure::bar(double from, double to, double tall, const char* colour) {
  body_ += "<rect x='" + number(at_x(from)) + "' y='" + number(at_y(tall)) + "' width='" +
           number(std::max(0.5, at_x(to) - at_x(from) - 0.6)) + "' height='" + number(at_y(y_[0]) - at_y(tall)) +
           "' fill='" + colour + "'/>\n";
}

void SvgFigure::line(const Points& points, const char* colour, bool dashed) {
  body_ += "<polyline fill='none' stroke-width='1.6' stroke='" + std::string(colour) + "'" +
           (dashed ? " stroke-dasharray='5 4'" : "") + " points='";
  for (const auto& [x, y] : points) body_ += number(at_x(x)) + "," + number(at_y(y)) + " ";
  body_ += "'/>\n";
}

void SvgFigure::band(const Points& low, const Points& high, const char* colour) {
  body_ += "<polygon fill-opacity='0.25' fill='" + std::string(colour) + "' points='";
  for (const auto& [x, y] : low) body_ += number(at_x(x)) + "," + number(at_y(y)) + " ";
  for (std::size_t i = high.size(); i-- > 0;)
    body_ += number(at_x(high[i].first)) + "," + number(at_y(high[i].second)) + " ";
  body_ += "'/>\n";
}

void SvgFigure::vertical(double x, const char* colour, bool dashed) { line({{x, y_[0]}, {x, y_[1]}}, colour, dashed); }

void SvgFigure::mark(double x, double y, double low, double high, const char* colour) {
  line({{x, low}, {x, high}}, colour);
  body_ += "<circle r='3' cx='" + number(at_x(x)) + "' cy='" + number(at_y(y)) + "' fill='" + colour + "'/>\n";
}

std::string SvgFigure::svg() const {
  std::string text = "<svg viewBox='0 0 460 260' role='img'>\n<rect x='" + number(left) + "' y='" + number(top) +
                     "' width='" + number(width - left - right) + "' height='" + number(height - top - bottom) +
                     "' fill='none' stroke='#999'/>\n";
  for (const double x : ticks(x_))
    text += "<line x1='" + number(at_x(x)) + "' x2='" + number(at_x(x)) + "' y1='" + number(height - bottom) +
            "' y2='" + number(height - bottom + 4) + "' stroke='#999'/><text text-anchor='middle' x='" +
            number(at_x(x)) + "' y='" + number(height - bottom + 17) + "'>" + short_text(x) + "</text>\n";
  for (const double y : ticks(y_))
    text += "<line x1='" + number(left) + "' x2='" + number(width - right) + "' y1='" + number(at_y(y)) + "' y2='" +
            number(at_y(y)) + "' stroke='#e4e4e4'/><text text-anchor='end' x='" + number(left - 5) + "' y='" +
            number(at_y(y) + 4) + "'>" + short_text(y) + "</text>\n";
  text += body_;
  text += "<text text-anchor='middle' x='" + number((left + width - right) / 2) + "' y='" + number(height - 8) + "'>" +
          escaped(x_label_) + "</text>\n<text text-anchor='middle' transform='translate(13 " +
          number((top + height - bottom) / 2) + ") rotate(-90)'>" + escaped(y_label_) + "</text>\n</svg>\n";
  return text;
}

}  // namespace topple::app
