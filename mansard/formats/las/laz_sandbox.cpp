// The part that JavaScript plays for the WebAssembly of laz-perf, and a runtime for what wasm2c makes of it. The
// runtime of Debian's package keeps its state in globals of the process and installs signal handlers; this one has no
// state but the table of function types, which is written once.
#include "mansard/formats/las/laz_sandbox.hpp"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <new>
#include <vector>

#ifdef MANSARD_HAS_LAZ

#include "mansard/formats/las/laz_runtime.h"

#include "mansard/formats/las/laz_perf.h"  // made by wasm2c

extern "C" thread_local uint32_t mansard_laz_depth;
thread_local uint32_t mansard_laz_depth = 0;

namespace {

/// Leaves the generated C, which is compiled with -fexceptions. `words` is empty where memory ended.
struct Fault {
  std::string words;
};

constexpr std::uint32_t page = 65536;
/// Of one instance. A chunk of 50,000 points takes about 5 MB beside its own bytes.
constexpr std::uint32_t most_pages = 16384;  // 1 GiB

struct FuncType {
  std::uint32_t params = 0, results = 0;
  std::vector<wasm_rt_type_t> types;
  auto operator==(const FuncType&) const -> bool = default;
};

auto func_types() -> std::vector<FuncType>& {
  static std::vector<FuncType> all;
  return all;
}

}  // namespace

// What the module imports. An instance of the "environment" is the host of one instance of the module.
struct Z_env_instance_t {
  Z_lazperf_instance_t module{};
  bool instantiated = false;

  struct Method {
    std::uint32_t invoker = 0, context = 0;
  };
  std::uint32_t decoder_class = 0;
  Method construct, open, get_point;  // invoker 0, which no function of the table has: not registered

  Z_env_instance_t() = default;
  Z_env_instance_t(const Z_env_instance_t&) = delete;
  auto operator=(const Z_env_instance_t&) -> Z_env_instance_t& = delete;
  ~Z_env_instance_t() {
    if (instantiated) Z_lazperf_free(&module);
  }

  [[nodiscard]] auto memory() -> wasm_rt_memory_t& { return module.w2c_memory; }
  /// `n` bytes of its memory; a fault where they are not all in it.
  [[nodiscard]] auto bytes(std::uint64_t at, std::uint64_t n) -> std::uint8_t* {
    if (at + n > memory().size) throw Fault{"access beyond the decoder's memory"};
    return memory().data + at;
  }
  [[nodiscard]] auto word(std::uint32_t at) -> std::uint32_t {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes(at, sizeof value), sizeof value);
    return value;
  }
  [[nodiscard]] auto text(std::uint32_t at) -> std::string {
    std::string out;
    for (constexpr std::size_t longest = 200; out.size() < longest; ++at) {
      const auto c = static_cast<char>(*bytes(at, 1));
      if (c == '\0') break;
      out += c >= ' ' && c <= '~' ? c : '?';
    }
    return out;
  }
  /// A function of the module's table, whose arguments are all 32-bit integers.
  template <class Return, class... Arguments>
  auto call(std::uint32_t index, Arguments... arguments) -> Return {
    const auto& table = module.w2c___indirect_function_table;
    constexpr bool returns = !std::is_void_v<Return>;
    FuncType type{static_cast<std::uint32_t>(sizeof...(Arguments)), returns ? 1U : 0U, {}};
    type.types.assign(type.params + type.results, WASM_RT_I32);
    const auto& all = func_types();
    if (index >= table.size || table.data[index].func == nullptr || table.data[index].func_type == 0 ||
        !(all[table.data[index].func_type - 1] == type))
      throw Fault{"the decoder lacks a function"};
    using Function = Return (*)(void*, Arguments...);
    return reinterpret_cast<Function>(table.data[index].func)(table.data[index].module_instance, arguments...);
  }
};
struct Z_wasi_snapshot_preview1_instance_t {
  Z_env_instance_t* host = nullptr;
};

