#include "mansard/formats/image.hpp"

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal.h>

#include <array>
#include <atomic>
#include <memory>

#include "mansard/crs/gdal.hpp"
#include "mansard/crs/gdal_messages.hpp"
#include "mansard/formats/files/named_file.hpp"
#include "mansard/formats/image/memory_file.hpp"

namespace mansard::formats {
namespace {

using model::Pixels;

/// A name in memory that no other thread has.
auto fresh_name(std::string_view extension) -> std::string {
  static std::atomic<std::uint64_t> count{0};
  return "/vsimem/mansard_image_" + std::to_string(count.fetch_add(1)) + std::string(extension);
}

struct CloseDataset {
  void operator()(void* data) const { GDALClose(data); }
};
using Dataset = std::unique_ptr<void, CloseDataset>;

/// What a picture is that is not read; empty for others.
auto refused_kind(std::string_view bytes) -> std::string {
  using std::string_view_literals::operator""sv;
  if (bytes.starts_with("\xABKTX 20\xBB"sv)) return "KTX2";
  if (bytes.starts_with("\xABKTX 11\xBB"sv)) return "KTX";
  if (bytes.starts_with("DDS "sv)) return "DDS";
  if (bytes.starts_with("sB"sv)) return "Basis Universal";
  return {};
}

/// The bands of an opened picture as RGB.
auto rgb_of(GDALDatasetH data, Pixels& out) -> bool {
  const int bands = GDALGetRasterCount(data);
  const auto width = static_cast<int>(out.width), height = static_cast<int>(out.height);
  const auto count = static_cast<std::size_t>(out.width) * out.height;
  GDALRasterBandH first = GDALGetRasterBand(data, 1);
  const bool wide = GDALGetRasterDataType(first) != GDT_Byte;
  if (GDALColorTableH table = GDALGetRasterColorTable(first); table != nullptr && bands == 1 && !wide) {
    std::vector<std::uint8_t> index(count);
    if (GDALRasterIO(first, GF_Read, 0, 0, width, height, index.data(), width, height, GDT_Byte, 0, 0) != CE_None)
      return false;
    const int entries = GDALGetColorEntryCount(table);
    std::array<std::array<std::uint8_t, 3>, 256> colours{};
    for (int i = 0; i < std::min(entries, 256); ++i) {
      const GDALColorEntry* entry = GDALGetColorEntry(table, i);
      colours[static_cast<std::size_t>(i)] = {static_cast<std::uint8_t>(entry->c1),
                                              static_cast<std::uint8_t>(entry->c2),
                                              static_cast<std::uint8_t>(entry->c3)};
    }
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t c = 0; c < 3; ++c) out.rgb[3 * i + c] = colours[index[i]][c];
    return true;
  }
  for (int c = 0; c < 3; ++c) {
    GDALRasterBandH band = GDALGetRasterBand(data, bands >= 3 ? c + 1 : 1);
    if (!wide) {
      if (GDALRasterIO(band, GF_Read, 0, 0, width, height, out.rgb.data() + c, width, height, GDT_Byte, 3, 3 * width) !=
          CE_None)
        return false;
      continue;
    }
    std::vector<std::uint16_t> values(count);
    if (GDALRasterIO(band, GF_Read, 0, 0, width, height, values.data(), width, height, GDT_UInt16, 0, 0) != CE_None)
      return false;
    for (std::size_t i = 0; i < count; ++i)
      out.rgb[3 * i + static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(values[i] >> 8U);
  }
  return true;
}

}  // namespace

auto decode_image(std::string_view bytes, const std::string& name) -> base::Result<Pixels> {
  const auto bad = [&name](const std::string& what) {
    return base::error("texture-image", what + "; export it again as JPEG or PNG", name);
  };
  if (bytes.empty()) return bad("the picture is empty");
  if (const auto kind = refused_kind(bytes); !kind.empty())
    return bad("the picture is " + kind + ", which is not read here");
  crs::register_gdal();
  crs::GdalMessages messages;
  const WithoutSidecars without;
  const MemoryFile file(fresh_name(""));
  // GDAL does not write to a file that is opened for reading.
  VSILFILE* opened = VSIFileFromMemBuffer(file.name(), const_cast<GByte*>(reinterpret_cast<const GByte*>(bytes.data())),
                                          bytes.size(), FALSE);  // NOLINT
  if (opened == nullptr) return bad("the picture cannot be opened");
  VSIFCloseL(opened);
  const std::array<const char*, 6> drivers{"JPEG", "PNG", "WEBP", "GTiff", "BMP", nullptr};
  const std::array<const char*, 1> siblings{nullptr};
  const Dataset data(
      GDALOpenEx(file.name(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers.data(), nullptr, siblings.data()));
  if (!data)
    return bad("not a picture that can be read (" +
               (messages.failure().empty() ? std::string("expected JPEG, PNG or WebP") : messages.failure()) + ")");
  Pixels out;
  const int width = GDALGetRasterXSize(data.get()), height = GDALGetRasterYSize(data.get());
  if (width <= 0 || height <= 0 || GDALGetRasterCount(data.get()) == 0) return bad("the picture has no pixels");
  const std::uint64_t count = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (count > most_pixels)
    return bad("the picture says it has " + std::to_string(width) + " by " + std::to_string(height) + " pixels");
  out.width = static_cast<std::uint32_t>(width);
  out.height = static_cast<std::uint32_t>(height);
  out.rgb.resize(3 * count);
  if (!rgb_of(data.get(), out)) return bad("the picture is damaged (" + messages.failure() + ")");
  return out;
}

auto read_image(const std::filesystem::path& path) -> base::Result<Pixels> {
  const auto bytes = bytes_of_named(path);
  if (!bytes) return bytes.failure();
  return decode_image(bytes->view(), path.string());
}

auto image_extension(ImageCodec codec) -> std::string_view {
  return codec == ImageCodec::jpeg ? ".jpg" : codec == ImageCodec::webp ? ".webp" : ".png";
}

auto mime_type_of(ImageCodec codec) -> std::string_view {
  return codec == ImageCodec::jpeg ? "image/jpeg" : codec == ImageCodec::webp ? "image/webp" : "image/png";
}

auto encode_image(const Pixels& pixels, ImageCodec codec, int quality) -> base::Result<std::string> {
  crs::register_gdal();
  const crs::GdalMessages messages;
  const WithoutSidecars without;
  const char* name = codec == ImageCodec::jpeg ? "JPEG" : codec == ImageCodec::webp ? "WEBP" : "PNG";
  const auto bad = [&](const std::string& what) {
    return base::error("texture-encode", "textures cannot be encoded as " + std::string(name) + " (" + what +
                                             "); choose another write.texture_format");
  };
  GDALDriverH driver = GDALGetDriverByName(name), memory = GDALGetDriverByName("MEM");
  if (driver == nullptr || memory == nullptr) return bad("this GDAL was built without it");
  const auto width = static_cast<int>(pixels.width), height = static_cast<int>(pixels.height);
  const Dataset source(GDALCreate(memory, "", width, height, 3, GDT_Byte, nullptr));
  if (!source) return bad("no memory");
  for (int c = 0; c < 3; ++c)
    if (GDALRasterIO(GDALGetRasterBand(source.get(), c + 1), GF_Write, 0, 0, width, height,
                     const_cast<std::uint8_t*>(pixels.rgb.data()) + c,  // NOLINT: GDAL reads it
                     width, height, GDT_Byte, 3, 3 * width) != CE_None)
      return bad("no memory");
  CPLStringList options;
  if (codec != ImageCodec::png) options.SetNameValue("QUALITY", std::to_string(quality).c_str());
  const MemoryFile file(fresh_name(image_extension(codec)));
  {
    const Dataset copy(GDALCreateCopy(driver, file.name(), source.get(), FALSE, options.List(), nullptr, nullptr));
    if (!copy) return bad(messages.failure());
  }
  auto bytes = file.bytes();
  if (bytes.empty()) return bad(messages.failure());
  return bytes;
}

}  // namespace mansard::formats
