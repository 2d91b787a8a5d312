// SPDX-License-Identifier: Apache-2.0
#include "capture/file_sources.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <glob.h>

#include "capture/decoding.h"
#include "capture/frame_queue.h"
#include "capture/image_names.h"
#include "capture/recording/recording.h"
#include "capture/recording/recording_group.h"
#include "core/errors.h"
#include "io/image_files.h"
#include "io/natural_order.h"
#include "io/table.h"
#include "io/text_lines.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

class ImageFiles : public FrameSource {
 public:
  ImageFiles(std::vector<TimedImage> images, bool timed, std::string description)
      : images_(std::move(images)), timed_(timed), description_(std::move(description)) {}

  std::optional<Frame> next(std::stop_token) override {
    if (next_ == images_.size()) return std::nullopt;
    const TimedImage& file = images_[next_];
    cv::Mat image = read_image(file.path);
    if (next_ == 0) first_size_ = image.size();
    if (image.size() != first_size_) {
      throw InputError(file.path, 0,
                       fmt::format("is {}x{} px, but '{}' is {}x{} px", image.cols, image.rows,
                                   images_.front().path.filename().string(), first_size_.width, first_size_.height),
                       "all images must come from one camera");
    }
    const int index = static_cast<int>(next_++);
    return Frame{index, file.time, file.path.filename(), std::move(image)};
  }

  std::optional<int> frame_count() const override { return static_cast<int>(images_.size()); }
  bool has_times() const override { return timed_; }
  std::string describe() const override { return description_; }

 private:
  std::vector<TimedImage> images_;
  bool timed_;
  std::string description_;
  std::size_t next_ = 0;
  cv::Size first_size_;
};

std::unique_ptr<FrameSource> open_names(const std::vector<fs::path>& images, std::optional<double> fps_hz,
                                        const std::string& description) {
  std::vector<TimedImage> timed;
  const auto times = times_in_names(images);
  const double period_s = 1.0 / fps_hz.value_or(1.0);
  for (std::size_t i = 0; i < images.size(); ++i) {
    timed.push_back({images[i], times ? (*times)[i] : Timestamp(from_seconds(static_cast<double>(i) * period_s))});
  }
  return open_images(std::move(timed), times || fps_hz, description);
}

// The table of times beside the images of a folder; empty where there is none that names images.
std::optional<fs::path> find_times(const fs::path& folder) {
  for (const char* name : {"times.csv", "frames.csv"}) {
    if (fs::exists(folder / name) && read_table(folder / name).has_column("image")) return folder / name;
  }
  return std::nullopt;
}

std::vector<TimedImage> read_times(const fs::path& path) {
  const Table table = read_table(path);
  const std::size_t time = table.column("t_ns"), image = table.column("image");
  std::vector<TimedImage> images;
  for (std::size_t i = 0; i < table.row_count(); ++i) {
    const Timestamp t{std::chrono::nanoseconds(table.integer(i, time))};
    if (!images.empty() && t <= images.back().time) throw table.error(i, "t_ns does not increase");
    images.push_back({path.parent_path() / table.text(i, image), t});
    if (!fs::exists(images.back().path)) throw table.error(i, "there is no image '" + table.text(i, image) + "'");
  }
  return images;
}

// One camera's recording; empty where the folder is none.
std::unique_ptr<FrameSource> open_recorded(const fs::path& folder) {
  const std::vector<fs::path> recordings = recordings_of(folder);
  if (recordings.empty()) return nullptr;
  if (recordings.size() == 1) return queued(decoded(open_recording(recordings.front())));
  throw InputError(folder, 0, fmt::format("holds the recordings of {} cameras", recordings.size()),
                   "name one of them: " + recordings.front().string());
}