// NOLINTBEGIN(bugprone-reserved-identifier): the names that wasm2c gives to what the decoder imports
extern "C" {

auto wasm_rt_is_initialized() -> bool { return true; }

auto wasm_rt_register_func_type(uint32_t params, uint32_t results, ...) -> uint32_t {
  FuncType type{params, results, {}};
  va_list list;
  va_start(list, results);
  for (std::uint32_t i = 0; i < params + results; ++i)
    type.types.push_back(static_cast<wasm_rt_type_t>(va_arg(list, int)));
  va_end(list);
  auto& all = func_types();
  const auto at = std::ranges::find(all, type);
  if (at != all.end()) return static_cast<std::uint32_t>(at - all.begin()) + 1;
  all.push_back(std::move(type));
  return static_cast<std::uint32_t>(all.size());
}

void wasm_rt_trap(wasm_rt_trap_t trap) {  // declared as one that does not return
  switch (trap) {
    case WASM_RT_TRAP_OOB: throw Fault{"access beyond the end of the chunk"};
    case WASM_RT_TRAP_EXHAUSTION: throw Fault{"calls nested too deeply"};
    case WASM_RT_TRAP_CALL_INDIRECT: throw Fault{"call of a missing function"};
    default: throw Fault{"invalid instruction"};
  }
}

void wasm_rt_allocate_memory(wasm_rt_memory_t* memory, uint32_t initial, uint32_t most) {
  memory->data = static_cast<uint8_t*>(std::calloc(initial, page));
  if (memory->data == nullptr) throw Fault{};
  memory->pages = initial;
  memory->max_pages = std::min(most, most_pages);
  memory->size = initial * page;
}

void wasm_rt_free_memory(wasm_rt_memory_t* memory) {
  std::free(memory->data);
  memory->data = nullptr;
}

void wasm_rt_allocate_funcref_table(wasm_rt_funcref_table_t* table, uint32_t elements, uint32_t most) {
  table->data = static_cast<wasm_rt_funcref_t*>(std::calloc(elements, sizeof(wasm_rt_funcref_t)));
  if (table->data == nullptr) throw Fault{};
  table->size = elements;
  table->max_size = most;
}

void wasm_rt_free_funcref_table(wasm_rt_funcref_table_t* table) {
  std::free(table->data);
  table->data = nullptr;
}

auto Z_envZ___cxa_allocate_exception(Z_env_instance_t* host, uint32_t size) -> uint32_t {
  constexpr std::uint32_t header = 32;
  const auto at = Z_lazperfZ_malloc(&host->module, size + header);
  if (at == 0) throw Fault{};
  return at + header;
}
void Z_envZ___cxa_throw(Z_env_instance_t* host, uint32_t exception, uint32_t, uint32_t) {
  throw Fault{host->text(host->word(exception + 4))};
}
void Z_envZ_abort(Z_env_instance_t*) { throw Fault{"the decoder stopped"}; }

void Z_envZ_emscripten_memcpy_big(Z_env_instance_t* host, uint32_t to, uint32_t from, uint32_t n) {
  std::memmove(host->bytes(to, n), host->bytes(from, n), n);
}
auto Z_envZ_emscripten_resize_heap(Z_env_instance_t* host, uint32_t wanted) -> uint32_t {
  auto& memory = host->memory();
  const auto pages = static_cast<std::uint32_t>((std::uint64_t{wanted} + page - 1) / page);
  if (pages <= memory.pages) return 1;
  if (pages > memory.max_pages) return 0;
  auto* const grown = static_cast<uint8_t*>(std::realloc(memory.data, std::size_t{pages} * page));
  if (grown == nullptr) return 0;
  std::memset(grown + memory.size, 0, std::size_t{pages - memory.pages} * page);
  memory.data = grown;
  memory.pages = pages;
  memory.size = pages * page;
  return 1;
}

void Z_envZ__embind_register_class(Z_env_instance_t* host, uint32_t type, uint32_t, uint32_t, uint32_t, uint32_t,
                                   uint32_t, uint32_t, uint32_t, uint32_t, uint32_t, uint32_t name, uint32_t,
                                   uint32_t) {
  if (host->text(name) == "ChunkDecoder") host->decoder_class = type;
}
void Z_envZ__embind_register_class_constructor(Z_env_instance_t* host, uint32_t type, uint32_t, uint32_t, uint32_t,
                                               uint32_t invoker, uint32_t context) {
  if (type == host->decoder_class) host->construct = {invoker, context};
}
void Z_envZ__embind_register_class_function(Z_env_instance_t* host, uint32_t type, uint32_t name, uint32_t, uint32_t,
                                            uint32_t, uint32_t invoker, uint32_t context, uint32_t) {
  if (type != host->decoder_class) return;
  const auto method = host->text(name);
  if (method == "open") host->open = {invoker, context};
  if (method == "getPoint") host->get_point = {invoker, context};
}
void Z_envZ__embind_register_bigint(Z_env_instance_t*, uint32_t, uint32_t, uint32_t, uint32_t, uint32_t, uint32_t,
                                    uint32_t) {}
void Z_envZ__embind_register_bool(Z_env_instance_t*, uint32_t, uint32_t, uint32_t, uint32_t, uint32_t) {}
void Z_envZ__embind_register_emval(Z_env_instance_t*, uint32_t, uint32_t) {}
void Z_envZ__embind_register_float(Z_env_instance_t*, uint32_t, uint32_t, uint32_t) {}
void Z_envZ__embind_register_integer(Z_env_instance_t*, uint32_t, uint32_t, uint32_t, uint32_t, uint32_t) {}
void Z_envZ__embind_register_memory_view(Z_env_instance_t*, uint32_t, uint32_t, uint32_t) {}
void Z_envZ__embind_register_std_string(Z_env_instance_t*, uint32_t, uint32_t) {}
void Z_envZ__embind_register_std_wstring(Z_env_instance_t*, uint32_t, uint32_t, uint32_t) {}
void Z_envZ__embind_register_void(Z_env_instance_t*, uint32_t, uint32_t) {}
auto Z_envZ_strftime_l(Z_env_instance_t*, uint32_t, uint32_t, uint32_t, uint32_t, uint32_t) -> uint32_t { return 0; }

using Wasi = Z_wasi_snapshot_preview1_instance_t;
auto Z_wasi_snapshot_preview1Z_environ_get(Wasi*, uint32_t, uint32_t) -> uint32_t { return 0; }
auto Z_wasi_snapshot_preview1Z_environ_sizes_get(Wasi* wasi, uint32_t count, uint32_t size) -> uint32_t {
  for (const auto at : {count, size}) std::memset(wasi->host->bytes(at, 4), 0, 4);
  return 0;
}
auto Z_wasi_snapshot_preview1Z_fd_close(Wasi*, uint32_t) -> uint32_t { return 0; }
auto Z_wasi_snapshot_preview1Z_fd_seek(Wasi*, uint32_t, uint32_t, uint32_t, uint32_t, uint32_t) -> uint32_t {
  return 0;
}
auto Z_wasi_snapshot_preview1Z_fd_write(Wasi*, uint32_t, uint32_t, uint32_t, uint32_t) -> uint32_t { return 0; }

}  // extern "C"
// NOLINTEND(bugprone-reserved-identifier)

