// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands/verbs.h"
#include "core/nearest_name.h"
#include "io/camera_formats.h"
#include "io/rig_file.h"

namespace alidade {
namespace {

class ConvertCommand : public Command {
 public:
  explicit ConvertCommand(CLI::App& flags) {
    flags.add_option("CAMERAS", files_, "camera files of any known format; the cameras of several become one rig")
        ->required();
    flags.add_option("--size", size_, "width and height of the images in px, for files that do not say them")
        ->type_name("WIDTH HEIGHT")
        ->check(CLI::PositiveNumber)
        ->expected(2);
    std::vector<std::pair<std::string, CameraFormat>> formats;
    for (const CameraFormat format : {CameraFormat::Alidade, CameraFormat::OpenCv, CameraFormat::Ros,
                                      CameraFormat::Kalibr, CameraFormat::Colmap, CameraFormat::Mrcal}) {
      formats.emplace_back(to_string(format), format);
    }
    options_.add_choice("format", format_, formats, "format to write");
    options_.add("camera", camera_, "", "name of the only camera to write; default: all");
  }

  ExitCode run(const RunContext& context) override {
    CameraRig rig = read_all();
    if (!camera_.empty()) rig = {{find_camera(rig)}};
    write_cameras_as(context.output, format_, rig);
    const std::vector<std::string> losses = list_losses(format_, rig);
    for (const std::string& loss : losses) {
      context.warn(fmt::format("{}: format {} has no place for {}", context.output.string(), to_string(format_), loss));
    }
    context.publish({{"file", context.output.string()},
                     {"format", to_string(format_)},
                     {"cameras", rig.cameras.size()},
                     {"lost", losses}});
    const std::size_t count = rig.cameras.size();
    context.tell(fmt::format("{} {} written to {}", count, count == 1 ? "camera" : "cameras", context.output.string()));
    return ExitCode::Success;
  }

 private:
  // Cameras of several files bear their files' names: most formats call every camera the same.
  CameraRig read_all() const {
    std::optional<ImageSize> size;
    if (size_.size() == 2) size = ImageSize{size_[0], size_[1]};
    CameraRig all;
    for (const std::filesystem::path& file : files_) {
      CameraRig rig = read_camera_rig(file, size);
      for (RigCamera& camera : rig.cameras) {
        const std::string stem = file.stem();
        if (files_.size() > 1) camera.name = rig.cameras.size() == 1 ? stem : fmt::format("{}/{}", stem, camera.name);
        all.cameras.push_back(std::move(camera));
      }
    }
    return all;
  }

  RigCamera find_camera(const CameraRig& rig) const {
    std::vector<std::string_view> names;
    for (const RigCamera& camera : rig.cameras) {
      if (camera.name == camera_) return camera;
      names.push_back(camera.name);
    }
    throw InputError(files_.front(), 0, fmt::format("there is no camera '{}'", camera_), suggest_name(camera_, names));
  }

  std::vector<std::filesystem::path> files_;
  std::vector<int> size_;
  CameraFormat format_ = CameraFormat::Alidade;
  std::string camera_;
};

}  // namespace

Verb convert_verb() {
  return {"convert", "camera files between Alidade, OpenCV, ROS, Kalibr, COLMAP and mrcal",
          "alidade convert camchain.yaml --format opencv -o stereo.yml", OutputUse::File, make_command<ConvertCommand>};
}

}  // namespace alidade
