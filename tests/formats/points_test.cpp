// Point clouds: every file of the shared data against what two independent decoders made of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "base/scratch.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/run.hpp"
#include "mansard/crs/spatial_reference.hpp"
#include "mansard/formats/hash.hpp"
#include "mansard/formats/las/chunk_table.hpp"
#include "mansard/formats/las/las_file.hpp"
#include "mansard/formats/las/wave_layers.hpp"
#include "mansard/formats/las_points.hpp"
#include "mansard/formats/points.hpp"

namespace {

using namespace mansard;
using formats::CloudPoint;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
namespace fs = std::filesystem;

const fs::path shared = fs::path(MANSARD_SHARED_DATA) / "points";
const fs::path own = fs::path(MANSARD_TEST_DATA) / "points";

#define NEEDS_SHARED_DATA() \
  if (!fs::exists(shared)) GTEST_SKIP() << "needs " << shared

auto expected() -> nlohmann::json {
  std::ifstream file(shared / "expected.json");
  return nlohmann::json::parse(file);
}

auto all_of(const formats::PointCloud& cloud) -> base::Result<std::vector<CloudPoint>> {
  std::vector<CloudPoint> all;
  for (std::size_t i = 0; i < cloud.pieces(); ++i) {
    auto some = cloud.read(i);
    if (!some) return some.failure();
    all.insert(all.end(), some->begin(), some->end());
  }
  return all;
}

auto points_in(const fs::path& path) -> base::Result<std::vector<CloudPoint>> {
  auto cloud = formats::open_points(path);
  if (!cloud) return cloud.failure();
  return all_of(**cloud);
}

/// Without the 29 bytes of the wave packet, where an uncompressed file has them: LAZ is read without.
auto without_waves(const formats::LasFile& file, const std::string& records) -> std::string {
  const int format = file.header().format;
  if (!formats::has_wave_packet(format) || file.header().compressed) return records;
  std::string out;
  const std::size_t length = file.header().record_length, packet = formats::length_of_format(format) - 29;
  for (std::size_t at = 0; at < records.size(); at += length)
    out += records.substr(at, packet) + records.substr(at + packet + 29, length - packet - 29);
  return out;
}

auto records_hash(const formats::LasFile& file) -> base::Result<std::string> {
  std::string all;
  for (std::size_t i = 0; i < file.pieces(); ++i) {
    auto some = file.records(i);
    if (!some) return some.failure();
    all += *some;
  }
  return formats::sha256(without_waves(file, all));
}

/// What is refused, and by which words.
auto refused() -> std::map<std::string, std::string> {
  return {{"variety/pdrf4-1.3.laz", "point format 4 has waveforms"},
          {"variety/pdrf5-1.3.laz", "point format 5 has waveforms"},
          {"variety/pdrf10-1.5.laz", "LAS 1.5 is not read"},
          {"variety/pdrf7-v4-1.4.laz", "version 4 of LASzip's items"},
          {"variety/simple-laszip-compressor-version-1.2r0.laz", "version 1 of LASzip's items"}};
}

TEST(Points, of_every_file_are_those_of_two_other_decoders) {
  NEEDS_SHARED_DATA();
  const auto no = refused();
  std::size_t read = 0;
  const auto all = expected();
  for (const auto& [name, want] : all.items()) {
    SCOPED_TRACE(name);
    auto file = formats::LasFile::open(shared / name);
    if (const auto words = no.find(name); words != no.end()) {
      ASSERT_FALSE(file);
      EXPECT_EQ(file.error().code, "ingest-points-unsupported");
      EXPECT_THAT(file.error().message, HasSubstr(words->second));
      continue;
    }
    ASSERT_TRUE(file) << base::to_string(file.error());
    EXPECT_EQ((*file)->info().points, want["points"].get<std::uint64_t>());
    EXPECT_EQ((*file)->info().point_format, want["format"].get<int>());
    const auto hash = records_hash(**file);
    ASSERT_TRUE(hash) << base::to_string(hash.error());
    if (!formats::has_wave_packet((*file)->header().format)) {
      EXPECT_EQ(*hash, want["records_sha256"].get<std::string>());
    }
    const auto points = all_of(**file);
    ASSERT_TRUE(points);
    std::map<std::string, std::uint64_t> classes;
    geometry::Box3 box;
    for (const auto& p : *points) {
      ++classes[std::to_string(p.classification)];
      box.add(p.position);
    }
    if (want.contains("classes") && want["classes"].is_object()) {
      EXPECT_EQ(nlohmann::json(classes), want["classes"]);
    }
    ++read;
    if (points->empty() || !want.contains("min")) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto of = [&](geometry::Point3 p) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; };
      EXPECT_NEAR(of(box.least), want["min"][axis].get<double>(), 1e-6);
      EXPECT_NEAR(of(box.most), want["max"][axis].get<double>(), 1e-6);
    }
  }
  EXPECT_GE(read, 50U);
}

