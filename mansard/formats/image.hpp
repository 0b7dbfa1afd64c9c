// Pictures in files: decoded for sampling, encoded for textures of models. By GDAL, which is linked anyway and has
// JPEG, PNG and WebP.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "mansard/base/result.hpp"
#include "mansard/model/texture.hpp"

namespace mansard::formats {

/// Pixels that a picture may have at most; more is refused before memory is taken: 16,384 × 16,384, the largest texture
/// that graphics hardware takes.
inline constexpr std::uint64_t most_pixels = std::uint64_t{1} << 28U;

/// JPEG, PNG, WebP, TIFF or BMP, of any number of channels and 8 or 16 bits, as RGB; transparency is left out. `name`
/// is for messages. Fails with "texture-image" (what is wrong; KTX2 and DDS are named).
[[nodiscard]] auto decode_image(std::string_view bytes, const std::string& name) -> base::Result<model::Pixels>;

/// The same of a file, by its name; in an archive or on a server too. Fails with "file-missing" and "file-read" as
/// well.
[[nodiscard]] auto read_image(const std::filesystem::path& path) -> base::Result<model::Pixels>;

enum class ImageCodec : std::uint8_t { jpeg, webp, png };
/// ".jpg", ".webp", ".png"; "image/jpeg", …
[[nodiscard]] auto image_extension(ImageCodec codec) -> std::string_view;
[[nodiscard]] auto mime_type_of(ImageCodec codec) -> std::string_view;

/// The same bytes for the same pixels. `quality` from 1 to 100, of no meaning for PNG. Fails with "texture-encode"
/// where GDAL was built without the codec.
[[nodiscard]] auto encode_image(const model::Pixels& pixels, ImageCodec codec, int quality)
    -> base::Result<std::string>;

}  // namespace mansard::formats
