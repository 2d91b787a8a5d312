// SPDX-License-Identifier: Apache-2.0
#include "io/colmap_model.h"

#include <algorithm>
#include <map>
#include <span>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/camera_file.h"
#include "io/camera_records.h"
#include "io/text_lines.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

const Eigen::Vector2d kCorner(0.5, 0.5);  // COLMAP's origin is the corner of the top-left pixel, ours its centre

std::string image_lines(const Keyframe& keyframe, std::size_t id) {
  const Eigen::Isometry3d T_camera_world = keyframe.T_world_camera.inverse();
  const Eigen::Quaterniond q(T_camera_world.linear());
  const Eigen::Vector3d t = T_camera_world.translation();
  const std::string name = keyframe.image.empty() ? fmt::format("frame-{:06}", keyframe.frame) : keyframe.image;
  std::string lines =
      fmt::format("{} {} {} {} {} {} {} {} 1 {}\n", id, q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z(), name);
  const char* separator = "";
  for (const Sighting& sighting : keyframe.sightings) {
    const Eigen::Vector2d pixel = sighting.pixel + kCorner;
    lines += fmt::format("{}{} {} {}", separator, pixel.x(), pixel.y(), sighting.point < 0 ? -1 : sighting.point + 1);
    separator = " ";
  }
  return lines + "\n";
}

/// Who sees a point, and how well.
struct Track {
  std::string entries;  // " IMAGE_ID POINT2D_IDX" of each sighting
  double error_sum_px = 0;
  int sightings = 0;
};

std::vector<Track> find_tracks(const Camera& camera, const PointMap& map) {
  std::vector<Track> tracks(map.points.size());
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Keyframe& keyframe = map.keyframes[k];
    const Eigen::Isometry3d T_camera_world = keyframe.T_world_camera.inverse();
    for (std::size_t i = 0; i < keyframe.sightings.size(); ++i) {
      const Sighting& sighting = keyframe.sightings[i];
      if (sighting.point < 0) continue;
      if (static_cast<std::size_t>(sighting.point) >= tracks.size()) {
        throw std::invalid_argument("write_colmap_model: a sighting of a point that is not in the map");
      }
      const auto point = static_cast<std::size_t>(sighting.point);
      Track& track = tracks[point];
      track.entries += fmt::format(" {} {}", k + 1, i);
      const auto projection = project(camera, T_camera_world * map.points[point].p_world);
      if (!projection) continue;
      track.error_sum_px += (projection->pixel - sighting.pixel).norm();
      ++track.sightings;
    }
  }
  return tracks;
}

/// A line of images.txt with the line of sightings after it, which may be empty.
struct ImageLines {
  TextLine image, points;
};

std::vector<ImageLines> read_image_lines(const fs::path& path) {
  const std::string text = read_bytes(path);
  std::string_view rest = text;
  std::vector<ImageLines> images;
  bool points_follow = false;
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    const std::string line(trim(rest.substr(0, end)));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (points_follow) {
      images.back().points = {number, line};
      points_follow = false;
    } else if (!line.empty() && line.front() != '#') {
      images.push_back({{number, line}, {}});
      points_follow = true;
    }
  }
  return images;
}

class ModelReader {
 public:
  explicit ModelReader(const fs::path& folder)
      : images_path_(folder / "images.txt"),
        points_path_(folder / "points3D.txt"),
        cameras_(read_cameras(folder / "cameras.txt")) {}

  ColmapModel read() {
    read_points();
    std::vector<ImageLines> images = read_image_lines(images_path_);
    for (const ImageLines& lines : images) model_.map.keyframes.push_back(read_keyframe(lines));
    std::sort(model_.map.keyframes.begin(), model_.map.keyframes.end(),
              [](const Keyframe& a, const Keyframe& b) { return a.frame < b.frame; });
    if (images.empty()) throw InputError(images_path_, 0, "holds no images", "");
    return model_;
  }

 private:
  void read_points() {
    std::map<long long, MapPoint> points;
    for (const TextLine& line : read_lines(points_path_)) {
      const auto words = split_words(line.text);
      if (words.size() < 8) {
        throw InputError(points_path_, line.number, "POINT3D_ID X Y Z R G B ERROR TRACK... are wanted", "");
      }
      MapPoint& point = points[parse_integer(points_path_, line.number, words[0])];
      for (std::size_t i = 0; i < 3; ++i) {
        point.p_world[static_cast<int>(i)] = parse_number(points_path_, line.number, words[1 + i]);
        const long long colour = parse_integer(points_path_, line.number, words[4 + i]);
        if (colour < 0 || colour > 255) throw InputError(points_path_, line.number, "colours are 0 to 255", "");
        point.rgb[i] = static_cast<std::uint8_t>(colour);
      }
    }
    for (const auto& [id, point] : points) {
      index_of_[id] = static_cast<int>(model_.map.points.size());
      model_.map.points.push_back(point);
    }
  }

