// SPDX-License-Identifier: Apache-2.0
#include "kompono/analysis/zone_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kompono::analysis {
namespace {

constexpr double kPanel = 360.0;  // px
constexpr double kMargin = 56.0;  // px
constexpr double kTitle = 28.0;   // px

double Outward(bool rotary, double value) {
  return rotary ? value * 180.0 / std::numbers::pi : value;
}

std::string Escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  }
  return out;
}

/// A round step that gives about five marks.
double TickStep(double extent) {
  const double raw = extent / 5.0;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (raw <= factor * power) return factor * power;
  }
  return 10.0 * power;
}

/// From millimetres to the panel.
struct Frame {
  double left = 0.0, top = 0.0, scale = 1.0;
  std::array<double, 2> lower{}, upper{};
  [[nodiscard]] double X(double x) const { return left + (x - lower[0]) * scale; }
  [[nodiscard]] double Y(double y) const { return top + (upper[1] - y) * scale; }
};

std::string Axes(const ZonePicture& picture, const Frame& frame) {
  const double bottom = frame.Y(frame.lower[1]);
  std::string out =
      fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' class='frame'/>\n",
                  frame.left,
                  frame.Y(frame.upper[1]),
                  (frame.upper[0] - frame.lower[0]) * frame.scale,
                  (frame.upper[1] - frame.lower[1]) * frame.scale);
  for (std::size_t i = 0; i < 2; ++i) {
    const double step = TickStep(frame.upper[i] - frame.lower[i]);
    const double first = std::ceil(frame.lower[i] / step) * step;
    const int marks = static_cast<int>((frame.upper[i] - first) / step + 1e-9) + 1;
    for (int mark = 0; mark < marks; ++mark) {
      const double at = first + mark * step;
      const double value = std::abs(at) < 1e-9 * step ? 0.0 : at;
      if (i == 0) {
        out += fmt::format("<text x='{:.1f}' y='{:.1f}' class='x'>{:g}</text>\n",
                           frame.X(at),
                           bottom + 16.0,
                           value);
      } else {
        out += fmt::format("<text x='{:.1f}' y='{:.1f}' class='y'>{:g}</text>\n",
                           frame.left - 5.0,
                           frame.Y(at) + 4.0,
                           value);
      }
    }
  }
  out += fmt::format("<text x='{:.1f}' y='{:.1f}' class='x'>{}</text>\n",
                     frame.X(0.5 * (frame.lower[0] + frame.upper[0])),
                     bottom + 34.0,
                     Escaped(picture.horizontal));
  out += fmt::format("<text x='{:.1f}' y='{:.1f}' class='t'>{} upwards: {}</text>\n",
                     frame.left,
                     frame.top - 8.0,
                     Escaped(picture.title),
                     Escaped(picture.vertical));
  return out;
}

std::string Map(const ZonePicture& picture, const Frame& frame) {
  std::string out;
  const double span = picture.best - picture.worst;
  for (const std::array<double, 5>& cell : picture.map) {
    const double share = span != 0.0 ? std::clamp((cell[4] - picture.worst) / span, 0.0, 1.0) : 1.0;
    out += fmt::format(
        "<rect x='{:.1f}' y='{:.1f}' width='{:.2f}' height='{:.2f}' fill='hsl({:.0f} 70% {:.0f}%)'>"
        "<title>{:.4g}</title></rect>\n",
        frame.X(cell[0]),
        frame.Y(cell[1] + cell[3]),
        cell[2] * frame.scale + 0.3,
        cell[3] * frame.scale + 0.3,
        20.0 + 180.0 * share,
        35.0 + 40.0 * share,
        cell[4]);
  }
  return out;
}

std::string Rectangles(const std::vector<std::array<double, 4>>& list,
                       const Frame& frame,
                       const char* style) {
  std::string out;
  for (const std::array<double, 4>& r : list) {
    out += fmt::format("<rect x='{:.2f}' y='{:.2f}' width='{:.2f}' height='{:.2f}' class='{}'/>\n",
                       frame.X(r[0]),
                       frame.Y(r[1] + r[3]),
                       std::max(0.6, r[2] * frame.scale),
                       std::max(0.6, r[3] * frame.scale),
                       style);
  }
  return out;
}

