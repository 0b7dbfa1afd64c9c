// Programs as MPS: by hand, read back by CBC's own reader, and solved by CBC from there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "base/scratch.hpp"
#include "mansard/base/files.hpp"
#include "mansard/base/run.hpp"
#include "mansard/solver/solver.hpp"

// CBC's headers do not compile under this project's warnings.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wextra"
#include <CbcModel.hpp>
#include <CoinMpsIO.hpp>
#include <OsiClpSolverInterface.hpp>
#pragma GCC diagnostic pop

namespace mansard::solver {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double infinity = std::numeric_limits<double>::infinity();

auto from_coin(double value) -> double {
  if (value >= COIN_DBL_MAX) return infinity;
  return value <= -COIN_DBL_MAX ? -infinity : value;
}

/// What CBC's reader makes of the text; rows that were left out are missing.
auto read_back(const std::string& text) -> Program {
  const test::Scratch folder;
  const std::string path = folder / "program.mps";
  EXPECT_TRUE(base::write_file(path, text));
  CoinMpsIO reader;
  reader.messageHandler()->setLogLevel(0);
  EXPECT_EQ(reader.readMps(path.c_str(), ""), 0) << text;
  Program program;
  program.constant = -reader.objectiveOffset();
  for (int i = 0; i < reader.getNumCols(); ++i)
    program.variables.push_back({reader.getObjCoefficients()[i], from_coin(reader.getColLower()[i]),
                                 from_coin(reader.getColUpper()[i]), reader.isInteger(i)});
  const CoinPackedMatrix& matrix = *reader.getMatrixByRow();
  for (int r = 0; r < reader.getNumRows(); ++r) {
    program.rows.push_back({{}, from_coin(reader.getRowLower()[r]), from_coin(reader.getRowUpper()[r])});
    for (auto k = matrix.getVectorFirst(r); k < matrix.getVectorLast(r); ++k)
      program.rows.back().terms.emplace_back(matrix.getIndices()[k], matrix.getElements()[k]);
  }
  return program;
}

/// The terms by variable: the order of a row's terms means nothing.
auto sums(const Row& row) -> std::map<std::uint32_t, double> {
  std::map<std::uint32_t, double> sums;
  for (const auto& [variable, coefficient] : row.terms) sums[variable] += coefficient;
  std::erase_if(sums, [](const auto& sum) { return sum.second == 0; });
  return sums;
}

/// CBC's reader misses some decimals by a unit in the last place: hence not EXPECT_EQ.
void expect_same(const Program& written, const Program& read, const std::string& text) {
  EXPECT_DOUBLE_EQ(written.constant, read.constant) << text;
  ASSERT_EQ(written.variables.size(), read.variables.size()) << text;
  for (std::size_t i = 0; i < read.variables.size(); ++i) {
    EXPECT_DOUBLE_EQ(written.variables[i].cost, read.variables[i].cost) << i << "\n" << text;
    EXPECT_DOUBLE_EQ(written.variables[i].least, read.variables[i].least) << i << "\n" << text;
    EXPECT_DOUBLE_EQ(written.variables[i].most, read.variables[i].most) << i << "\n" << text;
    EXPECT_EQ(written.variables[i].whole, read.variables[i].whole) << i << "\n" << text;
  }
  std::vector<Row> rows = written.rows;
  std::erase_if(rows, [](const Row& row) { return row.least == -infinity && row.most == infinity; });
  ASSERT_EQ(rows.size(), read.rows.size()) << text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    EXPECT_DOUBLE_EQ(rows[r].least, read.rows[r].least) << r << "\n" << text;
    EXPECT_DOUBLE_EQ(rows[r].most, read.rows[r].most) << r << "\n" << text;
    const auto terms = sums(rows[r]), read_terms = sums(read.rows[r]);
    ASSERT_EQ(terms.size(), read_terms.size()) << r << "\n" << text;
    for (const auto& [variable, coefficient] : terms)
      EXPECT_DOUBLE_EQ(coefficient, read_terms.contains(variable) ? read_terms.at(variable) : 0) << r << "\n" << text;
  }
}

