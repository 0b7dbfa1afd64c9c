// Programs as text that other solvers read: MPS with fixed columns, as IBM's MPSX defined it.
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <limits>

#include "mansard/base/text.hpp"
#include "mansard/solver/solver.hpp"

namespace mansard::solver {
namespace {

constexpr std::size_t most_names = 10'000'000;  // that a letter and seven digits can tell apart
constexpr std::size_t digits_of_names = 7, number_width = 12, name_width = 8;
constexpr double infinity = std::numeric_limits<double>::infinity();

auto name_of(char letter, std::size_t index) -> std::string {
  const std::string digits = std::to_string(index);
  return letter + std::string(digits_of_names - std::min(digits_of_names, digits.size()), '0') + digits;
}
auto variable_name(std::size_t index) -> std::string { return name_of('X', index); }
auto row_name(std::size_t index) -> std::string { return name_of('R', index); }

/// The lines, called cards, and the first number that did not fit.
class Cards {
 public:
  void section(std::string_view name) { text_.append(name) += '\n'; }

  /// The fields 1, 2, 3, 4 and so on, each from its own column; empty ones stay blank.
  void card(std::initializer_list<std::string_view> fields) {
    constexpr std::array<std::size_t, 5> columns{1, 4, 14, 24, 39};
    std::string line;
    std::size_t field = 0;
    for (const std::string_view content : fields) {
      if (!content.empty()) line.resize(columns[field], ' ');
      line += content;
      ++field;
    }
    section(line);
  }

  /// Its shortest text. `owner` is named when that does not fit.
  auto number(double value, std::string_view owner) -> std::string {
    std::string text = base::to_text(value);
    if ((!std::isfinite(value) || text.size() > number_width) && misfit_.empty())
      misfit_ = text + " of " + std::string(owner);
    return text;
  }

  [[nodiscard]] auto misfit() const -> const std::string& { return misfit_; }
  [[nodiscard]] auto text() && -> std::string { return std::move(text_); }

