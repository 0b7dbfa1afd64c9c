// The fuzzers' entry without a fuzzer: replay FOLDER [STRINGS [SEED]] takes every file of the folder, then that many
// strings at random, half of them noise, half files with some bytes changed. MANSARD_SEED is the seed if none is given.
// Says which one it was when the entry stops the program.
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "fuzz/fuzz.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/run.hpp"

namespace {

using namespace mansard;

std::string current;  // what is being tried; for the signal's handler

void say_which(int signal) {
  const auto ignore = [](ssize_t) {};
  ignore(write(STDERR_FILENO, current.data(), current.size()));
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void enter(const std::string& bytes) {
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

auto noise(base::Random& random) -> std::string {
  std::string bytes(random.index(random.index(4) == 0 ? 400 : 80), '\0');
  for (char& c : bytes) c = static_cast<char>(random.index(256));
  return bytes;
}

auto changed(base::Random& random, std::string bytes) -> std::string {
  for (std::size_t i = 0, count = 1 + random.index(4); i < count && !bytes.empty(); ++i) {
    const std::size_t at = random.index(bytes.size());
    switch (random.index(4)) {
      case 0: bytes.erase(at, 1 + random.index(8)); break;
      case 1: bytes.insert(at, bytes.substr(random.index(bytes.size()), random.index(8))); break;
      default: bytes[at] = static_cast<char>(random.index(256));
    }
  }
  return bytes;
}

}  // namespace

auto main(int argc, char** argv) -> int {
  if (argc < 2) {
    std::fputs("replay FOLDER [STRINGS [SEED]]\n", stderr);
    return 2;
  }
  std::signal(SIGABRT, say_which);
  std::signal(SIGSEGV, say_which);

  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1])) paths.push_back(entry.path());
  std::ranges::sort(paths);
  std::vector<std::string> corpus;
  for (const auto& path : paths) {
    const auto bytes = base::read_file(path);
    if (!bytes) {
      std::fprintf(stderr, "%s\n", base::to_string(bytes.error()).c_str());
      return 2;
    }
    current = path.string() + "\n";
    enter(*bytes);
    corpus.push_back(*bytes);
  }

  const unsigned long count = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 0;
  const char* from_outside = std::getenv("MANSARD_SEED");
  const std::string seed = argc > 3 ? argv[3] : from_outside != nullptr ? from_outside : "1";
  std::printf("%zu files, then %lu strings from seed %s\n", corpus.size(), count, seed.c_str());
  for (unsigned long i = 0; i < count; ++i) {
    base::Random random(std::strtoull(seed.c_str(), nullptr, 10), i);
    current = "string " + std::to_string(i) + " of seed " + seed + "\n";
    enter(corpus.empty() || i % 2 == 0 ? noise(random) : changed(random, corpus[random.index(corpus.size())]));
  }
  return corpus.empty() ? 2 : 0;
}
