// How QGIS draws the layers of a GeoPackage when they are opened: its table layer_styles.
#pragma once

#include <ogrsf_frmts.h>
#include <optional>
#include <string>

#include "mansard/base/result.hpp"

namespace mansard::formats::detail {

/// The table that QGIS keeps styles in, under the name it has there.
inline constexpr const char* styles_name = "layer_styles";

/// One style: for QGIS in its own format (QML), and for others as SLD 1.1 with OGC's Symbology Encoding.
struct QgisStyle {
  std::string name, description, qml, sld;
};

/// The style of a layer of ours by its name, its geometry and its fields; none for others.
[[nodiscard]] auto style_of(OGRLayer& layer) -> std::optional<QgisStyle>;

/// A row for every layer that has a style, as QGIS itself writes them as a layer's default. Layers must have their
/// fields. Nothing where there would be no row, or where there is such a table. Fails with "write-geopackage".
[[nodiscard]] auto add_styles(GDALDataset& file) -> base::Result<void>;

}  // namespace mansard::formats::detail