std::string Panel(const ZonePicture& picture, double left) {
  Frame frame{
      .left = left + kMargin, .top = kTitle, .lower = picture.lower, .upper = picture.upper};
  const double width = std::max(1e-9, frame.upper[0] - frame.lower[0]);
  const double height = std::max(1e-9, frame.upper[1] - frame.lower[1]);
  frame.scale = std::min((kPanel - kMargin) / width, kPanel / height);
  std::string out = Axes(picture, frame) + Map(picture, frame);
  for (const auto& loop : picture.outline) {
    out += "<path class='zone' d='";
    for (std::size_t k = 0; k < loop.size(); ++k)
      out += fmt::format(
          "{}{:.2f} {:.2f}", k == 0 ? "M" : "L", frame.X(loop[k][0]), frame.Y(loop[k][1]));
    out += "Z'/>\n";
  }
  out += Rectangles(picture.singular, frame, "singular");
  out += Rectangles(picture.boxes, frame, "body");
  for (const std::array<double, 3>& disc : picture.discs) {
    out += fmt::format("<circle cx='{:.2f}' cy='{:.2f}' r='{:.2f}' class='body'/>\n",
                       frame.X(disc[0]),
                       frame.Y(disc[1]),
                       0.5 * disc[2] * frame.scale);
  }
  return out;
}

}  // namespace

std::string SurfacePly(const ZoneSurface& surface, const std::string& comment) {
  std::string line;  // a comment is one line
  for (const char c : comment) line += c == '\n' || c == '\r' ? ' ' : c;
  std::string out = fmt::format(
      "ply\nformat ascii 1.0\ncomment {}\ncomment millimetres\nelement vertex {}\n"
      "property double x\nproperty double y\nproperty double z\nelement face {}\n"
      "property list uchar int vertex_indices\nend_header\n",
      line,
      surface.vertices.size(),
      surface.triangles.size());
  for (const auto& v : surface.vertices)
    out += fmt::format("{:.6g} {:.6g} {:.6g}\n", v[0], v[1], v[2]);
  for (const auto& t : surface.triangles) out += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return out;
}

std::string ZoneCsv(const Machine& machine, const WorkZone& zone) {
  std::string out;
  std::vector<bool> rotary;
  for (const int i : zone.box.varied) {
    const kinematics::Coordinate& c = machine.coordinates()[static_cast<std::size_t>(i)];
    rotary.push_back(c.rotary);
    const char* unit = c.rotary ? "deg" : "mm";
    out += fmt::format("{0}_from_{1},{0}_to_{1},", c.name, unit);
  }
  out += "inside_least,inside_most,bounded_by\n";
  for (const ZoneCell& cell : zone.cells) {
    for (std::size_t i = 0; i < zone.box.dimension(); ++i) {
      const std::array<double, 2> edge = zone.Edge(cell, i);
      out +=
          fmt::format("{:.9g},{:.9g},", Outward(rotary[i], edge[0]), Outward(rotary[i], edge[1]));
    }
    out += fmt::format("{:.7g},{:.7g},{}\n",
                       cell.least,
                       cell.most,
                       cell.certain || cell.cause < 0
                           ? std::string()
                           : zone.constraints[static_cast<std::size_t>(cell.cause)]);
  }
  return out;
}

std::string PicturesSvg(const std::vector<ZonePicture>& pictures) {
  const double width = static_cast<double>(pictures.size()) * (kPanel + 24.0) + 24.0;
  const double height = kPanel + kTitle + 44.0;
  std::string out = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:.0f} {1:.0f}' width='{0:.0f}' "
      "height='{1:.0f}' font-family='sans-serif' font-size='12'>\n"
      "<style>text{{fill:#333}}.x{{text-anchor:middle}}.y{{text-anchor:end}}"
      ".frame{{fill:none;stroke:#bbb}}.zone{{fill:#4a90d9;fill-opacity:.18;stroke:#1f5f9e;"
      "fill-rule:evenodd}}.singular{{fill:#d0342c}}.body{{fill:none;stroke:#2d8a4e;stroke-width:2}}"
      "@media (prefers-color-scheme:dark){{text{{fill:#ddd}}.frame{{stroke:#666}}}}</style>\n",
      width,
      height);
  double left = 0.0;
  for (const ZonePicture& picture : pictures) {
    out += Panel(picture, left);
    left += kPanel + 24.0;
  }
  return out + "</svg>\n";
}

}  // namespace kompono::analysis