TEST(Points, of_twins_are_the_same) {
  NEEDS_SHARED_DATA();
  const auto in = shared / "variety";
  for (const auto& [a, b] :
       std::vector<std::pair<std::string, std::string>>{{"point10.las", "point10.las.laz"},
                                                        {"extrabytes.las", "extrabytes.laz"},
                                                        {"pdrf6-1.4.las", "pdrf6-1.4.laz"},
                                                        {"pdrf8-1.4.las", "pdrf8-1.4.laz"},
                                                        {"pdrf10-1.4.las", "pdrf10-1.4.laz"},
                                                        {"delft_small.las", "delft_small_chunks500.laz"},
                                                        {"delft_small.las", "delft_small_chunktable_at_end.laz"},
                                                        {"delft_small.las", "delft_small_variable_chunks.laz"}}) {
    auto one = formats::LasFile::open(in / a), other = formats::LasFile::open(in / b);
    ASSERT_TRUE(one && other) << a << " " << b;
    EXPECT_EQ(*records_hash(**one), *records_hash(**other)) << a << " " << b;
  }
}

TEST(Points, of_the_files_that_ship_are_those_of_two_other_decoders) {
  const std::map<std::string, std::pair<std::uint64_t, std::string>> want{
#include "points/hashes.inc"
  };
  for (const auto& [name, known] : want) {
    auto file = formats::LasFile::open(own / name);
    ASSERT_TRUE(file) << name << ": " << base::to_string(file.error());
    EXPECT_EQ((*file)->info().points, known.first) << name;
    const auto hash = records_hash(**file);
    ASSERT_TRUE(hash) << name << ": " << base::to_string(hash.error());
    EXPECT_EQ(*hash, known.second) << name;
  }
}

TEST(Points, of_laz_with_waveforms_have_all_but_these) {
  for (const auto& [name, format] : {std::pair("waves9.laz", 9), std::pair("waves10.laz", 10)}) {
    SCOPED_TRACE(name);
    const auto cloud = formats::open_points(own / name);
    ASSERT_TRUE(cloud) << base::to_string(cloud.error());
    EXPECT_EQ((*cloud)->info().point_format, format);
    EXPECT_EQ((*cloud)->info().has_colours, format == 10);
    EXPECT_EQ((*cloud)->pieces(), 3U);
    const auto points = all_of(**cloud);
    ASSERT_TRUE(points) << base::to_string(points.error());
    ASSERT_EQ(points->size(), 150U);
    const auto& p = (*points)[77];  // as LASzip reads it
    EXPECT_NEAR(p.position.x, 84800.81, 1e-6);
    EXPECT_NEAR(p.position.y, 447401.22, 1e-6);
    EXPECT_NEAR(p.position.z, 0.23, 1e-6);
    EXPECT_EQ(p.intensity, 1522);
    EXPECT_EQ(p.return_number, 1);
    EXPECT_EQ(p.returns, 1);
    EXPECT_EQ((*points)[74].classification, 67);
    EXPECT_EQ((*points)[77].source, 12);
    EXPECT_TRUE((*points)[62].withheld);
    EXPECT_EQ((*points)[77].colour[1], format == 10 ? 256 * 77 : 0);
  }
}