  Keyframe read_keyframe(const ImageLines& lines) {
    const int number = lines.image.number;
    const auto words = split_words(lines.image.text);
    if (words.size() < 10) {
      throw InputError(images_path_, number, "IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME are wanted", "");
    }
    double v[7];
    for (std::size_t i = 0; i < 7; ++i) v[i] = parse_number(images_path_, number, words[1 + i]);
    const Eigen::Quaterniond q(v[0], v[1], v[2], v[3]);
    if (!(std::abs(q.norm() - 1.0) < 1e-2))
      throw InputError(images_path_, number, "the quaternion has not length 1", "");
    Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();
    T_camera_world.linear() = q.normalized().toRotationMatrix();
    T_camera_world.translation() = Eigen::Vector3d(v[4], v[5], v[6]);
    Keyframe keyframe;
    keyframe.frame = static_cast<int>(parse_integer(images_path_, number, words[0]) - 1);
    keyframe.time = Timestamp(std::chrono::seconds(keyframe.frame));
    keyframe.image = std::string(words[9].begin(), lines.image.text.data() + lines.image.text.size());
    keyframe.T_world_camera = T_camera_world.inverse();
    take_camera(number, words[8]);
    keyframe.sightings = read_sightings(lines.points);
    return keyframe;
  }

  void take_camera(int line, std::string_view id) {
    const auto found = std::find_if(cameras_.begin(), cameras_.end(), [&](const auto& c) { return c.name == id; });
    if (found == cameras_.end()) throw InputError(images_path_, line, fmt::format("there is no camera {}", id), "");
    if (model_.camera.width != 0 && model_.camera != found->camera) {
      throw InputError(images_path_, line, "another camera than that of the images before", "one camera is supported");
    }
    model_.camera = found->camera;
  }

  std::vector<Sighting> read_sightings(const TextLine& line) {
    const auto words = split_words(line.text);
    if (words.size() % 3 != 0) throw InputError(images_path_, line.number, "triples X Y POINT3D_ID are wanted", "");
    std::vector<Sighting> sightings;
    for (std::size_t i = 0; i < words.size(); i += 3) {
      const Eigen::Vector2d pixel(parse_number(images_path_, line.number, words[i]),
                                  parse_number(images_path_, line.number, words[i + 1]));
      const long long id = parse_integer(images_path_, line.number, words[i + 2]);
      const auto point = index_of_.find(id);
      if (id != -1 && point == index_of_.end()) {
        throw InputError(images_path_, line.number, fmt::format("there is no point {}", id), "");
      }
      Sighting& sighting = sightings.emplace_back();
      sighting.point = id == -1 ? -1 : point->second;
      sighting.pixel = pixel - kCorner;
    }
    return sightings;
  }

  fs::path images_path_, points_path_;
  std::vector<NamedCamera> cameras_;
  std::map<long long, int> index_of_;  // POINT3D_ID to PointMap::points
  ColmapModel model_;
};

}  // namespace

void write_colmap_model(const fs::path& folder, const Camera& camera, const PointMap& map) {
  const std::vector<Track> tracks = find_tracks(camera, map);
  write_file(folder / "cameras.txt", format_colmap_cameras(std::span(&camera, 1)));
  AtomicFile images(folder / "images.txt");
  images.write("# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME (camera from world)\n# POINTS2D[] as X Y POINT3D_ID\n");
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) images.write(image_lines(map.keyframes[k], k + 1));
  images.commit();
  AtomicFile points(folder / "points3D.txt");
  points.write("# POINT3D_ID X Y Z R G B ERROR TRACK[] as IMAGE_ID POINT2D_IDX\n");
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const MapPoint& point = map.points[i];
    const double error_px = tracks[i].sightings > 0 ? tracks[i].error_sum_px / tracks[i].sightings : -1.0;
    points.write(fmt::format("{} {} {} {} {} {} {} {}{}\n", i + 1, point.p_world.x(), point.p_world.y(),
                             point.p_world.z(), point.rgb[0], point.rgb[1], point.rgb[2], error_px, tracks[i].entries));
  }
  points.commit();
}

ColmapModel read_colmap_model(const fs::path& folder) {
  return ModelReader(folder).read();
}

}  // namespace alidade
