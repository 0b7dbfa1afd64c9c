#include "mansard/formats/las/wave_layers.hpp"

#include "mansard/formats/las/las_header.hpp"

namespace mansard::formats {
namespace {

constexpr std::size_t size_bytes = 4, layers_of_point = 9, layers_of_colours = 2;

/// Where the parts of a chunk are.
struct ChunkPlaces {
  std::size_t packet = 0;       ///< of the first record
  std::size_t count = 0;        ///< the number of points
  std::size_t packet_size = 0;  ///< the size of the layer of packets
  std::size_t layers = 0;

  ChunkPlaces(int format, std::size_t record_length)
      : packet(length_of_format(format) - wave_packet_bytes),
        count(record_length),
        packet_size(count + size_bytes + size_bytes * (layers_of_point + (format == 10 ? layers_of_colours : 0))),
        layers(packet_size + size_bytes + size_bytes * (record_length - length_of_format(format))) {}
};

/// Of the layers whose sizes are there, in bytes.
auto sum_of_sizes(std::string_view chunk, std::size_t from, std::size_t to) -> std::uint64_t {
  std::uint64_t sum = 0;
  for (std::size_t at = from; at < to; at += size_bytes) sum += number_at<std::uint32_t>(chunk, at);
  return sum;
}

}  // namespace

auto without_wave_packets(std::string_view chunk, int format, std::size_t record_length, std::uint64_t count,
                          const std::string& name) -> base::Result<std::string> {
  const auto bad = [&](const std::string& what) {
    return base::error("ingest-points-format", "a chunk cannot be decoded (" + what + "); copy or export it again",
                       name);
  };
  const ChunkPlaces at(format, record_length);
  if (chunk.size() < at.layers) return bad("it ends before its layers");
  if (const auto own = number_at<std::uint32_t>(chunk, at.count); own != count)
    return bad("it counts " + std::to_string(own) + " points instead of " + std::to_string(count));
  const std::uint64_t before = sum_of_sizes(chunk, at.count + size_bytes, at.packet_size),
                      packets = number_at<std::uint32_t>(chunk, at.packet_size),
                      after = sum_of_sizes(chunk, at.packet_size + size_bytes, at.layers);
  if (before + packets + after > chunk.size() - at.layers) return bad("its layers are longer than the chunk");
  std::string out;
  out.reserve(chunk.size());
  out += chunk.substr(0, at.packet);
  out += chunk.substr(at.packet + wave_packet_bytes, at.packet_size - at.packet - wave_packet_bytes);
  out += chunk.substr(at.packet_size + size_bytes, at.layers - at.packet_size - size_bytes);
  out += chunk.substr(at.layers, before);
  out += chunk.substr(at.layers + before + packets, after);
  return out;
}

}  // namespace mansard::formats
