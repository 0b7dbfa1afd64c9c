// Values as bytes and back, for files that only the same program reads again.
//
// The members of a struct are found by the compiler, so that none can be forgotten: `pack` and `unpack` take numbers,
// enums, strings, vectors, arrays, pairs, optionals, variants, and structs of these without constructors and without
// private members. Numbers keep every bit. The bytes are those of this machine's numbers: not for exchange.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace mansard::base {

namespace detail {

/// Stands for any value in the count of members; never made. Clang wants the definition where T is in an anonymous
/// namespace.
struct Anything {
  template <class T>
  operator T() const {  // NOLINT: implicit on purpose
    std::abort();
  }
};

template <class T, std::size_t... I>
constexpr auto takes(std::index_sequence<I...>) -> bool {
  return requires { T{(static_cast<void>(I), Anything{})...}; };
}

inline constexpr std::size_t most_members = 24;

/// How many members T has: the most values that it can be made of.
template <class T, std::size_t N = most_members + 1>
constexpr auto members() -> std::size_t {
  if constexpr (N == 0 || takes<T>(std::make_index_sequence<N>{})) return N;
  else return members<T, N - 1>();
}

/// visit(a, b, …) with every member.
template <class T, class Visit>
void with_members(T& t, Visit&& visit) {
  constexpr std::size_t n = members<std::remove_cv_t<T>>();
  static_assert(n > 0 && n <= most_members, "add a line for so many members");
  // clang-format off
  if constexpr (n == 1) { auto& [a] = t; visit(a); }
  else if constexpr (n == 2) { auto& [a, b] = t; visit(a, b); }
  else if constexpr (n == 3) { auto& [a, b, c] = t; visit(a, b, c); }
  else if constexpr (n == 4) { auto& [a, b, c, d] = t; visit(a, b, c, d); }
  else if constexpr (n == 5) { auto& [a, b, c, d, e] = t; visit(a, b, c, d, e); }
  else if constexpr (n == 6) { auto& [a, b, c, d, e, f] = t; visit(a, b, c, d, e, f); }
  else if constexpr (n == 7) { auto& [a, b, c, d, e, f, g] = t; visit(a, b, c, d, e, f, g); }
  else if constexpr (n == 8) { auto& [a, b, c, d, e, f, g, h] = t; visit(a, b, c, d, e, f, g, h); }
  else if constexpr (n == 9) { auto& [a, b, c, d, e, f, g, h, i] = t; visit(a, b, c, d, e, f, g, h, i); }
  else if constexpr (n == 10) { auto& [a, b, c, d, e, f, g, h, i, j] = t; visit(a, b, c, d, e, f, g, h, i, j); }
  else if constexpr (n == 11) { auto& [a, b, c, d, e, f, g, h, i, j, k] = t; visit(a, b, c, d, e, f, g, h, i, j, k); }
  else if constexpr (n == 12) { auto& [a, b, c, d, e, f, g, h, i, j, k, l] = t; visit(a, b, c, d, e, f, g, h, i, j, k, l); }
  else if constexpr (n == 13) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = t; visit(a, b, c, d, e, f, g, h, i, j, k, l, m); }
  else if constexpr (n == 14) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o] = t; visit(a, b, c, d, e, f, g, h, i, j, k, l, m, o); }
  else if constexpr (n == 15) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p] = t; visit(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p); }
  else if constexpr (n == 16) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q] = t; visit(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q); }
  else if constexpr (n == 17) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r] = t; visit(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r); }
  else if constexpr (n == 18) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s] = t; visit(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s); }
  else if constexpr (n == 19) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, u] = t; visit(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, u); }
  else if constexpr (n == 20) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, u, v] = t; visit(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, u, v); }
  else if constexpr (n == 21) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w] = t; visit(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w); }
  else if constexpr (n == 22) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w, x] = t; visit(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w, x); }
  else if constexpr (n == 23) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w, x, y] = t; visit(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w, x, y); }
  else if constexpr (n == 24) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w, x, y, z] = t; visit(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w, x, y, z); }
  // clang-format on
}

template <class T>
inline constexpr bool is_plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

template <class T>
struct Kind {
  static constexpr bool vector = false, array = false, optional = false, variant = false, pair = false;
};
template <class T>
struct Kind<std::vector<T>> : Kind<void> {
  static constexpr bool vector = true;
};
template <class T, std::size_t N>
struct Kind<std::array<T, N>> : Kind<void> {
  static constexpr bool array = true;
};
template <class T>
struct Kind<std::optional<T>> : Kind<void> {
  static constexpr bool optional = true;
};
template <class... T>
struct Kind<std::variant<T...>> : Kind<void> {
  static constexpr bool variant = true;
};
template <class A, class B>
struct Kind<std::pair<A, B>> : Kind<void> {
  static constexpr bool pair = true;
};

}  // namespace detail