TEST(Points, of_laz_with_waveforms_of_formats_4_and_5_are_refused_and_the_error_says_what_to_do) {
  for (const auto& [name, other] : {std::pair("waves4.laz", "format 1"), std::pair("waves5.laz", "format 3")}) {
    const auto cloud = formats::open_points(own / name);
    ASSERT_FALSE(cloud) << name;
    EXPECT_EQ(cloud.error().code, "ingest-points-unsupported");
    EXPECT_THAT(cloud.error().message, HasSubstr("convert it to LAS with laszip"));
    EXPECT_THAT(cloud.error().message, HasSubstr(other));
  }
}

/// All points, or an error in one line.
void expect_points_or_one_line(const fs::path& path) {
  const auto points = points_in(path);
  if (points) return;
  EXPECT_THAT(points.error().code,
              testing::AnyOf("ingest-points-format", "ingest-points-truncated", "ingest-points-unsupported"));
  EXPECT_THAT(points.error().message, Not(HasSubstr("\n")));
  EXPECT_THAT(points.error().message, HasSubstr(";"));
}

TEST(Points, of_damaged_chunks_with_waveforms_are_read_or_an_error_in_one_line) {
  const test::Scratch folder;
  base::Random random(7);
  const auto place = [&](std::size_t from, std::size_t to) {
    return static_cast<std::size_t>(random.uniform(static_cast<double>(from), static_cast<double>(to)));
  };
  for (const auto* name : {"waves9.laz", "waves10.laz"}) {
    const auto bytes = *base::read_file(own / name);
    std::uint32_t points = 0;
    std::memcpy(&points, bytes.data() + 96, 4);
    for (int i = 0; i < 300; ++i) {
      SCOPED_TRACE(std::string(name) + " " + std::to_string(i));
      auto damaged = bytes;
      if (i % 3 == 0) damaged.resize(place(points, bytes.size()));
      // The first record and the sizes of layers of the first chunk, then anything.
      const std::size_t at = place(points, i % 3 == 1 ? points + 150 : damaged.size());
      if (at < damaged.size()) damaged[at] = static_cast<char>(place(0, 256));
      ASSERT_TRUE(base::write_file(folder / "a.laz", damaged));
      expect_points_or_one_line(folder / "a.laz");
    }
  }
}

TEST(WaveLayers, that_do_not_agree_with_their_chunk_are_an_error) {
  // Format 9 without extra bytes: a record of 59 bytes, the count, the sizes of nine layers and of the packets.
  const auto chunk = [](std::uint32_t count, std::uint32_t packets, std::size_t bytes) {
    std::string out(59, 'r');
    for (const std::uint32_t word : {count, 1U, 1U, 0U, 0U, 0U, 0U, 0U, 0U, 0U, packets})
      out.append(reinterpret_cast<const char*>(&word), sizeof word);
    return out + std::string("xz") + std::string(bytes, 'w');
  };
  const auto without = [](const std::string& bytes) { return formats::without_wave_packets(bytes, 9, 59, 5, "a"); };
  const auto good = without(chunk(5, 3, 3));
  ASSERT_TRUE(good);
  EXPECT_EQ(good->size(), 30U + 4 + 9 * 4 + 2);
  EXPECT_TRUE(good->ends_with("xz"));
  EXPECT_THAT(without(chunk(4, 3, 3)).error().message, HasSubstr("counts 4 points instead of 5"));
  EXPECT_THAT(without(chunk(5, 4, 3)).error().message, HasSubstr("longer than the chunk"));
  EXPECT_THAT(without(chunk(5, ~0U, 3)).error().message, HasSubstr("longer than the chunk"));
  EXPECT_THAT(without(chunk(5, 3, 3).substr(0, 100)).error().message, HasSubstr("ends before its layers"));
  EXPECT_FALSE(without(""));
}

