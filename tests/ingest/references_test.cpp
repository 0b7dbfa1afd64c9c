// Every kind of reference from inside an input, each to what is outside: nothing is opened there, and nobody is called.
#include <cstdlib>
#include <functional>
#include <map>

#include "ingest/gltf_workshop.hpp"
#include "ingest/watched.hpp"
#include "mansard/formats/files/reach.hpp"
#include "mansard/formats/ground_picture.hpp"
#include "mansard/formats/image.hpp"
#include "mansard/formats/source.hpp"
#include "mansard/formats/stream.hpp"
#include "mansard/formats/textured_mesh.hpp"
#include "mansard/ingest/join.hpp"
#include "mansard/ingest/model.hpp"

namespace mansard::ingest::test {
namespace {

/// What a file names: any kind of file, under all names with which it could be reached.
struct Target {
  std::string name;  ///< of the file: "secret.png"
  std::string bytes;
};

auto targets() -> const std::map<std::string, Target>& {
  static const std::map<std::string, Target> all{
      {"picture", {"secret.ppm", "P6 2 2 255\n" + std::string(12, 'x')}},
      {"heights", {"secret.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n"}},
      {"polygons",
       {"secret.geojson",
        R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":{"type":"Polygon",)"
        R"("coordinates":[[[0,0],[9,0],[9,9],[0,0]]]}}]})"}},
      {"bytes", {"secret.bin", std::string(36, 'x')}},
      {"materials", {"secret.mtl", "newmtl m\nKd 1 0 0\n"}},
      {"mesh", {"secret.glb", "glTF"}},
      {"tileset", {"secret.json", "{}"}},
      {"xml", {"secret.xsd", "<x/>"}},
  };
  return all;
}

struct Case {
  std::string name;
  std::string target;   ///< key of targets()
  std::string file;     ///< the input
  std::string text;     ///< of the input: @ stands for the reference
  bool by_path = true;  ///< with MANSARD_OUTSIDE=yes a path leads there: the test sees what is opened
};

constexpr const char* triangle = "v 0 0 0\nv 9 0 0\nv 9 9 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";
constexpr const char* dem = R"(<VRTDataset rasterXSize="2" rasterYSize="2"><GeoTransform>0,1,0,2,0,-1</GeoTransform>)";
constexpr const char* one_to_one = R"(<SourceBand>1</SourceBand><SrcRect xOff="0" yOff="0" xSize="2" ySize="2"/>)"
                                   R"(<DstRect xOff="0" yOff="0" xSize="2" ySize="2"/>)";

auto float_band(const std::string& inside) -> std::string {
  return std::string(dem) + R"(<VRTRasterBand dataType="Float32" band="1">)" + inside + "</VRTRasterBand></VRTDataset>";
}

auto gltf(const std::string& buffer, const std::string& image) -> std::string {
  Json json = plain_gltf(3, 3);
  json["buffers"][0]["uri"] = buffer;
  if (!image.empty()) {
    json["images"] = {{{"uri", image}}};
    json["textures"] = {{{"source", 0}}};
    json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    json["meshes"][0]["primitives"][0]["material"] = 0;
  }
  return json.dump();
}

auto tileset(const Json& root) -> std::string {
  return Json{{"asset", {{"version", "1.1"}}}, {"geometricError", 1}, {"root", root}}.dump();
}

auto cases() -> std::vector<Case> {
  const Json volume{{"box", {0, 0, 0, 9, 0, 0, 0, 9, 0, 0, 0, 9}}};
  const auto tile = [&](const Json& more) {
    Json root{{"boundingVolume", volume}, {"geometricError", 0}};
    root.update(more);
    return tileset(root);
  };
  const auto ogr = [](const std::string& inside) {
    return "<OGRVRTDataSource><OGRVRTLayer name=\"secret\">" + inside + "</OGRVRTLayer></OGRVRTDataSource>";
  };
  const std::string gml_head = R"(<gml:FeatureCollection xmlns:gml="http://www.opengis.net/gml" )"
                               R"(xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:xlink=)"
                               R"("http://www.w3.org/1999/xlink" xmlns:t="http://t")";
  const std::string gml_body =
      R"(<gml:featureMember><t:a><t:g><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>)"
      R"(0 0 9 0 9 9 0 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></t:g></t:a>)"
      R"(</gml:featureMember></gml:FeatureCollection>)";
  return {
      {"obj_mtllib", "materials", "a.obj", std::string("mtllib @\n") + triangle},
      {"obj_mtl_map_kd", "picture", "a.obj", std::string("mtllib a.mtl\n") + triangle},
      {"ply_texture_file", "picture", "a.ply",
       "ply\nformat ascii 1.0\ncomment TextureFile @\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
       "float z\nproperty float s\nproperty float t\nelement face 1\nproperty list uchar int "
       "vertex_indices\nend_header\n"
       "0 0 0 0 0\n9 0 0 1 0\n9 9 0 1 1\n3 0 1 2\n"},
      {"gltf_buffer", "bytes", "a.gltf", gltf("@", "")},
      {"gltf_image", "picture", "a.gltf",
       gltf("data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAEAAAACAAAA",
            "@")},
      {"tiles_content", "mesh", "tileset.json", tile({{"content", {{"uri", "@"}}}})},
      {"tiles_external", "tileset", "tileset.json", tile({{"content", {{"uri", "@"}}}})},
      {"tiles_subtree", "tileset", "tileset.json",
       tile({{"content", {{"uri", "{level}/{x}/{y}.glb"}}},
             {"implicitTiling",
              {{"subdivisionScheme", "QUADTREE"},
               {"availableLevels", 1},
               {"subtreeLevels", 1},
               {"subtrees", {{"uri", "@?{level}{x}{y}"}}}}}}),
       false},
      {"dae_image", "picture", "a.dae",
       R"(<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><library_images><image id="i">)"
       R"(<init_from>@</init_from></image></library_images><scene/></COLLADA>)",
       false},
      {"vrt_source", "heights", "a.vrt",
       float_band(std::string(R"(<SimpleSource><SourceFilename relativeToVRT="0">@</SourceFilename>)") + one_to_one +
                  "</SimpleSource>")},
      {"vrt_source_beside", "heights", "a.vrt",
       float_band(std::string(R"(<ComplexSource><SourceFilename relativeToVRT="1">@</SourceFilename>)") + one_to_one +
                  "</ComplexSource>")},
      {"vrt_raw_band", "bytes", "a.vrt",
       std::string(dem) +
           R"(<VRTRasterBand dataType="Float32" band="1" subClass="VRTRawRasterBand"><SourceFilename )"
           R"(relativetoVRT="0">@</SourceFilename><ImageOffset>0</ImageOffset><PixelOffset>4</PixelOffset>)"
           R"(<LineOffset>8</LineOffset></VRTRasterBand></VRTDataset>)"},
      {"vrt_mask", "heights", "a.vrt",
       float_band(std::string(R"(<MaskBand><VRTRasterBand dataType="Byte"><SimpleSource><SourceFilename>@)") +
                  "</SourceFilename>" + one_to_one + "</SimpleSource></VRTRasterBand></MaskBand>")},
      {"vrt_overview", "heights", "a.vrt",
       float_band(
           "<Overview><SourceFilename relativeToVRT=\"0\">@</SourceFilename><SourceBand>1</SourceBand></Overview>"),
       false},
      {"vrt_warped", "heights", "a.vrt",
       R"(<VRTDataset rasterXSize="2" rasterYSize="2" subClass="VRTWarpedDataset"><GeoTransform>0,1,0,2,0,-1)"
       R"(</GeoTransform><VRTRasterBand dataType="Float32" band="1" subClass="VRTWarpedRasterBand"/><GDALWarpOptions>)"
       R"(<SourceDataset relativeToVRT="0">@</SourceDataset><BandList><BandMapping src="1" dst="1"/></BandList>)"
       R"(</GDALWarpOptions></VRTDataset>)"},
      {"vrt_inline", "heights", "a.vrt",
       float_band(std::string("<SimpleSource><SourceFilename>&lt;VRTDataset rasterXSize=\"2\" rasterYSize=\"2\"&gt;") +
                  "&lt;VRTRasterBand dataType=\"Float32\" band=\"1\"&gt;&lt;SimpleSource&gt;&lt;SourceFilename&gt;@"
                  "&lt;/SourceFilename&gt;&lt;/SimpleSource&gt;&lt;/VRTRasterBand&gt;&lt;/VRTDataset&gt;"
                  "</SourceFilename>" +
                  one_to_one + "</SimpleSource>")},
      {"raster_overview_file", "heights", "a.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n",
       false},
      {"ers_data_file", "bytes", "a.tif",
       "DatasetHeader Begin\n\tVersion = \"6.0\"\n\tDataSetType = ERStorage\n\tDataType = Raster\n\tByteOrder = "
       "LSBFirst\n\tDataFile = \"@\"\n\tRasterInfo Begin\n\t\tCellType = IEEE4ByteReal\n\t\tNrOfLines = "
       "2\n\t\tNrOfCellsPerLine = 2\n\t\tNrOfBands = 1\n\tRasterInfo End\nDatasetHeader End\n",
       false},
      {"mrf_data_file", "bytes", "a.tif",
       "<MRF_META><Raster><Size x=\"2\" y=\"2\"/><PageSize x=\"2\" y=\"2\"/><DataFile>@</DataFile><IndexFile>@"
       "</IndexFile></Raster></MRF_META>",
       false},
      {"mrf_cached_source", "heights", "a.tif",
       "<MRF_META><CachedSource><Source>@</Source></CachedSource><Raster><Size x=\"2\" y=\"2\"/></Raster></MRF_META>",
       false},
      {"ogr_vrt_source", "polygons", "v.vrt", ogr("<SrcDataSource>@</SrcDataSource>")},
      {"ogr_vrt_source_beside", "polygons", "v.vrt", ogr(R"(<SrcDataSource relativeToVRT="1">@</SrcDataSource>)")},
      {"ogr_vrt_sql", "polygons", "v.vrt",
       ogr("<SrcDataSource>@</SrcDataSource><SrcSQL dialect=\"OGRSQL\">SELECT * FROM \"secret\"</SrcSQL>")},
      {"ogr_vrt_union", "polygons", "v.vrt",
       "<OGRVRTDataSource><OGRVRTUnionLayer name=\"u\"><OGRVRTLayer name=\"secret\"><SrcDataSource>@</SrcDataSource>"
       "</OGRVRTLayer></OGRVRTUnionLayer></OGRVRTDataSource>"},
      {"ogr_vrt_open_sql", "polygons", "v.vrt",
       ogr("<SrcDataSource>v.vrt</SrcDataSource><SrcSQL dialect=\"OGRSQL\">SELECT * FROM '@'.secret</SrcSQL>"), false},
      {"gml_schema", "xml", "g.gml", gml_head + " xsi:schemaLocation=\"http://t @\">" + gml_body, false},
      {"gml_xlink", "xml", "g.gml", gml_head + "><gml:boundedBy xlink:href=\"@#x\"/>" + gml_body, false},
      {"gml_entity", "xml", "g.gml",
       "<!DOCTYPE a [<!ENTITY e SYSTEM \"@\">]>" + gml_head + "><t:n>&e;</t:n>" + gml_body, false},
      {"gml_dtd", "xml", "g.gml", "<!DOCTYPE a SYSTEM \"@\">" + gml_head + ">" + gml_body, false},
      {"citygml_entity", "xml", "c.gml",
       "<!DOCTYPE a [<!ENTITY e SYSTEM \"@\">]><CityModel xmlns=\"http://www.opengis.net/citygml/2.0\" "
       "xmlns:bldg=\"http://www.opengis.net/citygml/building/2.0\"><cityObjectMember><bldg:Building>&e;"
       "</bldg:Building></cityObjectMember></CityModel>",
       false},
      {"citygml_picture", "picture", "c.gml",
       "<CityModel xmlns=\"http://www.opengis.net/citygml/2.0\" "
       "xmlns:app=\"http://www.opengis.net/citygml/appearance/2.0\"><app:appearanceMember><app:Appearance>"
       "<app:surfaceDataMember><app:ParameterizedTexture><app:imageURI>@</app:imageURI></app:ParameterizedTexture>"
       "</app:surfaceDataMember></app:Appearance></app:appearanceMember></CityModel>",
       false},
      {"cityjson_picture", "picture", "c.city.json",
       R"({"type":"CityJSON","version":"1.1","CityObjects":{},"vertices":[],"appearance":{"textures":[{"type":"PNG",)"
       R"("image":"@"}]}})",
       false},
      {"metadata_entity", "xml", "metadata.xml",
       "<!DOCTYPE a [<!ENTITY e SYSTEM \"@\">]><ModelMetadata><SRS>&e;</SRS>"
       "<SRSOrigin>0,0,0</SRSOrigin></ModelMetadata>",
       false},
      {"kml_network_link", "polygons", "k.kml",
       R"(<kml xmlns="http://www.opengis.net/kml/2.2"><Document><NetworkLink><Link><href>@</href></Link></NetworkLink>)"
       R"(</Document></kml>)",
       false},
      {"kml_style", "xml", "k.kml",
       R"(<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Placemark><styleUrl>@#s</styleUrl><Polygon>)"
       R"(<outerBoundaryIs><LinearRing><coordinates>0,0 9,0 9,9 0,0</coordinates></LinearRing></outerBoundaryIs>)"
       R"(</Polygon></Placemark></Document></kml>)",
       false},
      {"kml_overlay", "picture", "k.kml",
       R"(<kml xmlns="http://www.opengis.net/kml/2.2"><GroundOverlay><Icon><href>@</href></Icon><LatLonBox><north>1)"
       R"(</north><south>0</south><east>1</east><west>0</west></LatLonBox></GroundOverlay></kml>)",
       false},
      {"geojson_crs_link", "xml", "f.geojson",
       R"({"type":"FeatureCollection","crs":{"type":"link","properties":{"href":"@","type":"ogcwkt"}},"features":[]})",
       false},
      {"geojson_crs_name", "xml", "f.geojson",
       R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"@"}},"features":[]})", false},
      {"mapinfo_view", "polygons", "m.tab",
       "!table\n!version 300\nDefinition Table\n  File \"@\"\n  Type NATIVE\n  Fields 1\n    id Integer ;\n", false},
      {"wfs", "xml", "w.xml", "<OGRWFSDataSource><URL>@</URL></OGRWFSDataSource>", false},
      {"wms", "xml", "w.tif",
       "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>@/${z}/${x}/${y}.png</ServerUrl></Service>"
       "<DataWindow><UpperLeftX>0</UpperLeftX><UpperLeftY>2</UpperLeftY><LowerRightX>2"
       "</LowerRightX><LowerRightY>0</LowerRightY><SizeX>2</SizeX><SizeY>2</SizeY></DataWindow>"
       "<BandsCount>1</BandsCount></GDAL_WMS>",
       false},
      {"wcs", "xml", "w.tif", "<WCS_GDAL><ServiceURL>@?</ServiceURL><CoverageName>c</CoverageName></WCS_GDAL>", false},
      {"csw", "xml", "w.xml", "<OGRCSWDataSource><URL>@</URL></OGRCSWDataSource>", false},
      {"wmts", "xml", "w.tif", "<GDAL_WMTS><GetCapabilitiesUrl>@</GetCapabilitiesUrl></GDAL_WMTS>", false},
      {"join_table", "polygons", "t.vrt", ogr("<SrcDataSource>@</SrcDataSource>")},
  };
}

