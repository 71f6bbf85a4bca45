// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_TESTS_CATALOG_FIXTURE_HPP_
#define KOMPONO_TESTS_CATALOG_FIXTURE_HPP_

#include <SQLiteCpp/SQLiteCpp.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "kompono/catalog/hash.hpp"
#include "kompono/catalog/store.hpp"

namespace kompono::catalog {

inline LayoutRecord Lambda() {
  return {
      .name = "Lambda water-jet",
      .formula = "part_xy (XY):drive O|O Z P_z",
      .distribution = "part_xy (XY):drive O|O Z P_z",
      .relative_motion = "{XYZ} P_z",
      .open_base = true,
      .coordinates = 3,
      .drives = 3,
      .motions = {{.axis = "X", .side = Side::kWorkpiece, .block = "drive"},
                  {.axis = "Y", .side = Side::kWorkpiece, .block = "drive"},
                  {.axis = "Z", .side = Side::kTool}},
      .blocks = {{.name = "drive", .module = "lambda", .plugin = "org.kompono.lambda"},
                 {.name = "tool", .module = "jet_head", .plugin = "org.kompono.units"}},
      .parameters = {{.name = "drive.L1", .value = 1200.0, .unit = "mm"},
                     {.name = "drive.L2", .value = 820.5, .unit = "mm"}},
      .toml = "kompono = 1\nname = \"Lambda water-jet\"\n",
      .metrics = {{.name = "workspace_area", .value = 1.9e6, .unit = "mm2", .method = "grid 50x50"},
                  {.name = "stiffness_min",
                   .unit = "N/um",
                   .method = "grid 50x50",
                   .failure = "no stiffness given"}},
      .capabilities = {{.name = "cutting", .detail = "sheet up to 150 mm"}},
      .calibrations = {{.measurements = "lambda.csv",
                        .measurements_sha256 = std::string(64, 'a'),
                        .status = "converged",
                        .rms_before_um = 842.0,
                        .rms_after_um = 38.25,
                        .sigma_um = 20.0,
                        .degrees_of_freedom = 54,
                        .report_json = R"({"iterations": 6})"}},
      .provenance = {.plugins = {{.id = "org.kompono.units", .version = "1.2.0"},
                                 {.id = "org.kompono.lambda", .version = "1.0.0"}},
                     .source_path = "layouts/machines/lambda.toml"}};
}

inline LayoutRecord KneeMill() {
  return {.name = "Knee mill",
          .formula = "part X Y Z O C_v tool",
          .distribution = "part {XYZ} O C_v tool",
          .relative_motion = "{XYZ} C_v",
          .coordinates = 3,
          .drives = 3,
          .motions = {{.axis = "X"}, {.axis = "Y"}, {.axis = "Z"}},
          .blocks = {{.name = "spindle", .module = "spindle", .plugin = "org.kompono.units"}},
          .parameters = {{.name = "spindle.length", .value = 300.0, .unit = "mm"}},
          .toml = "kompono = 1\nname = \"Knee mill\"\n",
          .metrics =
              {{.name = "workspace_area", .value = 2.4e5, .unit = "mm2", .method = "grid 50x50"}},
          .capabilities = {{.name = "milling", .detail = "3 axes"}},
          .provenance = {.plugins = {{.id = "org.kompono.units", .version = "1.2.0"}},
                         .source_path = "knee.toml"}};
}

inline LayoutRecord Hexapod() {
  LayoutRecord record = KneeMill();
  record.name = "Hexapod";
  record.formula = "part O (XYZABC):struts C_v tool";
  record.distribution = record.formula;
  record.relative_motion = "{XYZ} {ABC} C_v";
  record.coordinates = 6;
  record.drives = 6;
  record.blocks = {{.name = "struts", .module = "hexapod", .plugin = "org.kompono.hexapod"}};
  record.parameters = {{.name = "struts.radius", .value = 400.0, .unit = "mm"}};
  record.toml = "kompono = 1\nname = \"Hexapod\"\n";
  record.metrics = {
      {.name = "workspace_area", .value = 6.0e4, .unit = "mm2", .method = "grid 50x50"}};
  record.provenance.plugins = {{.id = "org.kompono.hexapod", .version = "2.0.1"}};
  return record;
}

inline std::string Bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

inline void WriteBytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// All complaints as the user reads them, for messages of failing expectations and for matching.
inline std::string Said(const Diagnostics& diagnostics) {
  return RenderAll(diagnostics, {});
}

/// Gives each test its own empty folder.
class CatalogTest : public testing::Test {
 protected:
  CatalogTest() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "kompono-catalog-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  CatalogTest(const CatalogTest&) = delete;
  CatalogTest& operator=(const CatalogTest&) = delete;
  CatalogTest(CatalogTest&&) = delete;
  CatalogTest& operator=(CatalogTest&&) = delete;
  ~CatalogTest() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::filesystem::path File(const std::string& name = "machines.db") const {
    return folder_ / name;
  }

  /// Opens or makes the catalog `name`; the test fails if it cannot.
  [[nodiscard]] Store Create(const std::string& name = "machines.db") const {
    Parsed<Store> store = Store::Open(File(name), {.mode = OpenMode::kCreate});
    if (!store) throw std::runtime_error(Said(store.error()));
    return *std::move(store);
  }

  /// A catalog with Lambda, Knee mill and Hexapod.
  [[nodiscard]] Store Filled() const {
    Store store = Create();
    const std::vector<LayoutRecord> records = {Lambda(), KneeMill(), Hexapod()};
    if (auto added = store.AddAll(records); !added) throw std::runtime_error(Said(added.error()));
    return store;
  }

  /// Speaks to the file behind the library's back.
  void Tamper(const std::string& sql) const {
    SQLite::Database db(File().string(), SQLite::OPEN_READWRITE, 5000);
    db.exec(sql);
  }

  [[nodiscard]] std::vector<std::string> FilesInFolder() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

  std::filesystem::path folder_;
};

/// The code of the only complaint; the whole text if there are several.
template <class T>
std::string CodeOf(const Parsed<T>& parsed) {
  if (parsed) return "no complaint";
  return parsed.error().size() == 1 ? parsed.error().front().code : Said(parsed.error());
}

}  // namespace kompono::catalog

#endif  // KOMPONO_TESTS_CATALOG_FIXTURE_HPP_
