// Faults of whole scans, planted in a simulated street: each gets its line, and a clean one gets none.
#include "mansard/pipeline/scan_checks.hpp"

#include <gmock/gmock.h>
#include <cmath>
#include <fstream>
#include <functional>

#include "base/scratch.hpp"
#include "mansard/base/files.hpp"
#include "mansard/pipeline/inputs.hpp"
#include "pipeline/houses.hpp"

namespace mansard::pipeline {
namespace {

using geometry::Point3;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double length = 150, width = 80;  // m

/// Twelve houses with flat roofs along a street that rises, scanned with a vertex every half metre.
struct Street {
  model::Scene scene;

  explicit Street(std::uint64_t seed, double noise = 0.03, bool ground = true) {
    base::Random random(seed);
    struct House {
      double x0, y0, x1, y1, z;
    };
    std::vector<House> houses;
    const auto ground_at = [](double x, double y) { return 0.02 * x - 0.01 * y; };
    for (int i = 0; i < 12; ++i) {
      const double x = 2 + 24.0 * (i / 2) + random.uniform(0, 10), y = (i % 2 == 0 ? 8.0 : 46.0) + random.uniform(0, 6);
      const double wide = random.uniform(7, 12), deep = random.uniform(9, 20);
      houses.push_back({x, y, x + wide, y + deep, ground_at(x, y) + random.uniform(5, 11)});
      scene.footprints.push_back(test::footprint(std::to_string(i), test::rectangle(x, y, x + wide, y + deep)));
    }
    const auto normal = [&] {
      double sum = 0;  // of twelve uniform numbers: variance 1
      for (int k = 0; k < 12; ++k) sum += random.uniform();
      return sum - 6;
    };
    constexpr double step = 0.5;
    constexpr int columns = static_cast<int>(length / step), rows = static_cast<int>(width / step);
    std::vector<bool> roof;
    for (int r = 0; r <= rows; ++r)
      for (int c = 0; c <= columns; ++c) {
        const double x = step * c + random.uniform(-0.15, 0.15), y = step * r + random.uniform(-0.15, 0.15);
        double z = ground_at(x, y);
        roof.push_back(false);
        for (const auto& house : houses)
          if (x > house.x0 && x < house.x1 && y > house.y0 && y < house.y1) z = house.z, roof.back() = true;
        scene.mesh.vertices.push_back({x, y, z + noise * normal()});
      }
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c) {
        const auto a = static_cast<std::uint32_t>(r * (columns + 1) + c), b = a + 1,
                   d = a + static_cast<std::uint32_t>(columns) + 1, e = d + 1;
        if (!ground && !(roof[a] && roof[b] && roof[d] && roof[e])) continue;
        scene.mesh.triangles.push_back({a, b, e});
        scene.mesh.triangles.push_back({a, e, d});
      }
  }

  auto change(const std::function<Point3(Point3)>& by) -> Street& {
    for (auto& v : scene.mesh.vertices) v = by(v);
    return *this;
  }
};

auto checked(const Street& street, const Options& options = {}) -> CheckedScan {
  return check_scan(street.scene, nullptr, options).value();
}

auto codes_of(const CheckedScan& checked) -> std::vector<std::string> {
  std::vector<std::string> out;
  for (const auto& finding : checked.findings) out.push_back(finding.code);
  return out;
}

TEST(CheckScan, says_nothing_of_a_clean_scan) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed)
    for (const double noise : {0.0, 0.03, 0.15}) {
      const auto found = checked(Street(seed, noise));
      EXPECT_THAT(codes_of(found), IsEmpty()) << seed << " " << noise << ": " << base::to_string(found.findings[0]);
      ASSERT_TRUE(found.registration);
      EXPECT_LT(geometry::length(found.registration->offset), 4 * found.registration->error + 0.02) << seed;
    }
}

TEST(CheckScan, tells_an_offset_with_its_error_and_the_option_that_corrects_it) {
  for (const auto& [x, y] : {std::pair(0.25, -0.2), {1.5, 0.0}, {-2.1, 2.1}, {0.0, 6.0}}) {
    Street street(3);
    street.change([x = x, y = y](Point3 p) { return Point3{p.x + x, p.y + y, p.z}; });
    Options options;
    options.ingest.mesh_offset = {84800, 447400, -1};
    const auto found = checked(street, options);
    ASSERT_THAT(codes_of(found), ElementsAre("scan-offset")) << x << " " << y;
    EXPECT_EQ(found.findings[0].severity, base::Severity::warning);
    EXPECT_NEAR(found.registration->offset.x, x, 4 * found.registration->error);
    EXPECT_NEAR(found.registration->offset.y, y, 4 * found.registration->error);
    EXPECT_LT(found.registration->error, 0.1);
    const auto offset = aligned_offset(*found.registration, options.ingest.mesh_offset);
    ASSERT_TRUE(offset);
    EXPECT_NEAR((*offset)[0], 84800 - x, 0.1);
    EXPECT_NEAR((*offset)[1], 447400 - y, 0.1);
    EXPECT_EQ((*offset)[2], -1);
    EXPECT_THAT(found.findings[0].message, HasSubstr("--mesh-offset " + base::to_text((*offset)[0]) + " "));
  }
}

