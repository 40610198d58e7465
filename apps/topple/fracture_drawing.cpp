#include "fracture_drawing.h"

#include <algorithm>
#include <cstdio>

namespace topple::app {

namespace {

using fracture::Polygon;
using fracture::Vec2;

constexpr double kPixels = 900;  ///< width of the drawing
constexpr double kMargin = 12;   ///< around it, pixels

class Canvas {
 public:
  Canvas(const Vec2& lower, const Vec2& upper)
      : lower_(lower), upper_(upper), scale_((kPixels - 2 * kMargin) / std::max(1e-300, (upper - lower).x())) {}

  [[nodiscard]] double height() const { return (upper_ - lower_).y() * scale_ + 2 * kMargin; }
  [[nodiscard]] Vec2 to_picture(const Vec2& point) const {
    return {kMargin + (point.x() - lower_.x()) * scale_, kMargin + (upper_.y() - point.y()) * scale_};
  }
  template <class Points>
  [[nodiscard]] std::string path(const Points& points) const {
    std::string text;
    for (const Vec2& point : points) {
      const Vec2 at = to_picture(point);
      char buffer[64];
      std::snprintf(buffer, sizeof buffer, "%c%.2f %.2f", text.empty() ? 'M' : 'L', at.x(), at.y());
      text += buffer;
    }
    return text + "Z";
  }

 private:
  Vec2 lower_, upper_;
  double scale_;
};

/// Neighbours in number get colours far apart: steps of the golden angle round the colour wheel.
std::string colour(std::size_t number, bool hit) {
  const int hue = static_cast<int>(static_cast<double>(number) * 137.508) % 360;
  return "hsl(" + std::to_string(hue) + (hit ? ",45%,58%)" : ",35%,80%)");
}

}  // namespace

std::string pattern_svg(const structure::PanelFile& file, const fracture::BreakablePanel& panel,
                        const std::vector<fracture::Chunk>& chunks) {
  Vec2 lower = file.shape.outline.front(), upper = lower;
  for (const Vec2& corner : file.shape.outline) {
    lower = lower.cwiseMin(corner);
    upper = upper.cwiseMax(corner);
  }
  const Canvas canvas(lower, upper);
  char head[160];
  std::snprintf(head, sizeof head,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 %.0f %.0f\">\n",
                kPixels, canvas.height(), kPixels, canvas.height());
  std::string text = head;
  text +=
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n<path fill=\"#b9b4aa\" stroke=\"#b9b4aa\" "
      "stroke-width=\"0.6\" d=\"";
  for (const auto& triangle : panel.triangles()) text += canvas.path(triangle);
  text += "\"/>\n<g stroke=\"#3a3733\" stroke-width=\"0.8\" stroke-linejoin=\"round\">\n";
  for (std::size_t i = 0; i < chunks.size(); ++i)
    text += "<path fill=\"" + colour(i, chunks[i].hit) + "\" d=\"" + canvas.path(chunks[i].outline) + "\"/>\n";
  text += "</g>\n<g fill=\"none\" stroke=\"#3a3733\" stroke-width=\"1.6\">\n<path d=\"" +
          canvas.path(file.shape.outline) + "\"/>\n";
  for (const Polygon& opening : file.shape.openings) text += "<path d=\"" + canvas.path(opening) + "\"/>\n";
  text += "</g>\n<g stroke=\"#c00000\" stroke-width=\"2\">\n";
  for (const structure::PanelHit& hit : file.hits) {
    const Vec2 at = canvas.to_picture(hit.at);
    char cross[200];
    std::snprintf(cross, sizeof cross, "<path d=\"M%.2f %.2fl10 10m0 -10l-10 10\"/>\n", at.x() - 5, at.y() - 5);
    text += cross;
  }
  return text + "</g>\n</svg>\n";
}

}  // namespace topple::app