/// Broken files that are still read, with the number of their points; all others are errors.
auto readable() -> std::map<std::string, std::size_t> {
  return {{"bad-geotiff-keys.las", 10},
          {"bad_vlr_count.las", 10},
          {"bounds_swapped_nan.las", 3539},
          {"gps-time-nan.las", 1},
          {"vlr_count_4_billion.las", 3539},
          {"vlr_length_65535.las", 3539},
          {"copc_evlr_beyond_end.copc.laz", 1065},
          {"copc_halfsize_nan.copc.laz", 1065},
          {"copc_node_count_wrong.copc.laz", 1065},
          {"copc_node_offset_beyond_end.copc.laz", 1065},
          {"copc_page_beyond_end.copc.laz", 1065},
          {"copc_page_refers_to_itself.copc.laz", 1065},
          {"copc_root_page_4_exabytes.copc.laz", 1065}};
}

TEST(Points, of_broken_files_are_all_there_or_an_error_says_what_is_wrong) {
  NEEDS_SHARED_DATA();
  const auto yes = readable();
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(shared / "broken")) {
    const auto name = entry.path().filename().string();
    SCOPED_TRACE(name);
    ++files;
    const auto points = points_in(entry.path());
    if (const auto at = yes.find(name); at != yes.end()) {
      ASSERT_TRUE(points) << base::to_string(points.error());
      EXPECT_EQ(points->size(), at->second);
      continue;
    }
    ASSERT_FALSE(points);
    const auto& error = points.error();
    EXPECT_THAT(error.code, testing::AnyOf("ingest-points-format", "ingest-points-truncated",
                                           "ingest-points-unsupported", "file-missing"));
    EXPECT_THAT(error.subject, HasSubstr(name));
    EXPECT_THAT(error.message, Not(HasSubstr("\n")));
    EXPECT_THAT(error.message, HasSubstr(";"));  // what to do
  }
  EXPECT_GE(files, 43U);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  EXPECT_LT(usage.ru_maxrss, 1'000'000) << "kB";
}

TEST(Points, of_a_damaged_octree_are_read_without_it_and_a_warning_says_so) {
  NEEDS_SHARED_DATA();
  const auto cloud = formats::open_points(shared / "broken/copc_page_refers_to_itself.copc.laz");
  ASSERT_TRUE(cloud);
  ASSERT_THAT((*cloud)->info().warnings, Not(IsEmpty()));
  EXPECT_EQ((*cloud)->info().warnings[0].code, "ingest-points-index");
  EXPECT_EQ((*cloud)->info().format, "LAZ 1.4");
}

TEST(Points, of_a_chunk_that_lacks_its_last_byte_are_an_error) {
  auto bytes = *base::read_file(own / "pdrf6-1.4.laz");
  auto file = formats::LasFile::open(own / "pdrf6-1.4.laz");
  ASSERT_TRUE(file);
  // The table of chunks is compressed too, so the chunk is made to end elsewhere by the offset of the points.
  std::uint32_t points = 0;
  std::memcpy(&points, bytes.data() + 96, 4);
  bytes.erase(points + 8, 1);
  std::uint64_t table = 0;
  std::memcpy(&table, bytes.data() + points, 8);
  --table;
  std::memcpy(bytes.data() + points, &table, 8);
  const test::Scratch folder;
  ASSERT_TRUE(base::write_file(folder / "a.laz", bytes));
  const auto read = points_in(folder / "a.laz");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, "ingest-points-format");
}