TEST(CheckScan, an_offset_within_its_error_is_none) {
  accuracy::Registration found{{0.05, 0}, 0.02, 0.1, 100, 400};
  EXPECT_FALSE(aligned_offset(found, {}));
  found.offset = {0.1, 0};
  EXPECT_TRUE(aligned_offset(found, {}));
  found.edges = 6;  // of few walls the error is not known so well
  EXPECT_FALSE(aligned_offset(found, {}));
  EXPECT_FALSE(aligned_offset({{0.015, 0}, 0.0001, 0.1, 100, 400}, {}));  // less than surveys are rounded to
}

TEST(CheckScan, refuses_a_scan_that_is_upside_down) {
  Street street(4);
  const auto found = checked(street.change([](Point3 p) { return Point3{p.x, p.y, -p.z}; }));
  ASSERT_THAT(codes_of(found), ElementsAre("scan-upside-down"));
  EXPECT_EQ(found.findings[0].severity, base::Severity::error);
  EXPECT_THAT(found.findings[0].message, HasSubstr("12 of 12 footprints"));
}

TEST(CheckScan, names_the_axis_the_unit_and_the_mirror_of_a_scan_that_does_not_fit) {
  struct Fault {
    std::function<Point3(Point3)> change;
    std::string code, words;
  };
  for (const auto& [change, code, words] : {
           Fault{[](Point3 p) {
                   return Point3{p.x, p.z, -p.y};
                 },
                 "scan-axis", "--up y"},
           Fault{[](Point3 p) { return (1 / 0.3048) * p; }, "scan-units", "multiply its coordinates by 0.3048"},
           Fault{[](Point3 p) { return 0.3048 * p; }, "scan-units", "multiply its coordinates by 3.2808"},
           Fault{[](Point3 p) {
                   return Point3{150 - p.x, p.y, p.z};
                 },
                 "scan-mirrored", "along x"},
           Fault{[](Point3 p) {
                   return Point3{p.x + 35, p.y - 20, p.z};
                 },
                 "scan-place", "--mesh-offset -35 20 0"},
       }) {
    Street street(5);
    // So that some of a scan that lies on its side is over footprints.
    for (auto& footprint : street.scene.footprints)
      for (auto& p : footprint.polygons[0].outer) p.y -= 20;
    street.change([&change = change](Point3 p) { return change({p.x, p.y - 20, p.z}); });
    const auto found = checked(street);
    ASSERT_FALSE(found.findings.empty()) << words;
    EXPECT_EQ(found.findings[0].code, code) << found.findings[0].message;
    EXPECT_EQ(found.findings[0].severity, base::Severity::error);
    EXPECT_THAT(found.findings[0].message, HasSubstr(words));
  }
}

TEST(CheckScan, what_is_left_of_houses_that_are_gone_is_no_other_unit) {
  // A tower, three times as large, would be as large as a house; but the scan would be far too large then.
  const std::vector<geometry::Ring> houses{{{-37, -14.5}, {-12.2, -4.7}, {-21.7, 19.3}, {-46.5, 9.6}},
                                           {{-12.2, -4.7}, {12.6, 5}, {3.6, 27.8}, {-21.2, 18.1}},
                                           {{12.6, 5}, {37.4, 14.8}, {28, 38.5}, {3.2, 28.8}}};
  model::Scene scene;
  for (const auto& house : houses)
    scene.footprints.push_back(test::footprint(std::to_string(scene.footprints.size()), {house, {}}));
  constexpr double step = 0.5;
  constexpr int columns = 210, rows = 140;
  base::Random random(3);
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= columns; ++c) {
      const double x = step * c - 55, y = step * r - 25;
      const double z = std::abs(x + 1) < 4 && std::abs(y - 3) < 4 ? 17.9 : 0;
      scene.mesh.vertices.push_back({x, y, z + random.uniform(-0.05, 0.05)});
    }
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const auto a = static_cast<std::uint32_t>(r * (columns + 1) + c), d = a + static_cast<std::uint32_t>(columns) + 1;
      scene.mesh.triangles.push_back({a, a + 1, d + 1});
      scene.mesh.triangles.push_back({a, d + 1, d});
    }
  const auto found = check_scan(scene, nullptr, {}).value();
  for (const auto& finding : found.findings) EXPECT_NE(finding.severity, base::Severity::error) << finding.message;
}

