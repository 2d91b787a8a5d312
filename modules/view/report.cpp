// SPDX-License-Identifier: Apache-2.0
#include "view/report.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "core/errors.h"

namespace alidade {
namespace {

constexpr std::string_view kStyle = R"(
:root{color-scheme:light}
body{font:16px/1.55 system-ui,-apple-system,"Segoe UI",Roboto,"DejaVu Sans",sans-serif;color:#26282e;background:#f5f6f8;margin:0}
main{max-width:1040px;margin:0 auto;padding:2rem 1.25rem 4rem}
h1{font-size:1.7rem;margin:.2rem 0 .6rem}
h2{font-size:1.2rem;margin:2.4rem 0 .6rem;border-bottom:1px solid #d8dbe0;padding-bottom:.25rem}
pre{background:#fff;border:1px solid #dfe2e7;border-radius:6px;padding:.7rem .9rem;overflow:auto;font-size:.85rem;white-space:pre-wrap}
table{border-collapse:collapse;background:#fff;border:1px solid #dfe2e7;border-radius:6px;width:100%}
th,td{text-align:left;padding:.38rem .8rem;border-bottom:1px solid #eceef1;vertical-align:top}
td.value{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
td.unit{color:#5c616b;white-space:nowrap}
.good{color:#0a7a4f;font-weight:600}.poor{color:#b3261e;font-weight:600}
figure{margin:1rem 0;background:#fff;border:1px solid #dfe2e7;border-radius:6px;padding:.7rem}
figure img{max-width:100%;height:auto;display:block;margin:0 auto}
figcaption{color:#4a4f58;font-size:.92rem;margin-top:.5rem}
.warning{background:#fff6e0;border:1px solid #efd28a;border-radius:6px;padding:.5rem .9rem;margin:.4rem 0}
)";

std::string escaped(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string to_base64(const std::vector<unsigned char>& bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = bytes.size() - i;
    const unsigned triple = bytes[i] << 16 | (left > 1 ? bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
    out += kDigits[triple >> 18];
    out += kDigits[triple >> 12 & 63];
    out += left > 1 ? kDigits[triple >> 6 & 63] : '=';
    out += left > 2 ? kDigits[triple & 63] : '=';
  }
  return out;
}

// A word of the command line as a shell would need it.
std::string quoted(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                          "0123456789_-+=./:,@%") == std::string::npos;
  if (plain) return word;
  std::string out(1, '\'');
  for (const char c : word) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      out += c;
    }
  }
  out += '\'';
  return out;
}

std::string table(const std::vector<ReportRow>& rows) {
  if (rows.empty()) return {};
  std::string html = "<table>\n";
  for (const auto& row : rows) {
    const std::string_view mark = row.verdict == Verdict::Good   ? "<span class=\"good\">good</span> "
                                  : row.verdict == Verdict::Poor ? "<span class=\"poor\">poor</span> "
                                                                 : "";
    html += fmt::format("<tr><th>{}</th><td class=\"value\">{}</td><td class=\"unit\">{}</td><td>{}{}</td></tr>\n",
                        escaped(row.name), escaped(row.value), escaped(row.unit), mark, escaped(row.remark));
  }
  return html + "</table>\n";
}

std::string table(const ReportTable& t) {
  std::string html = "<table>\n<caption>" + escaped(t.title) + "</caption>\n<tr>";
  for (const auto& column : t.columns) html += "<th>" + escaped(column) + "</th>";
  html += "</tr>\n";
  for (const auto& row : t.rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      html += (i == 0 ? "<th>" : "<td class=\"value\">") + escaped(row[i]) + (i == 0 ? "</th>" : "</td>");
    }
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

std::string figure(const ReportFigure& f) {
  if (f.image.empty() || (f.image.type() != CV_8UC1 && f.image.type() != CV_8UC3)) {
    throw std::invalid_argument("render_html: figure '" + f.caption + "' must be CV_8UC1 or CV_8UC3 and not empty");
  }
  const bool png = f.format == FigureFormat::Png;
  std::vector<unsigned char> bytes;
  cv::imencode(png ? ".png" : ".jpg", f.image, bytes,
               png ? std::vector<int>{} : std::vector<int>{cv::IMWRITE_JPEG_QUALITY, 88});
  return fmt::format(
      "<figure><img alt=\"{0}\" src=\"data:image/{1};base64,{2}\"><figcaption>{0}</figcaption></figure>\n",
      escaped(f.caption), png ? "png" : "jpeg", to_base64(bytes));
}

std::string section(const ReportSection& s) {
  std::string html = s.title.empty() ? std::string() : "<h2>" + escaped(s.title) + "</h2>\n";
  for (const auto& paragraph : s.paragraphs) html += "<p>" + escaped(paragraph) + "</p>\n";
  html += table(s.rows);
  for (const auto& t : s.tables) html += table(t);
  for (const auto& f : s.figures) html += figure(f);
  return html;
}

std::string command_line(const std::vector<std::string>& arguments) {
  std::string line;
  for (const auto& word : arguments) {
    if (!line.empty()) line += ' ';
    line += quoted(word);
  }
  return line;
}

[[noreturn]] void fail(const std::filesystem::path& path, const char* operation) {
  throw DeviceError(path.string(), operation, std::strerror(errno), "check the folder, its rights and the free space");
}

}  // namespace

std::vector<ReportRow> rows_of(std::span<const std::string> lines) {
  std::vector<ReportRow> rows;
  for (const std::string& line : lines) {
    const std::size_t colon = std::min(line.find(':'), line.size());
    rows.push_back({line.substr(0, colon), line.substr(std::min(line.size(), colon + 2)), "", Verdict::None, ""});
  }
  return rows;
}

std::string render_html(const Report& report) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">"
      "<title>{0}</title><style>{1}</style></head>\n<body><main>\n<h1>{0}</h1>\n",
      escaped(report.title), kStyle);
  if (!report.arguments.empty()) html += "<pre>" + escaped(command_line(report.arguments)) + "</pre>\n";
  for (const auto& warning : report.warnings) html += "<p class=\"warning\">" + escaped(warning) + "</p>\n";
  html += table(report.summary);
  for (const auto& s : report.sections) html += section(s);
  if (!report.links.empty()) {
    html += "<h2>Files</h2>\n<ul>\n";
    for (const auto& link : report.links) {
      html += fmt::format("<li><a href=\"{0}\">{0}</a> {1}</li>\n", escaped(link.file), escaped(link.what));
    }
    html += "</ul>\n";
  }
  if (!report.options.empty()) html += "<h2>Options</h2>\n<pre>" + escaped(report.options) + "</pre>\n";
  return html + "</main></body></html>\n";
}

void write_report(const std::filesystem::path& path, const Report& report) {
  const std::string html = render_html(report);
  const std::filesystem::path part = path.string() + ".part";
  std::ofstream out(part, std::ios::binary | std::ios::trunc);
  if (!out) fail(part, "open");
  out << html;
  out.close();
  if (!out) fail(part, "write");
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error) throw DeviceError(path.string(), "rename", error.message(), "check the folder and its rights");
}

}  // namespace alidade