TEST(Points, after_a_fault_and_at_the_same_time_are_decoded_as_alone) {
  NEEDS_SHARED_DATA();
  auto file = formats::LasFile::open(shared / "delft_west.copc.laz");
  ASSERT_TRUE(file);
  const auto broken = formats::LasFile::open(shared / "broken/chunk_bytes_flipped.laz");
  ASSERT_TRUE(broken);
  std::vector<std::string> hashes((*file)->pieces());
  base::parallel_for(hashes.size(), [&](std::size_t i) {
    static_cast<void>((*broken)->records(i % (*broken)->pieces()));
    hashes[i] = formats::sha256(*(*file)->records(i));
  });
  for (std::size_t i = 0; i < hashes.size(); ++i) EXPECT_EQ(hashes[i], formats::sha256(*(*file)->records(i))) << i;
}

TEST(Points, of_copc_lie_in_the_boxes_of_their_nodes) {
  NEEDS_SHARED_DATA();
  for (const auto* name : {"delft_west.copc.laz", "variety/ellipsoid.copc.laz", "variety/simple_with_page.copc.laz"}) {
    const auto cloud = formats::open_points(shared / name);
    ASSERT_TRUE(cloud) << name;
    EXPECT_THAT((*cloud)->info().format, HasSubstr("COPC"));
    for (std::size_t i = 0; i < (*cloud)->pieces(); ++i) {
      const auto box = (*cloud)->box_of(i);
      ASSERT_TRUE(box);
      const auto points = (*cloud)->read(i);
      ASSERT_TRUE(points);
      for (const auto& p : *points) {
        EXPECT_TRUE(p.position.x >= box->least.x && p.position.x <= box->most.x);
        EXPECT_TRUE(p.position.y >= box->least.y && p.position.y <= box->most.y);
        EXPECT_TRUE(p.position.z >= box->least.z && p.position.z <= box->most.z);
      }
    }
  }
}

TEST(Points, of_ept_are_all_levels_together) {
  NEEDS_SHARED_DATA();
  for (const auto& [name, count] : {std::pair("autzen_one_node", 1065U), std::pair("ellipsoid", 100000U)}) {
    const auto cloud = formats::open_points(shared / "ept" / name);
    ASSERT_TRUE(cloud) << base::to_string(cloud.error());
    EXPECT_EQ((*cloud)->info().points, count);
    EXPECT_TRUE((*cloud)->info().crs);
    const auto points = all_of(**cloud);
    ASSERT_TRUE(points) << base::to_string(points.error());
    EXPECT_EQ(points->size(), count);
    EXPECT_GT((*cloud)->inputs()->size(), 1U);
  }
}

TEST(Points, of_ply_have_doubles_and_classes_in_either_byte_order) {
  NEEDS_SHARED_DATA();
  const auto las = points_in(shared / "variety/delft_small.las");
  ASSERT_TRUE(las);
  for (const auto* name : {"delft_small_double.ply", "delft_small_double_bigendian.ply"}) {
    ASSERT_TRUE(formats::is_point_cloud(shared / "ply" / name));
    const auto ply = points_in(shared / "ply" / name);
    ASSERT_TRUE(ply) << base::to_string(ply.error());
    ASSERT_EQ(ply->size(), las->size());
    for (std::size_t i = 0; i < ply->size(); ++i) {
      EXPECT_NEAR((*ply)[i].position.x, (*las)[i].position.x, 1e-9);
      EXPECT_NEAR((*ply)[i].position.z, (*las)[i].position.z, 1e-9);
      EXPECT_EQ((*ply)[i].classification, (*las)[i].classification);
    }
  }
  EXPECT_EQ(points_in(shared / "ply/cgal_b9.ply")->size(), 22300U);
  EXPECT_EQ(points_in(shared / "ply/cgal_b9_training.ply")->size(), 22300U);
  EXPECT_EQ(points_in(shared / "ply/pdal_simple_binary.ply")->size(), 3U);
  EXPECT_TRUE(formats::is_point_cloud(shared / "ply/cgal_b9.ply")) << "an empty face element is no mesh";
  EXPECT_FALSE(formats::is_point_cloud(fs::path(MANSARD_DATA) / "delft/mesh.ply"));
}