TEST(CheckScan, tells_heights_in_another_unit) {
  const auto scaled = [](double factor) { return [factor](Point3 p) { return Point3{p.x, p.y, factor * p.z}; }; };
  const auto high = checked(Street(6).change(scaled(1000)));
  ASSERT_FALSE(high.findings.empty());
  EXPECT_EQ(high.findings[0].code, "scan-units");
  EXPECT_EQ(high.findings[0].severity, base::Severity::error);
  EXPECT_THAT(high.findings[0].message, HasSubstr("multiply its z by 0.001"));
  const auto low = checked(Street(6, 0).change(scaled(0.001)));
  EXPECT_THAT(codes_of(low), testing::Contains("scan-units"));
}

TEST(CheckScan, tells_digits_that_are_lost_where_they_matter) {
  const auto rounded = [](double x, double y) {
    return [x, y](Point3 p) { return Point3{std::round(p.x / x) * x, std::round(p.y / y) * y, p.z}; };
  };
  for (const double fine : {0.001, 0.01, 0.0078125})
    EXPECT_THAT(codes_of(checked(Street(7).change(rounded(fine, fine)))), IsEmpty()) << fine;
  const auto half = checked(Street(7).change(rounded(0.03125, 0.5)));
  ASSERT_THAT(codes_of(half), testing::Contains("scan-digits"));
  EXPECT_THAT(half.findings[0].message, HasSubstr("y in steps of 0.5 m"));
  EXPECT_EQ(half.findings[0].severity, base::Severity::warning);
  const auto metres = checked(Street(7).change(rounded(0.25, 2)));
  ASSERT_FALSE(metres.findings.empty());
  EXPECT_EQ(metres.findings[0].code, "scan-digits");
  EXPECT_EQ(metres.findings[0].severity, base::Severity::error);
  // tried: as 32-bit floats have at such coordinates; export the scan with an origin near it
  const auto single = [](double away) {
    return [away](Point3 p) { return Point3{p.x, static_cast<float>(p.y + away) - away, p.z}; };
  };
  EXPECT_THAT(codes_of(checked(Street(7).change(single(5e6)))), testing::Contains("scan-digits"));
  Options options;
  options.ingest.mesh_offset = {0, 5e6, 0};
  EXPECT_THAT(codes_of(checked(Street(7).change(single(0)), options)), IsEmpty());
}

TEST(CheckScan, tells_that_no_ground_is_seen) {
  const auto found = checked(Street(8, 0.03, false));
  ASSERT_THAT(codes_of(found), testing::Contains("scan-ground"));
  for (const auto& finding : found.findings) {
    if (finding.code != "scan-ground") continue;
    EXPECT_THAT(finding.message, HasSubstr("12 of 12 footprints"));
    EXPECT_THAT(finding.message, HasSubstr("--dtm FILE"));
  }
}

TEST(CheckScan, tells_what_the_scan_does_not_cover) {
  Street street(9);
  // It ends in the middle of the fifth house.
  const double end = geometry::bounds(street.scene.footprints[4].polygons).least.x + 5;
  std::erase_if(street.scene.mesh.triangles, [&](const auto& t) { return street.scene.mesh.vertices[t[0]].x > end; });
  street.scene.footprints[11].defect = base::error("ingest-footprint-outside", "it lies outside the mesh");
  const auto found = checked(street);
  std::string all;
  for (const auto& finding : found.findings) {
    EXPECT_EQ(finding.code, "scan-coverage") << finding.message;
    all += finding.message + "\n";
  }
  EXPECT_THAT(all, HasSubstr("1 of 12 footprints (8 %) are outside of the scan"));
  EXPECT_THAT(all, HasSubstr("covers nothing of "));
  EXPECT_THAT(all, HasSubstr("the scan ends in "));
  EXPECT_THAT(all, HasSubstr("'4'"));
}

TEST(CheckScan, tells_footprints_where_the_scan_has_no_building) {
  Street street(10);
  street.scene.footprints.push_back(test::footprint("new", test::rectangle(60, 30, 70, 38)));
  const auto found = checked(street);
  ASSERT_THAT(codes_of(found), ElementsAre("scan-empty"));
  EXPECT_THAT(found.findings[0].message, HasSubstr("1 of 13 footprints"));
  EXPECT_THAT(found.findings[0].message, HasSubstr("'new'"));
}