class References : public Workshop {
 protected:
  References() {
    fs::create_directories(at("in"));
    fs::create_directories(at("out"));
    for (const auto& [key, target] : targets()) file("out/" + target.name, target.bytes);
  }
  ~References() override { ::unsetenv("MANSARD_OUTSIDE"); }

  /// The reference in all ways to write it.
  auto spellings(const Target& target) -> std::vector<std::string> {
    const auto absolute = at("out/" + target.name).string();
    std::error_code status;
    fs::create_symlink(absolute, at("in/link_" + target.name), status);
    fs::create_directory_symlink(at("out"), at("in/folder"), status);
    return {absolute,
            "../out/" + target.name,
            "x/../../out/" + target.name,
            "..\\out\\" + target.name,
            "%2e%2e/out/" + target.name,
            "%2E%2E%2Fout%2F" + target.name,
            "file://" + absolute,
            "file:" + absolute,
            "file:///" + absolute.substr(1),
            "link_" + target.name,
            "folder/" + target.name,
            "/vsisubfile/0_9," + absolute,
            "/vsigzip/" + absolute,
            "/vsicached?file=" + absolute,
            "/vsicrypt/key=a,file=" + absolute};
  }
  auto servers() const -> std::vector<std::string> {
    const auto own = server_.address() + "/secret";
    return {own,
            "//127.0.0.1:" + server_.port() + "/secret",
            "\\\\127.0.0.1\\secret",
            "/vsicurl/" + own,
            "/vsicurl_streaming/" + own,
            "/vsicurl?url=" + own,
            "/vsizip/vsicurl/" + own + ".zip/a",
            "/vsizip/{/vsicurl/" + own + "}/a",
            "/vsis3/127.0.0.1:" + server_.port() + "/secret",
            "/vsistdin/",
            "/vsiwebhdfs/" + own,
            "WFS:" + own,
            "OAPIF:" + own,
            "CSW:" + own,
            "ES:" + own,
            "PG:host=127.0.0.1 port=" + server_.port() + " dbname=x connect_timeout=1",
            "postgresql://127.0.0.1:" + server_.port() + "/x?connect_timeout=1",
            "MYSQL:x,host=127.0.0.1,port=" + server_.port(),
            "NETCDF:\"" + own + "\":x",
            "HDF5:\"" + own + "\"://x",
            "SQLITE:" + at("out/secret.bin").string(),
            "GPKG:" + at("out/secret.bin").string() + ":x",
            "GTIFF_DIR:1:" + at("out/secret.asc").string(),
            "DERIVED_SUBDATASET:AMPLITUDE:" + at("out/secret.asc").string(),
            "NETCDF:\"" + at("out/secret.bin").string() + "\":x",
            "HDF5:\"" + at("out/secret.bin").string() + "\"://x"};
  }