/// CBC as its authors set it up, without `minimise`; nothing when no point satisfies the rows.
auto optimum_by_cbc(const Program& program) -> std::optional<double> {
  const auto bound = [](double v) { return std::clamp(v, -COIN_DBL_MAX, COIN_DBL_MAX); };
  OsiClpSolverInterface clp;
  clp.messageHandler()->setLogLevel(0);
  for (const Variable& v : program.variables) {
    clp.addCol(CoinPackedVector(), bound(v.least), bound(v.most), v.cost);
    if (v.whole) clp.setInteger(clp.getNumCols() - 1);
  }
  for (const Row& row : program.rows) {
    CoinPackedVector terms;
    for (const auto& [variable, coefficient] : row.terms) terms.insert(static_cast<int>(variable), coefficient);
    clp.addRow(terms, bound(row.least), bound(row.most));
  }
  CbcModel model(clp);
  model.setLogLevel(0);
  model.messageHandler()->setLogLevel(0);
  model.solver()->messageHandler()->setLogLevel(0);
  model.branchAndBound();
  if (model.bestSolution() == nullptr) return std::nullopt;
  return model.getObjValue() + program.constant;
}

/// Up to seven variables of every kind of bound under up to six rows of every kind. The cost's sign keeps to the finite
/// side of the bounds, so that no program is unbounded.
auto random_program(std::uint64_t seed) -> Program {
  base::Random random(seed);
  const auto pick = [&](int count) { return static_cast<int>(random.uniform(0, count)); };
  const auto tenths = [&](double low, double high) { return std::round(10 * random.uniform(low, high)) / 10; };
  Program program;
  program.constant = tenths(-50, 50);
  for (int count = 2 + pick(6), i = 0; i < count; ++i) {
    const double low = std::round(random.uniform(-6, 4)), high = low + 1 + pick(6), cost = tenths(0, 20);
    const bool whole = random.uniform() < 0.6;
    switch (pick(7)) {
      case 0: program.variables.push_back({tenths(-20, 20), 0, 1, whole}); break;
      case 1: program.variables.push_back({tenths(-20, 20), low, high, whole}); break;
      case 2: program.variables.push_back({tenths(-20, 20), low, low, whole}); break;
      case 3: program.variables.push_back({cost, low, infinity, whole}); break;
      case 4: program.variables.push_back({-cost, -infinity, high, whole}); break;
      case 5: program.variables.push_back({0, -infinity, infinity, whole}); break;
      default: program.variables.push_back({tenths(-20, 20), -7, -2, whole}); break;
    }
  }
  for (int count = pick(7), r = 0; r < count; ++r) {
    const double low = std::round(random.uniform(-32, 32)) / 4, high = low + 1 + pick(12);
    constexpr int kinds = 5;
    const int kind = pick(kinds);
    Row row{{}, kind == 0 || kind == 1 ? -infinity : low, kind == 0 || kind == 2 ? infinity : high};
    if (kind == 3) row.most = row.least = std::round(low);
    if (kind == 4) row.least = std::round(low), row.most = row.least + 1 + pick(12);
    for (std::uint32_t i = 0; i < program.variables.size(); ++i)
      if (random.uniform() < 0.6) row.terms.emplace_back(i, kind == 3 ? 1 + pick(2) : tenths(-5, 5));
    program.rows.push_back(std::move(row));
  }
  return program;
}

auto one_variable(double cost) -> Program { return {{{cost, 0, 1, true}}, {}, 0}; }

