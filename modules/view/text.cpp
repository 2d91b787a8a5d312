// SPDX-License-Identifier: Apache-2.0
#include "view/text.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <mutex>

#include <vtkFreeTypeTools.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkTextProperty.h>
#include <vtkUnicodeString.h>

namespace alidade {
namespace {

// VTK's glyph cache is one per process and not thread-safe.
std::mutex& font_cache_mutex() {
  static std::mutex mutex;
  return mutex;
}

// VTK's own font has no Greek and no signs beyond ASCII; Debian's fontconfig brings this one.
constexpr const char* kFontFile = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr const char* kBoldFontFile = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";

void choose_font(vtkTextProperty* property, bool bold) {
  const char* file = bold ? kBoldFontFile : kFontFile;
  if (std::filesystem::exists(file)) {
    property->SetFontFamily(VTK_FONT_FILE);
    property->SetFontFile(file);
  } else {
    property->SetFontFamilyToArial();
    property->SetBold(bold);
  }
}

// The successor of this deprecated call drops every sign beyond ASCII in VTK 9.1.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
bool render(const std::string& text, vtkTextProperty* property, vtkImageData* image) {
  constexpr int kDotsPerInch = 72;  // so that a point of VTK's font size is a pixel
  int size[2] = {0, 0};
  auto* tools = vtkFreeTypeTools::GetInstance();
  tools->SetScaleToPowerTwo(false);
  return tools->RenderString(property, vtkUnicodeString::from_utf8(text), kDotsPerInch, image, size) && size[0] > 0;
}
#pragma GCC diagnostic pop

}  // namespace

cv::Mat text_mask(const std::string& text, const TextFont& font) {
  vtkNew<vtkTextProperty> property;
  choose_font(property, font.bold);
  property->SetFontSize(std::max(1, static_cast<int>(std::lround(font.size_px))));
  property->SetColor(1, 1, 1);
  vtkNew<vtkImageData> image;
  const std::lock_guard lock(font_cache_mutex());
  if (text.empty() || !render(text, property, image)) return cv::Mat::zeros(1, 1, CV_8UC1);
  const int* extent = image->GetExtent();  // starts left of zero where the first glyph overhangs
  cv::Mat mask(extent[3] - extent[2] + 1, extent[1] - extent[0] + 1, CV_8UC1);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      const auto* rgba = static_cast<const unsigned char*>(image->GetScalarPointer(extent[0] + x, extent[3] - y, 0));
      mask.at<unsigned char>(y, x) = rgba[3];
    }
  }
  return mask;
}

}  // namespace alidade
