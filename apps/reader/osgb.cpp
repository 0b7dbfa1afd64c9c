// OSGB by OpenSceneGraph.
#include <osg/Geometry>
#include <osg/Notify>
#include <osg/PagedLOD>
#include <osg/Switch>
#include <osg/Texture2D>
#include <osg/Transform>
#include <osg/TriangleIndexFunctor>
#include <osgDB/Options>
#include <osgDB/ReaderWriter>
#include <osgDB/Registry>

#include <algorithm>
#include <iterator>
#include <map>
#include <sstream>

#include "apps/reader/reader.hpp"

namespace mansard::reader {
namespace {

using formats::outside::Scene;

/// A picture as the file has it: compressed, in the file or beside it.
class KeptImage : public osg::Image {
 public:
  std::string bytes, file;
};

/// Keeps pictures as they are where the library would decode all of them.
class Keeper : public osgDB::ReaderWriter {
 public:
  Keeper() {
    for (const char* extension : {"jpg", "jpeg", "png", "webp", "tif", "tiff", "bmp", "tga", "dds", "rgb"})
      supportsExtension(extension, "a picture that is kept as it is");
  }
  [[nodiscard]] auto className() const -> const char* override { return "mansard's keeper of pictures"; }
  auto readImage(std::istream& in, const osgDB::Options* /*options*/) const -> ReadResult override {
    osg::ref_ptr<KeptImage> kept = new KeptImage;
    in.exceptions(std::ios::goodbit);  // its end is where it ends
    kept->bytes.assign(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    return {kept.get()};
  }
  auto readImage(const std::string& file, const osgDB::Options* /*options*/) const -> ReadResult override {
    osg::ref_ptr<KeptImage> kept = new KeptImage;
    kept->file = file;
    return {kept.get()};
  }
};

/// The library's reader of OSGB, a plugin.
auto plugin() -> osgDB::ReaderWriter& {
  static osgDB::ReaderWriter* const found = [] {
    osg::setNotifyLevel(osg::ALWAYS);  // what is wrong is in the results of reading
    osgDB::Registry* registry = osgDB::Registry::instance();
    registry->addReaderWriter(new Keeper);
    return registry->getReaderWriterForExtension("osgb");
  }();
  if (found == nullptr) throw Wrong("OpenSceneGraph's plugin for OSGB is not installed");
  return *found;
}

struct Triangles {
  std::vector<std::array<std::uint32_t, 3>>* out = nullptr;
  void operator()(unsigned a, unsigned b, unsigned c) { out->push_back({a, b, c}); }
};

class OsgWalk {
 public:
  explicit OsgWalk(Scene& scene) : scene_(scene) {}

  /// The node's number in the scene.
  auto take(osg::Node& node, const osg::Matrixd& place, int depth) -> std::uint32_t {
    constexpr int deepest = 200;  // exporters nest a handful of nodes in a file, and levels in files
    if (depth > deepest) throw Wrong("its nodes are nested too deeply");
    const auto number = static_cast<std::uint32_t>(scene_.nodes.size());
    scene_.nodes.emplace_back();
    if (auto* geometry = node.asGeometry()) {
      take(*geometry, place, number);
    } else if (auto* lod = dynamic_cast<osg::LOD*>(&node)) {
      take_levels(*lod, place, depth, number);
    } else if (osg::Group* group = node.asGroup()) {
      osg::Matrixd own = place;
      if (auto* transform = node.asTransform()) transform->computeLocalToWorldMatrix(own, nullptr);
      const auto* choice = node.asSwitch();
      for (unsigned i = 0; i < group->getNumChildren(); ++i)
        if (group->getChild(i) != nullptr && (choice == nullptr || choice->getValue(i)))
          add(number, {0, "", take(*group->getChild(i), own, depth + 1)});
    }
    return number;
  }

 private:
  void add(std::uint32_t node, formats::outside::Node::Child child) {
    scene_.nodes[node].children.push_back(std::move(child));
  }

  void take_levels(osg::LOD& lod, const osg::Matrixd& place, int depth, std::uint32_t number) {
    const auto* paged = dynamic_cast<const osg::PagedLOD*>(&lod);
    const unsigned files = paged != nullptr ? paged->getNumFileNames() : 0;
    // By size on screen, the finest level is that of the largest sizes; by distance, that of the smallest distances.
    const bool by_size = lod.getRangeMode() == osg::LOD::PIXEL_SIZE_ON_SCREEN;
    for (unsigned i = 0; i < std::max(lod.getNumChildren(), files); ++i) {
      const float nearest = i < lod.getNumRanges() ? lod.getMinRange(i) : 0;
      const float rank = by_size ? -nearest : nearest;
      if (i < lod.getNumChildren() && lod.getChild(i) != nullptr)
        add(number, {rank, "", take(*lod.getChild(i), place, depth + 1)});
      else if (i < files && !paged->getFileName(i).empty()) add(number, {rank, paged->getFileName(i), 0});
    }
  }