TEST(Mps, writes_every_field_in_its_columns) {
  Program program;
  program.variables = {{-1500, 0, 1, true},        {2.5, -3, 7, true},     {0, -infinity, infinity, false},
                       {99999999999, 4, 4, false}, {1, 0, infinity, true}, {0.001, -infinity, -2, true}};
  program.rows = {{{{0, 1}, {1, -1}}, -infinity, 0}, {{{1, 1}, {2, -2.25}}, 3, infinity},
                  {{{0, 1}}, -infinity, infinity},   {{{3, 1}, {4, 1}}, 5, 5},
                  {{{5, 1}, {0, 1}}, -4, 6},         {{}, -infinity, 1}};
  program.constant = 42;
  const auto text = mps(program, "block-17: Delft");
  ASSERT_TRUE(text) << base::to_string(text.error());
  EXPECT_EQ(*text, R"(NAME          block17D
ROWS
 N  COST
 L  R0000000
 G  R0000001
 E  R0000003
 G  R0000004
 L  R0000005
COLUMNS
    MARKER    'MARKER'                 'INTORG'
    X0000000  COST      -1500
    X0000000  R0000000  1
    X0000000  R0000004  1
    X0000001  COST      2.5
    X0000001  R0000000  -1
    X0000001  R0000001  1
    MARKER    'MARKER'                 'INTEND'
    X0000002  COST      0
    X0000002  R0000001  -2.25
    X0000003  COST      99999999999
    X0000003  R0000003  1
    MARKER    'MARKER'                 'INTORG'
    X0000004  COST      1
    X0000004  R0000003  1
    X0000005  COST      0.001
    X0000005  R0000004  1
    MARKER    'MARKER'                 'INTEND'
RHS
    RHS       COST      -42
    RHS       R0000001  3
    RHS       R0000003  5
    RHS       R0000004  -4
    RHS       R0000005  1
RANGES
    RNG       R0000004  10
BOUNDS
 UP BND       X0000000  1
 LO BND       X0000001  -3
 UP BND       X0000001  7
 MI BND       X0000002
 PL BND       X0000002
 FX BND       X0000003  4
 PL BND       X0000004
 MI BND       X0000005
 UP BND       X0000005  -2
ENDATA
)");
  expect_same(program, read_back(*text), *text);
}

TEST(Mps, is_read_back_as_it_was_and_solved_to_the_same_optimum) {
  int solved = 0, infeasible = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Program program = random_program(seed);
    const auto text = mps(program, "random");
    ASSERT_TRUE(text) << "seed " << seed << ": " << base::to_string(text.error());
    const Program read = read_back(*text);
    expect_same(program, read, *text);
    const auto expected = minimise(program, {});
    ASSERT_TRUE(expected) << "seed " << seed << ": " << base::to_string(expected.error());
    const auto optimum = optimum_by_cbc(read);
    ASSERT_EQ(optimum.has_value(), expected->status == Status::optimal) << "seed " << seed << "\n" << *text;
    ++(optimum ? solved : infeasible);
    if (!optimum) continue;
    EXPECT_NEAR(*optimum, expected->objective, 1e-6 * std::max(1.0, std::abs(*optimum))) << "seed " << seed;
  }
  EXPECT_GE(solved, 50);
  EXPECT_GE(infeasible, 5);
}

TEST(Mps, keeps_the_constant_and_its_sign) {
  for (const double constant : {0.0, 7.0, -7.0, 0.125}) {
    Program program = one_variable(-2);
    program.constant = constant;
    EXPECT_EQ(optimum_by_cbc(read_back(mps(program, "").value())), constant - 2);
  }
}

TEST(Mps, keeps_integers_of_eleven_digits_and_others_where_twelve_columns_suffice) {
  for (const double number : {99999999999.0, -99999999999.0, 123456789012.0, 1e30, -2.5e-9, 0.1234567891})
    EXPECT_DOUBLE_EQ(read_back(mps(one_variable(number), "").value()).variables[0].cost, number);
}

