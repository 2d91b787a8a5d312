// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "core/errors.h"
#include "io/camera_records.h"

// OpenCV 4.6's own parser is no choice here: on a file that is cut off it reads past the end and dies.
namespace alidade {
namespace {

using Path = std::filesystem::path;

/// The content of an element, and the line of the file on which it starts.
struct Element {
  std::string_view content;
  int line = 0;
};

class Document {
 public:
  Document(Path path, std::string_view text) : path_(std::move(path)), text_(text) {}

  /// The first element of this name in `within`, a part of the text; empty where there is none.
  std::optional<Element> find(const std::string& name, std::string_view within) const {
    const std::string end_tag = "</" + name + ">";
    for (std::size_t at = within.find('<' + name); at != std::string_view::npos; at = within.find('<' + name, at + 1)) {
      const std::size_t after_name = at + 1 + name.size();
      if (after_name < within.size() && std::string_view(" \t\r\n>").find(within[after_name]) == std::string_view::npos)
        continue;
      const std::size_t start = within.find('>', at), end = within.find(end_tag, at);
      const int line = line_of(within.data() + at);
      if (start == std::string_view::npos || end == std::string_view::npos || end < start) {
        throw InputError(path_, line, fmt::format("damaged XML: element <{}> does not end", name),
                         "write the file again");
      }
      return Element{within.substr(start + 1, end - start - 1), line};
    }
    return std::nullopt;
  }
  std::optional<Element> find(const std::string& name) const { return find(name, text_); }

  /// The numbers in the <data> of a matrix.
  std::vector<double> numbers(const Element& matrix) const {
    const auto data = find("data", matrix.content);
    if (!data) throw InputError(path_, matrix.line, "a matrix with <data> is wanted here", "");
    std::vector<double> numbers;
    int line = data->line;
    for (std::string_view rest = data->content; !rest.empty(); ++line) {
      const std::size_t end = rest.find('\n');
      for (const std::string_view word : split_words(rest.substr(0, end))) {
        numbers.push_back(parse_number(path_, line, word));
      }
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    }
    return numbers;
  }

 private:
  int line_of(const char* position) const { return 1 + static_cast<int>(std::count(text_.data(), position, '\n')); }

  Path path_;
  std::string_view text_;
};

struct KeyNames {
  const char* camera;
  const char* matrix;
  const char* distortion;
};
constexpr KeyNames kKeys[] = {{"camera", "camera_matrix", "distortion_coefficients"},
                              {"camera", "Camera_Matrix", "Distortion_Coefficients"},
                              {"camera", "cameraMatrix", "distCoeffs"},
                              {"left", "M1", "D1"},
                              {"right", "M2", "D2"}};

void read_size(const Path& path, const Document& document, CameraRecord& record) {
  constexpr const char* kNames[][2] = {{"image_width", "image_height"}, {"image_Width", "image_Height"}};
  for (const auto& [width_name, height_name] : kNames) {
    const auto width = document.find(width_name), height = document.find(height_name);
    if (!width || !height) continue;
    record.camera.width = parse_size(path, width->line, trim(width->content));
    record.camera.height = parse_size(path, height->line, trim(height->content));
    record.lines["image"] = width->line;
  }
}

}  // namespace

CameraRecords parse_opencv_xml(const Path& path, const std::string& text) {
  const Document document(path, text);
  CameraRecords records;
  for (const KeyNames& keys : kKeys) {
    const auto matrix = document.find(keys.matrix);
    if (!matrix) continue;
    CameraRecord record;
    record.name = keys.camera;
    record.line = matrix->line;
    set_intrinsics(path, matrix->line, document.numbers(*matrix), record.camera);
    if (const auto distortion = document.find(keys.distortion)) {
      record.camera.distortion = distortion_from(path, distortion->line, document.numbers(*distortion));
      record.lines["distortion"] = distortion->line;
    }
    read_size(path, document, record);
    records.push_back(record);
  }
  const auto R = document.find("R"), t = document.find("T");
  if (R && t && records.size() == 2 && records[0].name == "left" && records[1].name == "right") {
    const auto rotation = document.numbers(*R), translation = document.numbers(*t);
    records[1].T_rig_camera = pose_from(path, R->line, rotation, translation).inverse();
  }
  if (text.find("</opencv_storage>") == std::string::npos) {
    throw InputError(path, 0, "damaged XML: the end </opencv_storage> is missing", "write the file again");
  }
  if (records.empty()) throw InputError(path, 0, "holds no camera", "an element <camera_matrix> is wanted");
  return records;
}

}  // namespace alidade
