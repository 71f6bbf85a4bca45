// SPDX-License-Identifier: Apache-2.0
#include "kompono/calibration/klipper_delta.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "kompono/calibration/codes.hpp"

namespace kompono::calibration {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr std::array<std::string_view, 3> kTowers{"a", "b", "c"};

/// Members of a JSON object; what is missing or of the wrong type is collected.
class JsonReader {
 public:
  JsonReader(std::string file, Diagnostics* complaints)
      : file_(std::move(file)), complaints_(complaints) {}

  double Number(const nlohmann::json& object, const std::string& place, std::string_view key) {
    const auto member = object.find(key);
    if (member != object.end() && member->is_number()) return member->get<double>();
    Complain(fmt::format("'{}{}' is {}", place, key, Missing(object, key, "a number")));
    return 0.0;
  }

  std::string Text(const nlohmann::json& object, std::string_view key) {
    const auto member = object.find(key);
    if (member != object.end() && member->is_string()) return member->get<std::string>();
    Complain(fmt::format("'{}' is {}", key, Missing(object, key, "a text")));
    return {};
  }

  KlipperGeometry Geometry(const nlohmann::json& object, const std::string& key) {
    KlipperGeometry geometry;
    const auto member = object.find(key);
    if (member == object.end() || !member->is_object()) {
      Complain(fmt::format("'{}' is {}", key, Missing(object, key, "an object")));
      return geometry;
    }
    const std::string place = key + ".";
    geometry.delta_radius = Number(*member, place, "delta_radius");
    for (std::size_t i = 0; i < kTowers.size(); ++i) {
      geometry.angle_deg[i] = Number(*member, place, fmt::format("angle_{}", kTowers[i]));
      geometry.arm[i] = Number(*member, place, fmt::format("arm_{}", kTowers[i]));
      geometry.endstop[i] = Number(*member, place, fmt::format("endstop_{}", kTowers[i]));
      if (geometry.arm[i] <= std::abs(geometry.delta_radius)) {
        Complain(fmt::format(
            "'{}arm_{}' is not longer than the radius, so that the platform hangs nowhere",
            place,
            kTowers[i]));
      }
    }
    return geometry;
  }

 private:
  static std::string Missing(const nlohmann::json& object,
                             std::string_view key,
                             std::string_view wanted) {
    return object.find(key) == object.end() ? std::string("missing")
                                            : fmt::format("not {}", wanted);
  }

  void Complain(std::string message) {
    complaints_->push_back(
        {.code = codes::kRunMember.code, .file = file_, .message = std::move(message)});
  }

  std::string file_;
  Diagnostics* complaints_;
};

/// Where Klipper's numbers live in θ.
struct Places {
  int radius = -1;
  std::array<int, 3> radius_offset{}, azimuth{}, strut{}, zero{};
};

Parsed<Places> FindPlaces(const kinematics::Machine& machine) {
  Places places;
  bool all = machine.drives().size() == 3;
  if (all) {
    const std::string block =
        machine.drives()[0].name.substr(0, machine.drives()[0].name.find('.'));
    const auto find = [&machine, &all](const std::string& name) {
      const int index = machine.FindParameter(name);
      all = all && index >= 0;
      return index;
    };
    places.radius = find(block + ".radius");
    for (std::size_t i = 0; i < 3; ++i) {
      places.radius_offset[i] = find(fmt::format("{}.radius_offset[{}]", block, i + 1));
      places.azimuth[i] = find(fmt::format("{}.azimuth[{}]", block, i + 1));
      places.strut[i] = find(fmt::format("{}.strut[{}]", block, i + 1));
      places.zero[i] = find(machine.drives()[i].name + ".zero");
    }
  }
  if (!all) {
    return tl::unexpected(Diagnostics{
        {.code = codes::kNotADelta.code,
         .file = machine.layout().file.string(),
         .message = "the machine is no linear delta with three drives, so that Klipper has no "
                    "words for its geometry"}});
  }
  return places;
}

/// An angle as Klipper writes it, 0 … 360.
double TowerAngle(double angle_rad) {
  const double angle = std::fmod(angle_rad * kDegPerRad, 360.0);
  return angle < 0.0 ? angle + 360.0 : angle;
}

std::string Triple(const std::array<double, 3>& numbers) {
  return fmt::format("[{}, {}, {}]", numbers[0], numbers[1], numbers[2]);
}

/// As a TOML basic string.
std::string Quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + '"';
}

}  // namespace

