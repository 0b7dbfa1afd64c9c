// Bytes → a file that names another one; the first says of which kind it is, the others are the name. Reading must open
// nothing outside of the folder of the file: a folder beside it is watched, and the name is an address of a port as
// well.
#include <sys/inotify.h>

#include <array>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "fuzz/files.hpp"
#include "mansard/base/files.hpp"
#include "mansard/formats/image.hpp"
#include "mansard/formats/source.hpp"
#include "mansard/formats/textured_mesh.hpp"
#include "mansard/ingest/model.hpp"

namespace {

using namespace mansard;
using fuzz::promise;
namespace fs = std::filesystem;

/// A file of one kind: @ stands for the name that it has in it.
struct Kind {
  const char *name, *text;
};

constexpr const char* triangle = "v 0 0 0\nv 9 0 0\nv 9 9 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";

auto kinds() -> const std::vector<Kind>& {
  static const std::string obj = std::string("mtllib @\n") + triangle;
  static const std::vector<Kind> all{
      {"a.obj", obj.c_str()},
      {"p.ply",
       "ply\nformat ascii 1.0\ncomment TextureFile @\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
       "float z\nproperty float s\nproperty float t\nelement face 1\nproperty list uchar int "
       "vertex_indices\nend_header\n0 0 0 0 0\n9 0 0 1 0\n9 9 0 1 1\n3 0 1 2\n"},
      {"g.gltf",
       R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":)"
       R"([{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
       R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"@"}]})"},
      {"tileset.json",
       R"({"asset":{"version":"1.1"},"geometricError":1,"root":{"boundingVolume":{"box":[0,0,0,9,0,0,0,9,0,0,0,9]},)"
       R"("geometricError":0,"content":{"uri":"@"}}})"},
      {"r.vrt",
       R"(<VRTDataset rasterXSize="2" rasterYSize="2"><GeoTransform>0,1,0,2,0,-1</GeoTransform><VRTRasterBand dataType=)"
       R"("Float32" band="1"><SimpleSource><SourceFilename relativeToVRT="1">@</SourceFilename></SimpleSource>)"
       R"(</VRTRasterBand></VRTDataset>)"},
      {"w.vrt",
       R"(<VRTDataset rasterXSize="2" rasterYSize="2"><GeoTransform>0,1,0,2,0,-1</GeoTransform><VRTRasterBand dataType=)"
       R"("Float32" band="1" subClass="VRTRawRasterBand"><SourceFilename>@</SourceFilename></VRTRasterBand></VRTDataset>)"},
      {"v.vrt",
       "<OGRVRTDataSource><OGRVRTLayer name=\"secret\"><SrcDataSource>@</SrcDataSource></OGRVRTLayer>"
       "</OGRVRTDataSource>"},
      {"s.gml", R"(<gml:FeatureCollection xmlns:gml="http://www.opengis.net/gml" xmlns:xsi=)"
                R"("http://www.w3.org/2001/XMLSchema-instance" xsi:schemaLocation="http://t @"/>)"},
      {"c.geojson", R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"@"}},"features":[]})"}};
  return all;
}

struct Watched {
  fs::path folder = fs::temp_directory_path() / ("mansard-fuzz-references-" + std::to_string(::getpid()));
  int events = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);

  Watched() {
    base::limit_threads(1);
    fs::create_directories(folder / "in");
    fs::create_directories(folder / "out");
    for (const char* name : {"secret", "secret.png", "secret.mtl", "secret.json", "secret.geojson", "secret.glb"})
      promise(base::write_file(folder / "out" / name, "x").has_value(), "no folder to work in");
    std::error_code ignored;
    fs::create_directory_symlink(folder / "out", folder / "in/link", ignored);
    promise(::inotify_add_watch(events, (folder / "out").c_str(), IN_OPEN) >= 0, "nothing to watch with");
  }
  Watched(const Watched&) = delete;
  auto operator=(const Watched&) -> Watched& = delete;
  ~Watched() {
    ::close(events);
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }
  [[nodiscard]] auto opened() const -> bool {
    std::array<char, 4096> some{};
    return ::read(events, some.data(), some.size()) > 0;
  }
};

}  // namespace

auto LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) -> int {
  static const Watched watched;
  if (size == 0) return 0;
  const Kind& kind = kinds()[bytes[0] % kinds().size()];
  std::string name(reinterpret_cast<const char*>(bytes) + 1, size - 1);
  // "$" is the folder: a string cannot know it.
  for (std::size_t i = 0; (i = name.find('$', i)) != name.npos;) {
    const auto folder = watched.folder.string();
    name.replace(i, 1, folder);
    i += folder.size();
  }
  std::string text = kind.text;
  text.replace(text.find('@'), 1, name);
  const auto path = watched.folder / "in" / kind.name;
  promise(base::write_file(path, text).has_value(), "no folder to work in");
  try {
    (void)ingest::read_scene({path}, {}, {});
    (void)ingest::read_footprints(path, {});
    (void)formats::vector_source(path);
    if (const auto mesh = formats::read_textured_file(path, formats::UpAxis::automatic))
      for (const auto& material : mesh->materials)
        if (const auto& image = material.image; image && !image->bytes && !image->refused)
          (void)formats::read_image(image->path);
  } catch (const std::exception& thrown) {
    promise(false, "an exception left the module", [&] { return thrown.what(); });
  }
  promise(!watched.opened(), "a file outside of the folder was opened", [&] { return kind.name + (" by " + name); });
  return 0;
}
