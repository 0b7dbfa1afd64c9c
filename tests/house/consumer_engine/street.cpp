#include <cstdio>

#include "mansard/pipeline/pipeline.hpp"

int main(int count, char** paths) {
  const mansard::pipeline::Options options;
  if (count != 3) return 2;
  const auto scene = mansard::ingest::read_scene({paths[1]}, paths[2], options.ingest);
  if (!scene) return std::puts(scene.error().message.c_str()), 3;
  const auto made = mansard::pipeline::reconstruct(*scene, options);
  if (!made) return std::puts(made.error().message.c_str()), 5;
  std::printf("%zu buildings, %.1f m3\n", made->buildings.size(), made->buildings.front().volume);
}