Parsed<KlipperRun> ReadKlipperRun(const std::filesystem::path& json_file) {
  std::ifstream stream(json_file, std::ios::binary);
  std::ostringstream text;
  if (!stream || !(text << stream.rdbuf())) {
    return tl::unexpected(Diagnostics{{.code = codes::kCannotRead.code,
                                       .file = json_file.string(),
                                       .message = "cannot read the description of the run"}});
  }
  const nlohmann::json json = nlohmann::json::parse(text.str(), nullptr, false);
  if (!json.is_object()) {
    return tl::unexpected(Diagnostics{{.code = codes::kNotJson.code,
                                       .file = json_file.string(),
                                       .message = "the file is no JSON object"}});
  }
  Diagnostics complaints;
  JsonReader reader(json_file.string(), &complaints);
  KlipperRun run;
  run.name = reader.Text(json, "name");
  run.source = reader.Text(json, "source");
  run.commit = reader.Text(json, "commit");
  run.licence = reader.Text(json, "licence");
  run.machine = reader.Text(json, "machine");
  run.heights = static_cast<int>(reader.Number(json, "", "n_heights"));
  run.distances = static_cast<int>(reader.Number(json, "", "n_distances"));
  run.nominal = reader.Geometry(json, "nominal");
  run.published_fit = reader.Geometry(json, "published_fit");
  if (!complaints.empty()) return tl::unexpected(std::move(complaints));
  return run;
}

std::string KlipperLayout(const KlipperGeometry& geometry,
                          std::string_view name,
                          std::string_view description) {
  std::string text = fmt::format(
      "kompono = 1\n"
      "name = {}\n"
      "description = {}\n"
      "formula = \"part O (XYZ):delta tool\"\n"
      "\n"
      "[block.delta]\n"
      "module = \"linear_delta\"\n"
      "parameters.radius = {}\n"
      "parameters.azimuth = {}\n"
      "parameters.strut = {}\n",
      Quoted(name),
      Quoted(description),
      geometry.delta_radius,
      Triple(geometry.angle_deg),
      Triple(geometry.arm));
  for (std::size_t i = 0; i < 3; ++i) {
    const double square =
        geometry.arm[i] * geometry.arm[i] - geometry.delta_radius * geometry.delta_radius;
    text += fmt::format(
        "\n"
        "[block.delta.drive.q{}]  # tower {}; readings are travels down from the end-stop\n"
        "zero = {}\n"
        "direction = \"-\"\n",
        i + 1,
        kTowers[i],
        geometry.endstop[i] + std::sqrt(square));
  }
  return text;
}

Parsed<KlipperGeometry> KlipperGeometryOf(const kinematics::Machine& machine,
                                          const Eigen::VectorXd& theta) {
  const Parsed<Places> places = FindPlaces(machine);
  if (!places) return tl::unexpected(places.error());
  KlipperGeometry geometry;
  geometry.delta_radius = theta[places->radius];
  for (std::size_t i = 0; i < 3; ++i) {
    const double radius = theta[places->radius] + theta[places->radius_offset[i]];
    geometry.angle_deg[i] = TowerAngle(theta[places->azimuth[i]]);
    geometry.arm[i] = theta[places->strut[i]];
    geometry.endstop[i] =
        theta[places->zero[i]] - std::sqrt(geometry.arm[i] * geometry.arm[i] - radius * radius);
  }
  return geometry;
}

Parsed<Eigen::VectorXd> ThetaOfKlipper(const kinematics::Machine& machine,
                                       const KlipperGeometry& geometry) {
  const Parsed<Places> places = FindPlaces(machine);
  if (!places) return tl::unexpected(places.error());
  Eigen::VectorXd theta = machine.nominal();
  theta[places->radius] = geometry.delta_radius;
  for (std::size_t i = 0; i < 3; ++i) {
    const double radius = geometry.delta_radius + theta[places->radius_offset[i]];
    theta[places->azimuth[i]] = geometry.angle_deg[i] / kDegPerRad;
    theta[places->strut[i]] = geometry.arm[i];
    theta[places->zero[i]] =
        geometry.endstop[i] + std::sqrt(geometry.arm[i] * geometry.arm[i] - radius * radius);
  }
  return theta;
}

std::string CompareKlipper(const KlipperGeometry& nominal,
                           const KlipperGeometry& identified,
                           const KlipperGeometry& published) {
  std::string text = fmt::format("{:<13} {:>12} {:>12} {:>12} {:>12}\n",
                                 "",
                                 "nominal",
                                 "identified",
                                 "published",
                                 "difference");
  const auto line = [&text](std::string_view name, double before, double after, double theirs) {
    text += fmt::format("{:<13} {:>12.4f} {:>12.4f} {:>12.4f} {:>12.4f}\n",
                        name,
                        before,
                        after,
                        theirs,
                        after - theirs);
  };
  line("delta_radius", nominal.delta_radius, identified.delta_radius, published.delta_radius);
  for (std::size_t i = 0; i < kTowers.size(); ++i) {
    line(fmt::format("angle_{}", kTowers[i]),
         nominal.angle_deg[i],
         identified.angle_deg[i],
         published.angle_deg[i]);
  }
  for (std::size_t i = 0; i < kTowers.size(); ++i) {
    line(fmt::format("arm_{}", kTowers[i]), nominal.arm[i], identified.arm[i], published.arm[i]);
  }
  for (std::size_t i = 0; i < kTowers.size(); ++i) {
    line(fmt::format("endstop_{}", kTowers[i]),
         nominal.endstop[i],
         identified.endstop[i],
         published.endstop[i]);
  }
  return text;
}

}  // namespace kompono::calibration
