// Which axis of a mesh points up.
#pragma once

namespace mansard::formats {

/// automatic: y for glTF, z for the rest. A mesh that is y up is turned: (x, y, z) becomes (x, −z, y).
enum class UpAxis { automatic, z, y };

}  // namespace mansard::formats