struct Place {
  std::string file;
  double horizontal = 1, vertical = 1;  // metres a unit
  std::string title;
};

TEST(Points, say_where_they_are_and_in_which_unit) {
  NEEDS_SHARED_DATA();
  constexpr double us = 1200.0 / 3937;
  const std::vector<Place> places{
      {"delft_west.laz", 1, 1, "EPSG:28992"},
      {"delft_west.copc.laz", 1, 1, "EPSG:7415"},
      {"variety/point10.las", 1, 1, "EPSG:26910"},
      {"variety/mvk-thin.las", us, us,
       "Mississippi West in US survey foot"},  // the code is of a system in metres, the unit key says feet
      {"variety/file_with_both_wkt_and_geotiff_vlrs.las", us, us, "Nebraska"},
      {"variety/autzen_trim.laz", 0.3048, 0.3048, ""},
      {"variety/append-bug.laz", 1, 1, "EPSG:2154"},
      {"variety/1_4_w_evlr.las", us, us, ""},
      {"variety/simple.copc.laz", 1, us, ""},
  };
  for (const auto& place : places) {
    SCOPED_TRACE(place.file);
    const auto cloud = formats::open_points(shared / place.file);
    ASSERT_TRUE(cloud);
    const auto& info = (*cloud)->info();
    ASSERT_TRUE(info.crs);
    EXPECT_THAT(info.crs_title, HasSubstr(place.title));
    EXPECT_NEAR(*info.crs->height_unit, place.vertical, 1e-9);
    const auto system = crs::from_wkt(info.crs->wkt);
    ASSERT_TRUE(system);
    EXPECT_NEAR(system->system.GetLinearUnits(), place.horizontal, 1e-9);
    if (place.file != "variety/mvk-thin.las") continue;
    // In Mississippi, and not three times as far from the origin.
    const auto degrees = crs::WayOfMesh::between(*info.crs, "EPSG:32615", "");
    ASSERT_TRUE(degrees) << base::to_string(degrees.error());
    std::array<geometry::Point3, 1> middle{0.5 * (info.stated_bounds->least + info.stated_bounds->most)};
    degrees->take(middle);
    EXPECT_NEAR(middle[0].x, 750'000, 150'000);
    EXPECT_NEAR(middle[0].y, 3'550'000, 350'000);
  }
}

TEST(Las, that_is_written_is_read_back_to_the_millimetre) {
  std::vector<CloudPoint> points(3);
  points[0].position = {1.2344, -2.5, 3};
  points[0].classification = 6;
  points[1].position = {100, 200, -0.5};
  points[1].returns = 3;
  points[1].return_number = 2;
  points[1].intensity = 65535;
  points[2].position = {0.0004, 0.0006, 0};
  points[2].withheld = true;
  points[2].source = 513;
  const model::Frame frame{{84800, 447400, -3}, "EPSG:28992"};
  const auto bytes = formats::las(points, frame);
  ASSERT_TRUE(bytes) << base::to_string(bytes.error());
  const test::Scratch folder;
  ASSERT_TRUE(base::write_file(folder / "a.las", *bytes));
  const auto cloud = formats::open_points(folder / "a.las");
  ASSERT_TRUE(cloud) << base::to_string(cloud.error());
  EXPECT_THAT((*cloud)->info().crs_title, HasSubstr("EPSG:28992"));
  EXPECT_THAT((*cloud)->info().warnings, IsEmpty());
  const auto read = all_of(**cloud);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR((*read)[i].position.x, points[i].position.x + 84800, 0.00051);
    EXPECT_NEAR((*read)[i].position.y, points[i].position.y + 447400, 0.00051);
    EXPECT_NEAR((*read)[i].position.z, points[i].position.z - 3, 0.00051);
    EXPECT_EQ((*read)[i].classification, points[i].classification);
    EXPECT_EQ((*read)[i].returns, points[i].returns);
    EXPECT_EQ((*read)[i].return_number, points[i].return_number);
    EXPECT_EQ((*read)[i].intensity, points[i].intensity);
    EXPECT_EQ((*read)[i].withheld, points[i].withheld);
    EXPECT_EQ((*read)[i].source, points[i].source);
  }
  ASSERT_TRUE((*cloud)->info().stated_bounds);
  EXPECT_NEAR((*cloud)->info().stated_bounds->most.y, 447600, 1e-6);
  points[0].position.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(formats::las(points, frame).error().code, "write-las");
}

