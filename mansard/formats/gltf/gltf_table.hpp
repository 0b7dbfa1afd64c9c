// Attributes of parts as columns of one type each, for a property table of EXT_structural_metadata.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mansard/base/outputs.hpp"
#include "mansard/formats/json/json_text.hpp"
#include "mansard/model/city.hpp"

namespace mansard::formats::detail {

/// The values of one part by their columns; what is absent is left out. A column occurs once.
using Row = std::vector<std::pair<std::uint32_t, model::Value>>;

/// The columns of the class "part": what parts and their buildings say, in the order in which it is first said.
class PartColumns {
 public:
  PartColumns();

  /// The row of a part, or of a building without parts. Columns that it is the first to have are added.
  auto row(const model::Building& building, const std::string& building_key, std::int64_t order,
           const model::Part* part, const std::string& part_key) -> Row;

  /// After the last row: types and names are settled.
  void settle();

  enum class Kind {
    boolean,  ///< a flag that every part has
    flag,     ///< one that some have: an enum of false, true and absent
    int32,
    int64,
    real,
    text,  ///< texts, and what is of several kinds
  };
  struct Column {
    std::string name;                                                       ///< as in the source
    std::string identifier;                                                 ///< as a property may be called
    std::string description;                                                ///< for those that are the writer's own
    bool of_part = false;                                                   ///< the part's, not its building's
    std::array<std::uint64_t, std::variant_size_v<model::Value>> counts{};  ///< by type of value
    bool narrow = true;   ///< whole numbers are less than 2^31 in size
    bool absent = false;  ///< in some row
    Kind kind = Kind::text;
  };
  [[nodiscard]] auto columns() const -> const std::vector<Column>& { return columns_; }

  /// The record of a building is the property of a class of its own, to which no feature id leads: viewers show the
  /// properties of `part`.
  static constexpr std::string_view record = "record", record_class = "plans";

  /// {"part": {…}, "plans": {…}, "surface": {…}} and the enums that they name: the members "classes" and "enums" of a
  /// schema.
  void append_schema(JsonText& json) const;

 private:
  auto column(bool of_part, const std::string& name) -> std::uint32_t;
  void add(Row& row, bool of_part, const std::string& name, const model::Value& value);

  std::vector<Column> columns_;
  std::map<std::pair<bool, std::string>, std::uint32_t> number_of_;
  std::uint64_t rows_ = 0;
};

/// Puts a row aside as bytes, and takes it back from the start of `bytes`, which moves on.
void append_row(std::string& bytes, const Row& row);
[[nodiscard]] auto take_row(std::string_view& bytes) -> Row;

/// A buffer view that a table is made of: `bytes` in the sink from `offset` on.
struct TableView {
  std::uint64_t offset = 0, bytes = 0;
};
struct TableColumn {
  std::string identifier;
  std::size_t values = 0, offsets = 0;  ///< which views; of offsets only with has_offsets
  bool has_offsets = false;
};

/// The columns of a table one after the other, each from a multiple of 8 on.
class TableBytes {
 public:
  explicit TableBytes(base::Spool& spool) : spool_(&spool) {}
  /// The bytes that are appended between these two are one view.
  void begin();
  auto end() -> std::size_t;
  void append(std::string_view bytes) { spool_->append(bytes); }

  /// One column of rows that were put aside by append_row, each after its length. Texts without a value are left out.
  [[nodiscard]] auto add(const PartColumns::Column& column, std::uint32_t number, base::Spool& rows,
                         std::uint64_t count) -> base::Result<void>;
  /// Texts that are there already, with their ends.
  [[nodiscard]] auto add_texts(std::string_view identifier, base::Spool& texts,
                               const std::vector<std::uint32_t>& offsets) -> base::Result<void>;
  /// Values that are there already.
  [[nodiscard]] auto add_values(std::string_view identifier, base::Spool& values) -> base::Result<void>;

  [[nodiscard]] auto views() const -> const std::vector<TableView>& { return views_; }
  [[nodiscard]] auto columns() const -> const std::vector<TableColumn>& { return columns_; }

 private:
  base::Spool* spool_;
  std::vector<TableView> views_;
  std::vector<TableColumn> columns_;
};

}  // namespace mansard::formats::detail
