// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace alidade {

/// The types of a PLY's values.
enum class PlyType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

/// A column of an element; a list has a count of `count_type` in front of its values.
struct PlyProperty {
  std::string name;
  PlyType type = PlyType::Float32;
  bool is_list = false;
  PlyType count_type = PlyType::UInt8;
};

/// A table of a PLY: vertices, faces, ...
struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

/// The values of one row, property by property; one value for a scalar, any number for a list.
using PlyRow = std::vector<std::vector<double>>;

/// Reads a PLY from its header to its end, row by row. `bytes` must outlive it.
class PlyReader {
 public:
  /// Reads the header. Throws InputError with the line where it is none.
  PlyReader(std::filesystem::path path, std::string_view bytes);

  const std::vector<PlyElement>& elements() const { return elements_; }

  /// The next row of `element`; rows and elements come in the file's order. Throws InputError where the file ends
  /// before it ("is cut off in row 120 of 453 of element 'vertex'") or a word is not a number.
  PlyRow read_row(const PlyElement& element);

 private:
  void read_header();
  void read_header_line(const std::vector<std::string_view>& words);
  double read_value(PlyType type);
  double read_word();
  [[noreturn]] void refuse(const std::string& what) const;

  std::filesystem::path path_;
  std::string_view rest_;
  std::vector<PlyElement> elements_;
  bool ascii_ = false;
  int line_ = 0;                     // of the header, and of an ASCII body
  const PlyElement* now_ = nullptr;  // being read
  std::size_t row_ = 0;
};

}  // namespace alidade
