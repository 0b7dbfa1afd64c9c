// How long meshes take to read, and how much memory, beside other readers of the same files in the same run:
//   bench_ingest FOLDER TRIANGLES [READER…]   makes hills.obj, hills.ply … of so many triangles in the folder
// Every reading is a process of its own, so that its memory is its own; the best of three counts.
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "bench/ingest/others.hpp"
#include "mansard/base/text.hpp"
#include "mansard/formats/input_file.hpp"
#include "mansard/ingest/model.hpp"

namespace {

using namespace mansard;
namespace fs = std::filesystem;

auto seconds_since(std::chrono::steady_clock::time_point start) -> double {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// n by n squares of 25 cm with a rough surface, far from the origin, as scans are.
struct Hills {
  std::uint32_t n;
  [[nodiscard]] auto vertices() const -> std::size_t { return std::size_t{n + 1} * (n + 1); }
  [[nodiscard]] auto triangles() const -> std::size_t { return std::size_t{2} * n * n; }
  template <class Take>
  void each_vertex(Take take) const {
    for (std::uint32_t j = 0; j <= n; ++j)
      for (std::uint32_t i = 0; i <= n; ++i)
        take(84000 + 0.25 * i, 447000 + 0.25 * j,
             5 * std::sin(0.03 * i) * std::cos(0.02 * j) + 0.001 * ((i * 7 + j * 13) % 97));
  }
  template <class Take>
  void each_triangle(Take take) const {
    for (std::uint32_t j = 0; j < n; ++j)
      for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t at = j * (n + 1) + i;
        take(at, at + 1, at + n + 2);
        take(at, at + n + 2, at + n + 1);
      }
  }
};

void write_text(const Hills& hills, const fs::path& path, const std::string& head, const char* vertex, const char* face,
                std::uint32_t from) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  std::fputs(head.c_str(), file);
  hills.each_vertex([&](double x, double y, double z) { std::fprintf(file, vertex, x, y, z); });
  hills.each_triangle([&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    std::fprintf(file, face, a + from, b + from, c + from);
  });
  std::fclose(file);
}

auto ply_head(const Hills& hills, const char* format) -> std::string {
  return std::string("ply\nformat ") + format + " 1.0\nelement vertex " + std::to_string(hills.vertices()) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(hills.triangles()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

void write_binary(const Hills& hills, const fs::path& path) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  std::fputs(ply_head(hills, "binary_little_endian").c_str(), file);
  hills.each_vertex([&](double x, double y, double z) {
    const float p[3] = {static_cast<float>(x - 84000), static_cast<float>(y - 447000), static_cast<float>(z)};
    std::fwrite(p, sizeof p, 1, file);
  });
  hills.each_triangle([&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const std::uint32_t t[3] = {a, b, c};
    std::fputc(3, file);
    std::fwrite(t, sizeof t, 1, file);
  });
  std::fclose(file);
}

/// Pages of no file, bytes.
auto private_memory() -> double {
  std::ifstream in("/proc/self/statm");
  double all = 0, resident = 0, shared = 0;
  in >> all >> resident >> shared;
  return (resident - shared) * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

struct Reading {
  double seconds = 0, processor = 0, private_peak = 0, peak = 0;
  std::size_t triangles = 0;
};

auto measured(const std::function<std::size_t()>& work) -> Reading {
  auto* out = static_cast<Reading*>(
      ::mmap(nullptr, sizeof(Reading), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  *out = {};
  const pid_t child = ::fork();
  if (child == 0) {
    std::atomic<bool> done{false};
    double most = 0;
    std::thread watch([&] {
      while (!done) {
        most = std::max(most, private_memory());
        ::usleep(2000);
      }
    });
    const double before = private_memory();
    const auto start = std::chrono::steady_clock::now();
    out->triangles = work();
    out->seconds = seconds_since(start);
    done = true;
    watch.join();
    out->private_peak = most - before;
    ::_exit(0);
  }
  int status = 0;
  struct rusage used {};
  ::wait4(child, &status, 0, &used);
  Reading result = status == 0 ? *out : Reading{};
  result.peak = static_cast<double>(used.ru_maxrss) * 1024;
  result.processor = static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                     1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  ::munmap(out, sizeof(Reading));
  return result;
}

auto readers() -> std::vector<std::pair<std::string, std::function<std::size_t(const fs::path&)>>> {
  return {{"hash alone", [](const fs::path& path) { return formats::input_file(path).value().sha256.size(); }},
          {"read_mesh",
           [](const fs::path& path) {
             const auto read = ingest::read_mesh({path}, {{84000, 447000, 0}, {}}, {});
             return read ? read->mesh.triangles.size() : 0;
           }},
          {"tinyobjloader",
           [](const fs::path& path) { return path.extension() == ".obj" ? bench::read_by_tinyobjloader(path) : 0; }},
          {"assimp", [](const fs::path& path) { return bench::read_by_assimp(path); }}};
}

}  // namespace

auto main(int argc, char** argv) -> int {
  const auto wanted = argc > 2 ? base::to_whole(argv[2]) : std::nullopt;
  if (!wanted || *wanted < 2) return std::puts("bench_ingest FOLDER TRIANGLES [READER…]"), 2;
  const fs::path folder = argv[1];
  const Hills hills{static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(*wanted) / 2)))};
  fs::create_directories(folder);
  write_text(hills, folder / "hills.obj", "# hills\n", "v %.3f %.3f %.3f\n", "f %u %u %u\n", 1);
  write_binary(hills, folder / "hills.ply");
  write_text(hills, folder / "hills_text.ply", ply_head(hills, "ascii"), "%.3f %.3f %.3f\n", "3 %u %u %u\n", 0);
  write_text(hills, folder / "hills.off",
             "OFF\n" + std::to_string(hills.vertices()) + " " + std::to_string(hills.triangles()) + " 0\n",
             "%.3f %.3f %.3f\n", "3 %u %u %u\n", 0);
  const double mesh = 24 * static_cast<double>(hills.vertices()) + 12 * static_cast<double>(hills.triangles());
  std::printf("%zu triangles; as doubles and indices %.0f MB\n\n", hills.triangles(), mesh / 1e6);
  std::puts("| file | MB | reader | s | processor s | MB/s | own memory / mesh | with mapped pages / mesh |");
  std::puts("|---|---|---|---|---|---|---|---|");
  for (const char* name : {"hills.obj", "hills.ply", "hills_text.ply", "hills.off"}) {
    const double size = static_cast<double>(fs::file_size(folder / name));
    for (const auto& [reader, read] : readers()) {
      bool asked = argc == 3;
      for (int i = 3; i < argc; ++i) asked = asked || reader == argv[i];
      if (!asked) continue;
      Reading best;
      for (int round = 0; round < 3; ++round) {
        const auto one = measured([&] { return read(folder / name); });
        if (round == 0 || one.seconds < best.seconds) best = one;
      }
      if (best.triangles == 0) continue;  // not a format of this reader
      std::printf("| %s | %.0f | %s | %.2f | %.2f | %.0f | %.2f | %.2f |\n", name, size / 1e6, reader.c_str(),
                  best.seconds, best.processor, size / 1e6 / best.seconds, best.private_peak / mesh, best.peak / mesh);
      std::fflush(stdout);
    }
  }
  return 0;
}