/// Appends the value's bytes.
template <class T>
void pack(const T& value, std::string& out) {
  using K = detail::Kind<T>;
  const auto size = [&out](std::uint64_t n) { pack(n, out); };
  if constexpr (detail::is_plain<T>) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    out.append(bytes, sizeof(T));
  } else if constexpr (std::is_same_v<T, std::string>) {
    size(value.size());
    out += value;
  } else if constexpr (std::is_same_v<T, std::monostate>) {
  } else if constexpr (std::is_same_v<T, std::chrono::steady_clock::time_point>) {
    pack(value.time_since_epoch().count(), out);
  } else if constexpr (K::vector) {
    size(value.size());
    if constexpr (detail::is_plain<typename T::value_type> && !std::is_same_v<typename T::value_type, bool>)
      out.append(reinterpret_cast<const char*>(value.data()), value.size() * sizeof(typename T::value_type));  // NOLINT
    else
      for (const auto& item : value) pack(item, out);
  } else if constexpr (K::array) {
    for (const auto& item : value) pack(item, out);
  } else if constexpr (K::pair) {
    pack(value.first, out);
    pack(value.second, out);
  } else if constexpr (K::optional) {
    pack(value.has_value(), out);
    if (value) pack(*value, out);
  } else if constexpr (K::variant) {
    size(value.index());
    std::visit([&out](const auto& held) { pack(held, out); }, value);
  } else {
    detail::with_members(value, [&out](const auto&... all) { (pack(all, out), ...); });
  }
}

template <class T>
[[nodiscard]] auto packed(const T& value) -> std::string {
  std::string out;
  pack(value, out);
  return out;
}

/// Takes values off the front of `bytes`, in the order in which they were packed. False, and from then on always, where
/// the bytes do not go on as the value asks.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  auto take(T& value) -> bool {
    using K = detail::Kind<T>;
    if constexpr (detail::is_plain<T>) {
      const auto from = next(sizeof(T));
      if (good_) std::memcpy(&value, from.data(), sizeof(T));
    } else if constexpr (std::is_same_v<T, std::string>) {
      value = next(length(1));
    } else if constexpr (std::is_same_v<T, std::monostate>) {
    } else if constexpr (std::is_same_v<T, std::chrono::steady_clock::time_point>) {
      std::chrono::steady_clock::rep ticks{};
      take(ticks);
      value = T(std::chrono::steady_clock::duration(ticks));
    } else if constexpr (K::vector) {
      using Item = typename T::value_type;
      value.clear();
      if constexpr (detail::is_plain<Item> && !std::is_same_v<Item, bool>) {
        const auto count = length(sizeof(Item));
        const auto from = next(count * sizeof(Item));
        value.resize(good_ ? count : 0);
        if (!value.empty()) std::memcpy(value.data(), from.data(), from.size());
      } else {
        const auto count = length(1);
        for (std::size_t i = 0; i < count && good_; ++i) {
          Item item{};
          take(item);
          value.push_back(std::move(item));
        }
      }
    } else if constexpr (K::array) {
      for (auto& item : value) take(item);
    } else if constexpr (K::pair) {
      take(value.first);
      take(value.second);
    } else if constexpr (K::optional) {
      bool there = false;
      take(there);
      value.reset();
      if (there && good_) take(value.emplace());
    } else if constexpr (K::variant) {
      std::uint64_t index = 0;
      take(index);
      if (!held(value, index, std::make_index_sequence<std::variant_size_v<T>>{})) good_ = false;
    } else {
      detail::with_members(value, [this](auto&... all) { (this->take(all), ...); });
    }
    return good_;
  }

  /// Whether all went well and nothing is left.
  [[nodiscard]] auto done() const -> bool { return good_ && bytes_.empty(); }

 private:
  auto next(std::size_t count) -> std::string_view {
    if (count > bytes_.size()) good_ = false;
    if (!good_) return {};
    const auto out = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return out;
  }
  /// A number of items, each of which takes at least so many bytes.
  auto length(std::size_t least) -> std::size_t {
    std::uint64_t count = 0;
    take(count);
    if (count > bytes_.size() / least) good_ = false;
    return good_ ? static_cast<std::size_t>(count) : 0;
  }
  template <class V, std::size_t... I>
  auto held(V& value, std::uint64_t index, std::index_sequence<I...>) -> bool {
    return ((index == I && take(value.template emplace<I>())) || ...);
  }

  std::string_view bytes_;
  bool good_ = true;
};

}  // namespace mansard::base