/// The street as files: a mesh and footprints.
auto write(const Street& street, const test::Scratch& folder) -> InputPaths {
  const auto put = [&](const char* name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return folder / name;
  };
  std::string mesh, polygons;
  for (const auto& v : street.scene.mesh.vertices)
    mesh += "v " + base::to_text(v.x) + " " + base::to_text(v.y) + " " + base::to_text(v.z) + "\n";
  for (const auto& t : street.scene.mesh.triangles)
    mesh += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) + "\n";
  for (const auto& footprint : street.scene.footprints) {
    std::string ring;
    auto points = footprint.polygons[0].outer;
    points.push_back(points.front());
    for (const auto& p : points)
      ring += (ring.empty() ? "[" : ",[") + base::to_text(p.x) + "," + base::to_text(p.y) + "]";
    polygons += (polygons.empty() ? "" : ",") + (R"({"type":"Feature","properties":{"id":")" + footprint.id +
                                                 R"("},"geometry":{"type":"Polygon","coordinates":[[)" + ring + "]]}}");
  }
  return {{put("mesh.obj", mesh)},
          put("footprints.geojson", R"({"type":"FeatureCollection","features":[)" + polygons + "]}"),
          false};
}

auto of_scan(const std::vector<base::Diagnostic>& warnings) -> std::vector<base::Diagnostic> {
  std::vector<base::Diagnostic> out;
  std::ranges::copy_if(warnings, std::back_inserter(out), [](const auto& w) { return w.code.starts_with("scan-"); });
  return out;
}

TEST(CheckScan, its_findings_are_warnings_of_the_scene_in_memory_or_in_cells) {
  Street street(11);
  street.change([](Point3 p) { return Point3{p.x + 0.4, p.y, p.z}; });
  const test::Scratch folder;
  const auto paths = write(street, folder);
  Options options;
  const auto whole = read_inputs(paths, options);
  ASSERT_TRUE(whole) << base::to_string(whole.error());
  ASSERT_EQ(of_scan(whole->warnings).size(), 1U);
  options.ingest.cells_from = 0;
  options.ingest.cell_side = 16;
  const auto city = read_city_inputs(paths, options);
  ASSERT_TRUE(city) << base::to_string(city.error());
  ASSERT_NE(city->cells, nullptr);
  EXPECT_EQ(of_scan(city->scene.warnings), of_scan(whole->warnings));
  options.scan_checks = ScanChecks::off;
  EXPECT_TRUE(of_scan(read_city_inputs(paths, options).value().scene.warnings).empty());
}

TEST(CheckScan, its_errors_end_the_reading_unless_they_are_only_to_warn) {
  Street street(12);
  street.change([](Point3 p) { return Point3{p.x, p.y, -p.z}; });
  const test::Scratch folder;
  const auto paths = write(street, folder);
  Options options;
  const auto refused = read_inputs(paths, options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, "scan-upside-down");
  EXPECT_THAT(refused.error().message, HasSubstr("--pipeline-scan-checks warn"));
  options.scan_checks = ScanChecks::warn;
  const auto read = read_inputs(paths, options);
  ASSERT_TRUE(read) << base::to_string(read.error());
  EXPECT_EQ(of_scan(read->warnings).size(), 1U);
}

TEST(CheckScan, finds_the_same_in_any_order_and_at_any_place) {
  Street street(11);
  street.change([](Point3 p) { return Point3{p.x + 0.4, p.y, p.z}; });
  const auto whole = checked(street);
  ASSERT_THAT(codes_of(whole), ElementsAre("scan-offset"));
  Street turned = street;
  std::ranges::reverse(turned.scene.footprints);
  std::ranges::reverse(turned.scene.mesh.triangles);
  EXPECT_EQ(checked(turned).findings, whole.findings);
  Street far = street;
  for (auto& footprint : far.scene.footprints)
    for (auto& p : footprint.polygons[0].outer) p.x += 300, p.y -= 200;
  far.change([](Point3 p) { return Point3{p.x + 300, p.y - 200, p.z}; });
  EXPECT_EQ(checked(far).findings, whole.findings);
}

TEST(CheckScan, compares_no_derived_footprints) {
  Street street(12);
  street.change([](Point3 p) { return Point3{p.x + 3, p.y, p.z}; });
  for (auto& footprint : street.scene.footprints) footprint.derived = true;
  EXPECT_THAT(codes_of(checked(street)), IsEmpty());
}

}  // namespace
}  // namespace mansard::pipeline
