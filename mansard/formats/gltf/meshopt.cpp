#include "mansard/formats/gltf/meshopt.hpp"

#include <meshoptimizer.h>
#include <algorithm>
#include <cstdint>
#include <vector>

namespace mansard::formats {
namespace {

/// The library asserts what it is given, so it is given nothing else.
auto is_sound(const MeshoptLayout& layout, std::size_t room) -> bool {
  if (layout.stride == 0 || layout.count > room / layout.stride) return false;
  if (layout.mode == "ATTRIBUTES") return layout.stride % 4 == 0 && layout.stride <= 256;
  const bool indices = (layout.stride == 2 || layout.stride == 4) && (layout.filter == "NONE" || layout.filter.empty());
  return indices && (layout.mode == "INDICES" || (layout.mode == "TRIANGLES" && layout.count % 3 == 0));
}

/// The filters work on numbers of 16 and 32 bits, which need not be aligned in the buffer.
template <class Filter>
void apply(Filter filter, const MeshoptLayout& layout, std::span<unsigned char> out) {
  const std::size_t size = layout.count * layout.stride;
  std::vector<std::uint32_t> aligned(size / 4);
  auto* bytes = reinterpret_cast<unsigned char*>(aligned.data());
  std::copy_n(out.begin(), size, bytes);
  filter(bytes, layout.count, layout.stride);
  std::copy_n(bytes, size, out.begin());
}

auto unfilter(const MeshoptLayout& layout, std::span<unsigned char> out) -> bool {
  if (layout.filter.empty() || layout.filter == "NONE") return true;
  if (layout.filter == "OCTAHEDRAL" && (layout.stride == 4 || layout.stride == 8))
    return apply(&meshopt_decodeFilterOct, layout, out), true;
  if (layout.filter == "QUATERNION" && layout.stride == 8) return apply(&meshopt_decodeFilterQuat, layout, out), true;
  if (layout.filter == "EXPONENTIAL") return apply(&meshopt_decodeFilterExp, layout, out), true;
  return false;
}

}  // namespace

auto unpack_meshopt(std::span<const unsigned char> bytes, const MeshoptLayout& layout, std::span<unsigned char> out)
    -> bool {
  if (!is_sound(layout, out.size())) return false;
  if (layout.count == 0) return true;
  if (layout.mode == "ATTRIBUTES")
    return meshopt_decodeVertexBuffer(out.data(), layout.count, layout.stride, bytes.data(), bytes.size()) == 0 &&
           unfilter(layout, out);
  if (layout.mode == "TRIANGLES")
    return meshopt_decodeIndexBuffer(out.data(), layout.count, layout.stride, bytes.data(), bytes.size()) == 0;
  return meshopt_decodeIndexSequence(out.data(), layout.count, layout.stride, bytes.data(), bytes.size()) == 0;
}

}  // namespace mansard::formats