namespace mansard::formats {
namespace {

class Decoder {
 public:
  Decoder() {
    static std::once_flag once;
    std::call_once(once, [] { Z_lazperf_init_module(); });
    mansard_laz_depth = 0;  // a fault leaves it as it was
    wasi_.host = &host_;
    Z_lazperf_instantiate(&host_.module, &host_, &wasi_);
    host_.instantiated = true;
    Z_lazperfZ_emscripten_stack_init(&host_.module);
    Z_lazperfZ___wasm_call_ctors(&host_.module);
    if (host_.construct.invoker == 0 || host_.open.invoker == 0 || host_.get_point.invoker == 0)
      throw Fault{"the decoder lacks a function"};
  }

  auto decode(std::string_view chunk, int format, std::size_t record, std::uint64_t count) -> std::string {
    // The decoder is given no length, so the chunk is put at the very end of the memory, where reading beyond it is
    // reading beyond the memory. The space before it is freed again for what the decoder allocates as it goes.
    const auto length = static_cast<std::uint32_t>(chunk.size());
    const auto arena = allocate(arena_bytes);
    const auto behind = allocate(length + 2 * page);
    Z_lazperfZ_free(&host_.module, arena);
    const auto end = host_.memory().size;
    if (end < behind + length) throw Fault{"the decoder's memory is not as expected"};
    const auto start = end - length;
    std::memcpy(host_.bytes(start, length), chunk.data(), length);

    const auto object = host_.call<std::uint32_t>(host_.construct.invoker, host_.construct.context);
    constexpr std::size_t batch = 1024;
    const auto records = allocate(static_cast<std::uint32_t>(batch * record));
    host_.call<void>(host_.open.invoker, host_.open.context, object, static_cast<std::uint32_t>(format),
                     static_cast<std::uint32_t>(record), start);
    std::string out;
    out.reserve(std::min<std::uint64_t>(count, 65536) * record);
    for (std::uint64_t done = 0; done < count;) {
      const auto now = static_cast<std::uint32_t>(std::min<std::uint64_t>(batch, count - done));
      for (std::uint32_t i = 0; i < now; ++i)
        host_.call<void>(host_.get_point.invoker, host_.get_point.context, object,
                         records + i * static_cast<std::uint32_t>(record));
      // With memory added behind the chunk, its end would not be noticed.
      if (host_.memory().size != end) throw Fault{"the chunk takes more memory than its points can"};
      out.append(reinterpret_cast<const char*>(host_.bytes(records, now * record)), now * record);
      done += now;
    }
    return out;
  }