  auto made(const Case& one, const std::string& reference) -> fs::path {
    const auto filled = [&](std::string text, const std::string& with) {
      for (std::size_t i = 0; (i = text.find('@', i)) != text.npos; i += with.size()) text.replace(i, 1, with);
      return text;
    };
    const bool json = one.text.starts_with("{");
    const auto words = json ? Json(reference).dump().substr(1, Json(reference).dump().size() - 2) : reference;
    if (one.name == "obj_mtl_map_kd") file("in/a.mtl", "newmtl m\nmap_Kd " + reference + "\n");
    if (one.name == "raster_overview_file")
      file("in/a.asc.aux.xml", "<PAMDataset><Metadata domain=\"OVERVIEWS\"><MDI key=\"OVERVIEW_FILE\">" + reference +
                                   "</MDI></Metadata></PAMDataset>");
    if (one.name == "metadata_entity") {
      file("in/metadata.xml", filled(one.text, words));
      return file("in/m.obj", triangle);
    }
    return file("in/" + one.file, filled(one.text, words));
  }

  /// Everything that reads files of others.
  void read_all(const fs::path& input) {
    const auto name = input.filename().string();
    const auto ends = [&](const char* end) { return name.ends_with(end); };
    (void)read_scene({input}, {}, {});
    if (const auto textured = formats::read_textured_file(input, formats::UpAxis::automatic)) {
      for (const auto& material : textured->materials)
        if (const auto& image = material.image; image && !image->bytes && !image->refused)
          (void)formats::read_image(image->path);
    }
    (void)read_footprints(input, {});
    (void)formats::vector_source(input);
    (void)formats::raster_source(input);
    (void)formats::read_ground_picture(input, "", 100);
    (void)read_model(input, {});
    (void)formats::tileset_source(input);
    if (ends(".vrt")) {
      model::Scene scene;
      (void)join(scene, input, "id");
    }
  }