 private:
  std::string text_, misfit_;
};

/// A row's kind, right-hand side, and how far it reaches: up from there for kind G, down for kind L.
struct Side {
  char kind = 'N';
  double right = 0;
  std::optional<double> range;
};

/// Nothing where the bounds cross, are no numbers, or cannot be had back from one of them and their difference.
auto side_of(const Row& row) -> std::optional<Side> {
  if (!(row.least <= row.most)) return std::nullopt;
  if (row.least == row.most) return Side{'E', row.least, {}};
  if (row.least == -infinity) return row.most == infinity ? Side{} : Side{'L', row.most, {}};
  if (row.most == infinity) return Side{'G', row.least, {}};
  const double range = row.most - row.least;
  if (row.least + range == row.most) return Side{'G', row.least, range};
  if (row.most - range == row.least) return Side{'L', row.most, range};
  return std::nullopt;
}

struct Entry {
  std::uint32_t row = 0;
  double coefficient = 0;
};

/// By variable, every row once.
auto columns_of(const Program& program) -> std::vector<std::vector<Entry>> {
  std::vector<std::vector<Entry>> columns(program.variables.size());
  for (std::uint32_t r = 0; r < program.rows.size(); ++r)
    for (const auto& [variable, coefficient] : program.rows[r].terms) {
      auto& column = columns[variable];
      if (column.empty() || column.back().row != r) column.push_back({r, coefficient});
      else column.back().coefficient += coefficient;
    }
  return columns;
}

/// What the format cannot say; nothing when all is well.
auto flaw_of(const Program& program, const std::vector<std::optional<Side>>& sides) -> std::string {
  if (std::max(program.variables.size(), program.rows.size()) > most_names)
    return "the program has more than 10 million variables or rows";
  for (std::size_t i = 0; i < program.variables.size(); ++i)
    if (!(program.variables[i].least <= program.variables[i].most))
      return "the bounds of " + variable_name(i) + " cross or are no numbers";
  for (std::size_t r = 0; r < program.rows.size(); ++r) {
    if (!sides[r]) return "the bounds of " + row_name(r) + " cross, are no numbers, or have no exact difference";
    if (std::ranges::any_of(program.rows[r].terms, [&](const auto& t) { return t.first >= program.variables.size(); }))
      return row_name(r) + " has a term of a variable that does not exist";
  }
  return {};
}

void write_rows(const std::vector<Side>& sides, Cards& cards) {
  cards.section("ROWS");
  cards.card({"N", "COST"});
  for (std::size_t r = 0; r < sides.size(); ++r)
    if (sides[r].kind != 'N') cards.card({std::string_view(&sides[r].kind, 1), row_name(r)});
}

/// Every variable has its cost written, a zero too: it is what makes the variable known.
void write_columns(const Program& program, const std::vector<Side>& sides, Cards& cards) {
  cards.section("COLUMNS");
  const auto marker = [&](bool whole) { cards.card({"", "MARKER", "'MARKER'", "", whole ? "'INTORG'" : "'INTEND'"}); };
  bool whole = false;
  const auto columns = columns_of(program);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (program.variables[i].whole != whole) marker(whole = !whole);
    const std::string name = variable_name(i);
    cards.card({"", name, "COST", cards.number(program.variables[i].cost, name)});
    for (const Entry& entry : columns[i])
      if (entry.coefficient != 0 && sides[entry.row].kind != 'N')
        cards.card({"", name, row_name(entry.row), cards.number(entry.coefficient, name)});
  }
  if (whole) marker(false);
}

void write_sides(double constant, const std::vector<Side>& sides, Cards& cards) {
  cards.section("RHS");
  // Readers subtract the objective's right-hand side.
  if (constant != 0) cards.card({"", "RHS", "COST", cards.number(-constant, "the constant")});
  for (std::size_t r = 0; r < sides.size(); ++r)
    if (sides[r].right != 0) cards.card({"", "RHS", row_name(r), cards.number(sides[r].right, row_name(r))});
  if (std::ranges::none_of(sides, [](const Side& side) { return side.range.has_value(); })) return;
  cards.section("RANGES");
  for (std::size_t r = 0; r < sides.size(); ++r)
    if (const auto& range = sides[r].range) cards.card({"", "RNG", row_name(r), cards.number(*range, row_name(r))});
}

/// Every variable has its upper bound written: readers differ on what whole ones have without. The lower bound comes
/// first, as some readers move it at the sight of an upper one below zero.
void write_bounds(const std::vector<Variable>& variables, Cards& cards) {
  cards.section("BOUNDS");
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const auto [cost, least, most, whole] = variables[i];
    const std::string name = variable_name(i);
    if (least == most) {
      cards.card({"FX", "BND", name, cards.number(most, name)});
      continue;
    }
    if (least == -infinity) cards.card({"MI", "BND", name});
    else if (least != 0) cards.card({"LO", "BND", name, cards.number(least, name)});
    if (most == infinity) cards.card({"PL", "BND", name});
    else cards.card({"UP", "BND", name, cards.number(most, name)});
  }
}

auto title_of(std::string_view name) -> std::string {
  std::string title;
  for (const char c : name)
    if (title.size() < name_width && ((c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z')))
      title += c;
  return title.empty() ? "PROGRAM" : title;
}

}  // namespace

auto mps(const Program& program, std::string_view name) -> base::Result<std::string> {
  std::vector<std::optional<Side>> found;
  std::ranges::transform(program.rows, std::back_inserter(found), side_of);
  if (const std::string flaw = flaw_of(program, found); !flaw.empty()) return base::error("solver-mps", flaw);
  std::vector<Side> sides;  // each row's: flaw_of has seen to it
  for (const auto& side : found)
    if (side) sides.push_back(*side);

  Cards cards;
  cards.section("NAME          " + title_of(name));
  write_rows(sides, cards);
  write_columns(program, sides, cards);
  write_sides(program.constant, sides, cards);
  write_bounds(program.variables, cards);
  cards.section("ENDATA");
  if (!cards.misfit().empty())
    return base::error("solver-mps", "the number " + cards.misfit() + " does not fit into 12 columns; round it");
  return std::move(cards).text();
}

}  // namespace mansard::solver
