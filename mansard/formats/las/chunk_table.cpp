#include "mansard/formats/las/chunk_table.hpp"

#include <array>
#include <cstring>
#include <optional>

namespace mansard::formats {
namespace {

/// Frequencies of symbols, which follow what was decoded.
class SymbolModel {
 public:
  explicit SymbolModel(std::uint32_t symbols) : counts_(symbols, 1), starts_(symbols, 0), cycle_(symbols) {
    update();
    left_ = cycle_ = (symbols + 6) >> 1;
  }
  [[nodiscard]] auto size() const -> std::uint32_t { return static_cast<std::uint32_t>(counts_.size()); }
  /// Of a symbol, in 2⁻¹⁵.
  [[nodiscard]] auto start(std::uint32_t symbol) const -> std::uint32_t { return starts_[symbol]; }
  void saw(std::uint32_t symbol) {
    ++counts_[symbol];
    if (--left_ == 0) update();
  }

  static constexpr std::uint32_t shift = 15;

 private:
  void update() {
    total_ += cycle_;
    if (total_ > 1U << shift) {
      total_ = 0;
      for (auto& count : counts_) total_ += count = (count + 1) >> 1;
    }
    const std::uint32_t scale = 0x80000000U / total_;
    std::uint32_t sum = 0;
    for (std::uint32_t s = 0; s < size(); ++s) {
      starts_[s] = (scale * sum) >> (31 - shift);
      sum += counts_[s];
    }
    cycle_ = std::min((5 * cycle_) >> 2, (size() + 6) << 3);
    left_ = cycle_;
  }

  std::vector<std::uint32_t> counts_, starts_;
  std::uint32_t total_ = 0, cycle_ = 0, left_ = 0;
};

/// The same of two symbols.
class BitModel {
 public:
  [[nodiscard]] auto zero() const -> std::uint32_t { return probability_; }
  void saw(bool bit) {
    if (!bit) ++zeros_;
    if (--left_ > 0) return;
    total_ += cycle_;
    if (total_ > 1U << shift) {
      total_ = (total_ + 1) >> 1;
      zeros_ = (zeros_ + 1) >> 1;
      if (zeros_ == total_) ++total_;
    }
    probability_ = (zeros_ * (0x80000000U / total_)) >> (31 - shift);
    cycle_ = std::min((5 * cycle_) >> 2, 64U);
    left_ = cycle_;
  }

  static constexpr std::uint32_t shift = 13;

 private:
  std::uint32_t zeros_ = 1, total_ = 2, probability_ = 1U << (shift - 1), cycle_ = 4, left_ = 4;
};

class ArithmeticDecoder {
 public:
  explicit ArithmeticDecoder(std::string_view bytes) : bytes_(bytes) {
    for (int i = 0; i < 4; ++i) value_ = value_ << 8 | next();
  }
  /// Whether all that was decoded was in the bytes.
  [[nodiscard]] auto good() const -> bool { return beyond_ == 0; }

  auto symbol(SymbolModel& model) -> std::uint32_t {
    std::uint32_t end = length_;
    length_ >>= SymbolModel::shift;
    std::uint32_t low = 0;
    for (std::uint32_t high = model.size(); high - low > 1;) {
      const std::uint32_t middle = (low + high) / 2, at = length_ * model.start(middle);
      if (at > value_) {
        high = middle;
        end = at;
      } else {
        low = middle;
      }
    }
    const std::uint32_t start = length_ * model.start(low);
    value_ -= start;
    length_ = end - start;
    shift_in();
    model.saw(low);
    return low;
  }
  auto bit(BitModel& model) -> bool {
    const std::uint32_t zero = model.zero() * (length_ >> BitModel::shift);
    const bool one = value_ >= zero;
    if (one) value_ -= zero;
    length_ = one ? length_ - zero : zero;
    shift_in();
    model.saw(one);
    return one;
  }
  /// `count` ≤ 32 bits without a model.
  auto bits(std::uint32_t count) -> std::uint32_t {
    if (count > 19) {
      const std::uint32_t low = bits(16);
      return bits(count - 16) << 16 | low;
    }
    length_ >>= count;
    const std::uint32_t out = length_ == 0 ? 0 : value_ / length_;
    value_ -= length_ * out;
    shift_in();
    return out;
  }

 private:
  auto next() -> std::uint32_t {
    if (at_ < bytes_.size()) return static_cast<unsigned char>(bytes_[at_++]);
    ++beyond_;
    return 0;
  }
  void shift_in() {
    while (length_ < 1U << 24 && beyond_ == 0) {
      value_ = value_ << 8 | next();
      length_ <<= 8;
    }
  }

  std::string_view bytes_;
  std::size_t at_ = 0, beyond_ = 0;
  std::uint32_t value_ = 0, length_ = 0xffffffffU;
};

/// Integers of 32 bits, each as the difference from a predicted one.
class IntegerDecoder {
 public:
  IntegerDecoder() : widths_(2, SymbolModel(33)) {
    for (std::uint32_t k = 1; k < 32; ++k) correctors_.emplace_back(1U << std::min(k, high_bits));
  }
  auto next(ArithmeticDecoder& from, std::uint32_t predicted, std::size_t context) -> std::uint32_t {
    const std::uint32_t k = from.symbol(widths_[context]);
    if (k == 0) return predicted + (from.bit(bit_) ? 1U : 0U);
    if (k == 32) return predicted + 0x80000000U;
    std::uint32_t correction = from.symbol(correctors_[k - 1]);
    if (k > high_bits) correction = correction << (k - high_bits) | from.bits(k - high_bits);
    // k bits mean −(2ᵏ − 1) … −2ᵏ⁻¹ and 2ᵏ⁻¹ + 1 … 2ᵏ.
    if (correction >= 1U << (k - 1)) ++correction;
    else correction -= (1U << k) - 1;
    return predicted + correction;
  }

 private:
  static constexpr std::uint32_t high_bits = 8;
  std::vector<SymbolModel> widths_, correctors_;
  BitModel bit_;
};

}  // namespace

auto read_chunk_table(std::string_view table, bool with_counts, std::uint64_t most, const std::string& name)
    -> base::Result<std::vector<LazChunk>> {
  const auto bad = [&](const std::string& what) {
    return base::error("ingest-points-format", "its table of chunks " + what + "; copy or export it again", name);
  };
  std::array<std::uint32_t, 2> head{};
  if (table.size() < sizeof head) return bad("is cut off");
  std::memcpy(head.data(), table.data(), sizeof head);
  if (head[0] != 0) return bad("has the unknown version " + std::to_string(head[0]));
  if (head[1] > most)
    return bad("promises " + std::to_string(head[1]) + " chunks, and the file has space for " + std::to_string(most));
  std::vector<LazChunk> chunks;
  ArithmeticDecoder from(table.substr(sizeof head));
  IntegerDecoder integers;
  std::uint32_t points = 0, bytes = 0;
  for (std::uint32_t i = 0; i < head[1]; ++i) {
    if (with_counts) points = integers.next(from, points, 0);
    bytes = integers.next(from, bytes, 1);
    if (!from.good())
      return bad("is cut off after " + std::to_string(i) + " of " + std::to_string(head[1]) + " chunks");
    chunks.push_back({points, bytes});
  }
  return chunks;
}

}  // namespace mansard::formats