  Listening server_;
};

TEST_F(References, lead_to_no_file_outside_of_the_folder) {
  for (const auto& one : cases()) {
    bool any = false;
    for (const auto& reference : spellings(targets().at(one.target))) {
      const auto input = made(one, reference);
      const WatchedFolder secret(at("out"));
      read_all(input);
      EXPECT_FALSE(secret.opened()) << one.name << " by " << reference;
      if (any || !one.by_path) continue;
      ::setenv("MANSARD_OUTSIDE", "yes", 1);
      read_all(input);
      ::unsetenv("MANSARD_OUTSIDE");
      any = secret.opened();
    }
    EXPECT_EQ(any, one.by_path) << "the reference of " << one.name << " is none, or its reader does not follow it";
    fs::remove_all(at("in"));
    fs::create_directories(at("in"));
  }
}

TEST_F(References, call_nobody) {
  for (const auto& one : cases()) {
    for (const auto& reference : servers()) {
      const auto input = made(one, reference);
      const WatchedFolder secret(at("out"));
      read_all(input);
      EXPECT_FALSE(server_.called()) << one.name << " by " << reference;
      EXPECT_FALSE(secret.opened()) << one.name << " by " << reference;
      if (server_.called()) return;  // it stays called
    }
    fs::remove_all(at("in"));
    fs::create_directories(at("in"));
  }
}

}  // namespace
}  // namespace mansard::ingest::test