  void take(osg::Geometry& part, const osg::Matrixd& place, std::uint32_t number) {
    formats::outside::Mesh mesh;
    const auto add_all = [&](const auto& vertices) {
      for (const auto& v : vertices) {
        const osg::Vec3d p = osg::Vec3d(v.x(), v.y(), v.z()) * place;
        mesh.vertices.push_back({p.x(), p.y(), p.z()});
      }
    };
    const auto* array = part.getVertexArray();
    if (const auto* single = dynamic_cast<const osg::Vec3Array*>(array)) add_all(*single);
    else if (const auto* full = dynamic_cast<const osg::Vec3dArray*>(array)) add_all(*full);
    else return;
    osg::TriangleIndexFunctor<Triangles> triangles;
    triangles.out = &mesh.triangles;
    part.accept(triangles);
    if (const auto* uv = dynamic_cast<const osg::Vec2Array*>(part.getTexCoordArray(0));
        uv != nullptr && uv->size() == mesh.vertices.size()) {
      for (const auto& t : *uv) mesh.uv.push_back({t.x(), t.y()});
      mesh.picture = picture_of(part);
    }
    take_colours(part, mesh);
    scene_.nodes[number].meshes.push_back(static_cast<std::uint32_t>(scene_.meshes.size()));
    scene_.meshes.push_back(std::move(mesh));
  }

  static void take_colours(const osg::Geometry& part, formats::outside::Mesh& mesh) {
    const auto byte = [](float value) { return static_cast<std::uint8_t>(std::clamp(value * 255, 0.F, 255.F) + 0.5F); };
    if (const auto* bytes = dynamic_cast<const osg::Vec4ubArray*>(part.getColorArray()))
      for (const auto& c : *bytes) mesh.colours.push_back({c.r(), c.g(), c.b()});
    if (const auto* floats = dynamic_cast<const osg::Vec4Array*>(part.getColorArray()))
      for (const auto& c : *floats) mesh.colours.push_back({byte(c.r()), byte(c.g()), byte(c.b())});
    if (part.getColorBinding() == osg::Geometry::BIND_OVERALL && mesh.colours.size() > 1) mesh.colours.resize(1);
  }

  auto picture_of(const osg::Geometry& part) -> std::int32_t {
    // Attributes of the nodes above are not looked for: exporters set the texture on the geometry.
    const auto* state = part.getStateSet();
    const auto* texture =
        state == nullptr
            ? nullptr
            : dynamic_cast<const osg::Texture2D*>(state->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
    const auto* image = texture != nullptr ? dynamic_cast<const KeptImage*>(texture->getImage()) : nullptr;
    if (image == nullptr) return -1;
    const auto [found, is_new] = numbers_.emplace(texture, static_cast<std::int32_t>(scene_.pictures.size()));
    if (!is_new) return found->second;
    const auto wrap = [&](osg::Texture::WrapParameter side) -> std::uint8_t {
      const auto mode = texture->getWrap(side);
      return mode == osg::Texture::REPEAT ? 0 : mode == osg::Texture::MIRROR ? 2 : 1;
    };
    scene_.pictures.push_back({image->bytes,
                               image->file.empty() ? image->getFileName() : image->file,
                               {wrap(osg::Texture::WRAP_S), wrap(osg::Texture::WRAP_T)}});
    return found->second;
  }

  Scene& scene_;
  std::map<const osg::Texture2D*, std::int32_t> numbers_;
};

}  // namespace

auto read_osgb(std::string_view bytes) -> Scene {
  std::istringstream stream{std::string(bytes)};
  // The library does not look whether there was something to read.
  stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
  const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
  options->setObjectCacheHint(osgDB::Options::CACHE_NONE);
  osg::ref_ptr<osg::Node> node;
  try {
    auto read = plugin().readNode(stream, options.get());
    if (!read.validNode()) throw Wrong(read.message().empty() ? "it has no scene" : read.message());
    node = read.getNode();
  } catch (const std::ios_base::failure&) {
    throw Truncated();
  }
  Scene scene;
  (void)OsgWalk(scene).take(*node, osg::Matrixd::identity(), 0);
  return scene;
}

}  // namespace mansard::reader