std::unique_ptr<FrameSource> open_folder(const fs::path& folder, std::optional<double> fps_hz) {
  if (auto recording = open_recorded(folder)) return recording;
  const auto description = [&](std::size_t count) { return fmt::format("{} images in {}", count, folder.string()); };
  if (const auto times = find_times(folder)) {
    std::vector<TimedImage> images = read_times(*times);
    const std::size_t count = images.size();
    return open_images(std::move(images), true, description(count));
  }
  const std::vector<fs::path> images = list_images(folder);
  return open_names(images, fps_hz, description(images.size()));
}

std::vector<fs::path> expand(const std::string& pattern) {
  glob_t found{};
  std::vector<fs::path> images;
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0) {
    for (std::size_t i = 0; i < found.gl_pathc; ++i) {
      if (has_image_extension(found.gl_pathv[i])) images.emplace_back(found.gl_pathv[i]);
    }
  }
  ::globfree(&found);
  std::sort(images.begin(), images.end(),
            [](const fs::path& a, const fs::path& b) { return natural_less(a.native(), b.native()); });
  return images;
}

std::unique_ptr<FrameSource> open_list(const fs::path& path, std::optional<double> fps_hz) {
  std::vector<fs::path> images;
  std::vector<TimedImage> timed;
  for (const TextLine& line : read_lines(path)) {
    const std::size_t blank = line.text.find_first_of(" \t");
    const auto time = parse_seconds(line.text.substr(0, blank));
    const bool has_time = time && blank != std::string::npos;
    const std::string name(has_time ? trim(std::string_view(line.text).substr(blank)) : line.text);
    images.push_back(path.parent_path() / name);
    if (!fs::exists(images.back())) throw InputError(path, line.number, "there is no image '" + name + "'", "");
    if (!has_time) continue;
    if (!timed.empty() && *time <= timed.back().time) throw InputError(path, line.number, "time does not increase", "");
    timed.push_back({images.back(), *time});
  }
  const std::string description = fmt::format("{} images listed in {}", images.size(), path.string());
  if (!timed.empty() && timed.size() == images.size()) return open_images(std::move(timed), true, description);
  if (!timed.empty()) throw InputError(path, 0, "only some lines have a time", "give all or none");
  if (images.empty()) throw InputError(path, 0, "lists no images", "one file name per line is wanted");
  return open_names(images, fps_hz, description);
}

}  // namespace

std::unique_ptr<FrameSource> open_images(std::vector<TimedImage> images, bool timed, const std::string& description) {
  if (images.empty()) throw InputError(description, 0, "no images", "");
  return queued(std::make_unique<ImageFiles>(std::move(images), timed, description));
}

std::unique_ptr<FrameSource> open_files(const std::string& source, std::optional<double> fps_hz) {
  if (fps_hz && !(*fps_hz > 0 && *fps_hz < 1e6)) throw std::invalid_argument("open_files: fps_hz must be > 0");
  if (fs::is_directory(source)) return open_folder(source, fps_hz);
  if (!fs::exists(source)) {
    const bool pattern = source.find_first_of("*?[") != std::string::npos;
    const std::vector<fs::path> images = pattern ? expand(source) : std::vector<fs::path>{};
    if (!images.empty()) return open_names(images, fps_hz, fmt::format("{} images {}", images.size(), source));
    throw InputError(source, 0, pattern ? "matches no image" : "there is no such file or folder", "check the name");
  }
  if (has_image_extension(source)) return open_names({fs::path(source)}, fps_hz, "1 image " + source);
  const fs::path extension = fs::path(source).extension();
  if (extension == ".txt" || extension == ".lst") return open_list(source, fps_hz);
  if (extension == ".csv") {
    std::vector<TimedImage> images = read_times(source);
    const std::string description = fmt::format("{} images listed in {}", images.size(), source);
    return open_images(std::move(images), true, description);
  }
  return open_video(source, fps_hz);
}

bool is_video_name(const fs::path& path) {
  const fs::path extension = path.extension();
  const bool is_list = extension == ".txt" || extension == ".lst" || extension == ".csv";
  return fs::is_regular_file(path) && !is_list && !has_image_extension(path);
}

}  // namespace alidade