TEST(Mps, adds_up_the_terms_of_a_variable_that_a_row_names_twice) {
  Program program = one_variable(1);
  program.rows = {{{{0, 2}, {0, 3}}, 1, infinity}, {{{0, 2}, {0, -2}}, 0, infinity}};
  const auto text = mps(program, "").value();
  EXPECT_THAT(text, HasSubstr("X0000000  R0000000  5\n"));
  EXPECT_THAT(text, Not(HasSubstr("X0000000  R0000001")));
}

TEST(Mps, writes_a_program_without_variables_or_rows) {
  const auto text = mps({}, "?!").value();
  EXPECT_EQ(text, "NAME          PROGRAM\nROWS\n N  COST\nCOLUMNS\nRHS\nBOUNDS\nENDATA\n");
}

TEST(Mps, puts_a_range_on_whichever_side_gives_both_bounds_exactly) {
  Program program = one_variable(1);
  program.rows = {{{{0, 1}}, 1e-20, 1}, {{{0, 1}}, -1, 1e-20}};
  const auto text = mps(program, "").value();
  EXPECT_THAT(text, HasSubstr(" G  R0000000\n L  R0000001\n"));
  expect_same(program, read_back(text), text);
}

struct Refused {
  std::string what;
  Program program;
  std::string message;
};

TEST(Mps, refuses_what_the_format_cannot_say) {
  const double third = 1.0 / 3, nan = std::nan("");
  const Variable x{1, 0, 1, true};
  const std::vector<Refused> cases{
      {"cost too long", one_variable(-0.1234567891), "-0.1234567891 of X0000000 does not fit into 12 columns"},
      {"whole number too long", one_variable(-123456789012), "-123456789012 of X0000000"},
      {"cost infinite", one_variable(infinity), "inf of X0000000"},
      {"cost no number", one_variable(nan), "nan of X0000000"},
      {"constant", {{x}, {}, third}, "of the constant"},
      {"coefficient", {{x}, {{{{0, third}}, 0, 1}}, 0}, "of X0000000"},
      {"row's bound", {{x}, {{{{0, 1}}, third, infinity}}, 0}, "of R0000000"},
      {"row's bounds cross", {{x}, {{{{0, 1}}, 2, 1}}, 0}, "bounds of R0000000 cross"},
      {"row's bound no number", {{x}, {{{{0, 1}}, nan, 1}}, 0}, "bounds of R0000000 cross"},
      {"row's range", {{x}, {{{{0, 1}}, 0.1, 0.3}}, 0}, "of R0000000"},
      {"row at infinity", {{x}, {{{{0, 1}}, infinity, infinity}}, 0}, "inf of R0000000"},
      {"variable's bound", {{{1, 0, third, false}}, {}, 0}, "of X0000000"},
      {"variable's bounds cross", {{{1, 2, 1, false}}, {}, 0}, "bounds of X0000000 cross"},
      {"variable's bound no number", {{{1, 0, nan, false}}, {}, 0}, "bounds of X0000000 cross"},
      {"variable at infinity", {{{1, -infinity, -infinity, false}}, {}, 0}, "inf of X0000000"},
      {"no such variable", {{x}, {{{{1, 1}}, 0, 1}}, 0}, "R0000000 has a term of a variable that does not exist"},
  };
  for (const Refused& refused : cases) {
    const auto text = mps(refused.program, "");
    ASSERT_FALSE(text) << refused.what << "\n" << *text;
    EXPECT_EQ(text.error().code, "solver-mps") << refused.what;
    EXPECT_THAT(text.error().message, HasSubstr(refused.message)) << refused.what;
  }
}

TEST(Mps, refuses_more_variables_than_seven_digits_count) {
  Program program;
  program.variables.resize(10'000'001);
  const auto text = mps(program, "");
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, "solver-mps");
  EXPECT_THAT(text.error().message, HasSubstr("10 million"));
}

TEST(Mps, explains_its_code) {
  EXPECT_TRUE(std::ranges::any_of(codes(), [](const base::Code& c) { return c.code == "solver-mps"; }));
}

}  // namespace
}  // namespace mansard::solver
