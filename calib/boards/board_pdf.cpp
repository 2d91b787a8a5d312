// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/board_pdf.h"

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "calib/boards/board_pattern.h"
#include "calib/boards/board_text.h"
#include "core/errors.h"

namespace alidade {
namespace {

using Eigen::Vector2d;

constexpr double kMargin_mm = 8.0;   // white around the pattern; most printers cannot reach the outer 5 mm
constexpr double kFooter_mm = 14.0;  // the ruler and the line of text below the pattern
constexpr double kRuler_mm = 100.0;
constexpr double kPoints_per_mm = 72.0 / 25.4;  // a point is 1/72 inch

struct PaperSize {
  std::string_view name;
  double width_mm, height_mm;  // upright
};
// In the order of Paper; the last entry of the enum has no size of its own.
constexpr std::array<PaperSize, 6> kSizes{{{"A4", 210, 297},
                                           {"A3", 297, 420},
                                           {"A2", 420, 594},
                                           {"A1", 594, 841},
                                           {"A0", 841, 1189},
                                           {"letter", 215.9, 279.4}}};

// The page that the pattern needs.
Vector2d needed_mm(const Vector2d& pattern_mm) {
  const double width = std::max(pattern_mm.x(), kRuler_mm) + 2 * kMargin_mm;
  return {width, pattern_mm.y() + 2 * kMargin_mm + kFooter_mm};
}

// The paper upright or turned, as the pattern fits on it; upright where both will do.
std::optional<Vector2d> turned_to_fit(const PaperSize& paper, const Vector2d& needed) {
  for (const Vector2d& page : {Vector2d(paper.width_mm, paper.height_mm), Vector2d(paper.height_mm, paper.width_mm)}) {
    if ((needed.array() <= page.array() + 1e-6).all()) return page;
  }
  return std::nullopt;
}

Vector2d page_mm(const Board& board, Paper paper, const Vector2d& pattern_mm) {
  const Vector2d needed = needed_mm(pattern_mm);
  if (paper == Paper::Fitted) return needed;
  const PaperSize& wanted = kSizes[static_cast<std::size_t>(paper)];
  if (const auto page = turned_to_fit(wanted, needed)) return *page;
  std::string_view fitting = "fitted";
  for (std::size_t i = 0; i < 5 && fitting == "fitted"; ++i) {
    if (turned_to_fit(kSizes[i], needed)) fitting = kSizes[i].name;
  }
  throw InputError(board_text(board), 0,
                   fmt::format("the board needs a page of {:.0f} x {:.0f} mm, {} has {:g} x {:g}", needed.x(),
                               needed.y(), wanted.name, wanted.width_mm, wanted.height_mm),
                   fmt::format("print it with --paper {}", fitting));
}

// Rectangles in mm, y down from the page's top: one path, filled at once, so that viewers draw no seams.
std::string fill(const std::vector<Eigen::AlignedBox2d>& boxes_mm, const Vector2d& page) {
  std::string path =
      fmt::format("q {0:.9f} 0 0 {1:.9f} 0 {2:.9f} cm\n", kPoints_per_mm, -kPoints_per_mm, page.y() * kPoints_per_mm);
  for (const Eigen::AlignedBox2d& box : boxes_mm) {
    path +=
        fmt::format("{:.5f} {:.5f} {:.5f} {:.5f} re\n", box.min().x(), box.min().y(), box.sizes().x(), box.sizes().y());
  }
  return path + "f Q\n";
}

// A line of 100 mm from outer edge to outer edge, with a mark every 10 mm.
std::vector<Eigen::AlignedBox2d> ruler(const Vector2d& start_mm) {
  constexpr double kLine_mm = 0.2;
  std::vector<Eigen::AlignedBox2d> boxes{{start_mm, start_mm + Vector2d(kRuler_mm, kLine_mm)}};
  for (int i = 0; i <= 10; ++i) {
    const double height = i % 5 == 0 ? 3.0 : 1.5;
    const Vector2d foot = start_mm + Vector2d(i * (kRuler_mm - kLine_mm) / 10, -height);
    boxes.emplace_back(foot, foot + Vector2d(kLine_mm, height));
  }
  return boxes;
}

std::string write_line(const std::string& text, const Vector2d& start_mm, const Vector2d& page) {
  return fmt::format("BT /F1 7 Tf {:.3f} {:.3f} Td ({}) Tj ET\n", start_mm.x() * kPoints_per_mm,
                     (page.y() - start_mm.y()) * kPoints_per_mm, text);
}

std::string draw_page(const Board& board, const BoardPattern& pattern, const Vector2d& page) {
  const Vector2d size_mm = 1e3 * pattern.extent.sizes();
  const double left = 0.5 * (page.x() - size_mm.x());
  const double top = std::max(kMargin_mm, 0.5 * (page.y() - kFooter_mm - size_mm.y()));
  std::vector<Eigen::AlignedBox2d> boxes;
  for (const Eigen::AlignedBox2d& box : pattern.black) {
    const Vector2d from = Vector2d(left, top) + 1e3 * (box.min() - pattern.extent.min());
    boxes.emplace_back(from, from + 1e3 * box.sizes());
  }
  const Vector2d footer(kMargin_mm, page.y() - kMargin_mm - 4.0);
  const auto marks = ruler(footer);
  boxes.insert(boxes.end(), marks.begin(), marks.end());
  const std::string words =
      fmt::format("{}: print at 100 % (actual size); the line is {:g} mm long", board_text(board), kRuler_mm);
  return fill(boxes, page) + write_line(words, footer + Vector2d(0, 3.2), page);
}

// The objects of the file, and the table that says where each starts (PDF 1.4, sections 3.4 and 3.6).
std::string write_file(const std::vector<std::string>& objects) {
  std::string file = "%PDF-1.4\n";
  std::string table = fmt::format("xref\n0 {}\n0000000000 65535 f \n", objects.size() + 1);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    table += fmt::format("{:010} 00000 n \n", file.size());
    file += fmt::format("{} 0 obj\n{}\nendobj\n", i + 1, objects[i]);
  }
  return file + table +
         fmt::format("trailer\n<< /Size {} /Root 1 0 R >>\nstartxref\n{}\n%%EOF\n", objects.size() + 1, file.size());
}

}  // namespace

std::string board_pdf(const Board& board, Paper paper) {
  const BoardPattern pattern = pattern_of(board);
  const Vector2d page = page_mm(board, paper, 1e3 * pattern.extent.sizes());
  const std::string content = draw_page(board, pattern, page);
  return write_file({"<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
                     "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
                     fmt::format("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:.4f} {:.4f}] /Contents 4 0 R "
                                 "/Resources << /Font << /F1 5 0 R >> >> >>",
                                 page.x() * kPoints_per_mm, page.y() * kPoints_per_mm),
                     fmt::format("<< /Length {} >>\nstream\n{}endstream", content.size(), content),
                     "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>"});
}

}  // namespace alidade