TEST(Las, points_without_a_source_have_that_of_the_file) {
  std::vector<CloudPoint> points(2);
  points[1].source = 3;
  auto bytes = *formats::las(points, {});
  bytes[4] = 7;  // the file source ID
  const test::Scratch folder;
  ASSERT_TRUE(base::write_file(folder / "a.las", bytes));
  const auto read = points_in(folder / "a.las");
  ASSERT_TRUE(read) << base::to_string(read.error());
  EXPECT_EQ((*read)[0].source, 7);
  EXPECT_EQ((*read)[1].source, 3);
}

TEST(Ply, and_text_have_sources_of_points) {
  const test::Scratch folder;
  ASSERT_TRUE(base::write_file(folder / "a.ply",
                               "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                               "property float z\nproperty ushort point_source_id\nend_header\n1 2 3 412\n"));
  ASSERT_TRUE(base::write_file(folder / "a.csv", "X,Y,Z,PointSourceId\n1,2,3,412\n"));
  for (const auto* name : {"a.ply", "a.csv"}) {
    const auto read = points_in(folder / name);
    ASSERT_TRUE(read) << base::to_string(read.error());
    EXPECT_EQ((*read)[0].source, 412) << name;
  }
}

TEST(Las, that_is_written_has_colours_where_a_point_has_one) {
  std::vector<CloudPoint> points(2);
  points[0].position = {1, 2, 3};
  points[0].classification = 6;
  points[1].position = {4, 5, 6};
  points[1].colour = {65535, 257, 1};
  const auto bytes = formats::las(points, {});
  ASSERT_TRUE(bytes) << base::to_string(bytes.error());
  const test::Scratch folder;
  ASSERT_TRUE(base::write_file(folder / "a.las", *bytes));
  const auto cloud = formats::open_points(folder / "a.las");
  ASSERT_TRUE(cloud) << base::to_string(cloud.error());
  EXPECT_EQ((*cloud)->info().point_format, 7);
  EXPECT_TRUE((*cloud)->info().has_colours);
  const auto read = all_of(**cloud);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->size(), 2U);
  EXPECT_EQ((*read)[0].colour, points[0].colour);
  EXPECT_EQ((*read)[1].colour, points[1].colour);
  EXPECT_EQ((*read)[0].classification, 6);
}

TEST(ChunkTable, that_is_cut_off_or_promises_too_much_is_an_error) {
  EXPECT_FALSE(formats::read_chunk_table("", true, 10, "a"));
  EXPECT_FALSE(formats::read_chunk_table(std::string(8, '\1'), true, 10, "a"));
  std::string many(8, '\0');
  many[7] = '\x7f';
  EXPECT_THAT(formats::read_chunk_table(many, true, 10, "a").error().message, HasSubstr("space for 10"));
  std::string three(8, '\0');
  three[4] = '\3';
  EXPECT_THAT(formats::read_chunk_table(three, true, 10, "a").error().message, HasSubstr("cut off"));
  EXPECT_TRUE(formats::read_chunk_table(std::string(8, '\0'), true, 10, "a")->empty());
}

}  // namespace