 private:
  /// What the decoder allocates for the format with most attributes, with a margin: 4.7 MB were seen.
  static constexpr std::uint32_t arena_bytes = 24U << 20;

  auto allocate(std::uint32_t bytes) -> std::uint32_t {
    const auto at = Z_lazperfZ_malloc(&host_.module, bytes);
    if (at == 0) throw Fault{};
    return at;
  }

  Z_env_instance_t host_;
  Z_wasi_snapshot_preview1_instance_t wasi_;
};

}  // namespace

auto has_laz_decoder() -> bool { return true; }

auto decode_chunk(std::string_view chunk, int point_format, std::size_t record_length, std::uint64_t count,
                  const std::string& name) -> base::Result<std::string> {
  constexpr std::size_t largest = std::size_t{900} << 20;  // what fits into an instance, with its arena
  if (chunk.size() > largest)
    return base::error("ingest-points-unsupported",
                       "a chunk has " + std::to_string(chunk.size() >> 20) +
                           " MB, and at most 900 MB are decoded; write the file again in chunks of 50,000 points",
                       name);
  try {
    return Decoder().decode(chunk, point_format, record_length, count);
  } catch (const Fault& fault) {
    if (fault.words.empty()) return base::error("ingest-memory", "a chunk does not fit into memory", name);
    return base::error("ingest-points-format",
                       "a chunk cannot be decoded (" + fault.words + "); copy or export it again", name);
  } catch (const std::bad_alloc&) {
    return base::error("ingest-memory", "a chunk does not fit into memory", name);
  }
}

}  // namespace mansard::formats

#else

namespace mansard::formats {

auto has_laz_decoder() -> bool { return false; }

auto decode_chunk(std::string_view, int, std::size_t, std::uint64_t, const std::string& name)
    -> base::Result<std::string> {
  return base::error("ingest-points-unsupported",
                     "this program was built without the decoder of LAZ (CMake option MANSARD_LAZ); convert to LAS",
                     name);
}

}  // namespace mansard::formats

#endif
