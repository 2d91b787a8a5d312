// SPDX-License-Identifier: Apache-2.0
#include "view/scene_actors.h"

#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

#include <opencv2/imgproc.hpp>
#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkTexture.h>
#include <vtkUnsignedCharArray.h>

namespace alidade {
namespace {

// A mesh of one kind of cell with a colour per cell, in float coordinates about an origin.
class ColouredMesh {
 public:
  explicit ColouredMesh(Eigen::Vector3d origin) : origin_(std::move(origin)) {
    colours_->SetNumberOfComponents(3);
    points_->SetDataTypeToFloat();
  }

  vtkIdType add_point(const Eigen::Vector3d& p_world) {
    const Eigen::Vector3d p = p_world - origin_;
    return points_->InsertNextPoint(p.x(), p.y(), p.z());
  }

  void add_cell(std::initializer_list<vtkIdType> corners, const Rgb& colour) {
    cells_->InsertNextCell(static_cast<vtkIdType>(corners.size()), corners.begin());
    colours_->InsertNextTypedTuple(colour.data());
  }

  vtkSmartPointer<vtkActor> make_actor(void (vtkPolyData::*set_cells)(vtkCellArray*)) {
    vtkNew<vtkPolyData> data;
    data->SetPoints(points_);
    (data->*set_cells)(cells_);
    data->GetCellData()->SetScalars(colours_);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(data);
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    actor->GetProperty()->LightingOff();
    return actor;
  }

 private:
  Eigen::Vector3d origin_;
  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> cells_;
  vtkNew<vtkUnsignedCharArray> colours_;
};

Rgb shaded(const Rgb& colour, double factor) {
  Rgb out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = static_cast<std::uint8_t>(std::lround(colour[i] * factor));
  return out;
}

void add_points(vtkRenderer& stage, const Scene& scene, const Eigen::Vector3d& origin, double enlargement) {
  if (scene.points.empty()) return;
  ColouredMesh mesh(origin);
  for (const auto& point : scene.points) {
    if (point.p_world.allFinite()) mesh.add_cell({mesh.add_point(point.p_world)}, point.colour);
  }
  const auto actor = mesh.make_actor(&vtkPolyData::SetVerts);
  actor->GetProperty()->SetPointSize(static_cast<float>(scene.point_size_px * enlargement));
  stage.AddActor(actor);
}

void add_path(vtkRenderer& stage, const ScenePath& path, const Eigen::Vector3d& origin, double enlargement) {
  ColouredMesh mesh(origin);
  for (std::size_t i = 1; i < path.points_world.size(); ++i) {
    const auto &a = path.points_world[i - 1], &b = path.points_world[i];
    if (a.allFinite() && b.allFinite()) mesh.add_cell({mesh.add_point(a), mesh.add_point(b)}, path.colour);
  }
  const auto actor = mesh.make_actor(&vtkPolyData::SetLines);
  actor->GetProperty()->SetLineWidth(static_cast<float>(path.width_px * enlargement));
  stage.AddActor(actor);
}

void check_triangles(const char* what, const std::vector<Eigen::Vector3i>& triangles, std::size_t vertices) {
  for (const auto& triangle : triangles) {
    if (triangle.minCoeff() < 0 || static_cast<std::size_t>(triangle.maxCoeff()) >= vertices) {
      throw std::invalid_argument(std::string(what) + ": a triangle names a vertex that is not there");
    }
  }
}

void add_translucent(vtkRenderer& stage, const TranslucentSurface& surface, const Eigen::Vector3d& origin) {
  ColouredMesh mesh(origin);
  for (const auto& vertex : surface.vertices_world) mesh.add_point(vertex);
  for (const auto& t : surface.triangles) mesh.add_cell({t[0], t[1], t[2]}, surface.colour);
  const auto actor = mesh.make_actor(&vtkPolyData::SetPolys);
  actor->GetProperty()->SetOpacity(surface.opacity);
  actor->ForceTranslucentOn();
  stage.AddActor(actor);
}

// Sides of different brightness, as if light came from above and a little from the left of each camera.
void add_sides(ColouredMesh& mesh, const std::vector<Eigen::Vector3d>& corners, const Rgb& colour) {
  constexpr std::array<double, 4> kSideShades{1.0, 0.82, 0.68, 0.9};  // top, right, bottom, left
  std::array<vtkIdType, 5> at{};
  for (std::size_t i = 0; i < 5; ++i) at[i] = mesh.add_point(corners[i]);
  for (std::size_t side = 0; side < 4; ++side) {
    mesh.add_cell({at[0], at[1 + side], at[1 + (side + 1) % 4]}, shaded(colour, kSideShades[side]));
  }
  mesh.add_cell({at[1], at[2], at[3]}, shaded(colour, 0.75));
  mesh.add_cell({at[1], at[3], at[4]}, shaded(colour, 0.75));
}

void add_edges(ColouredMesh& mesh, const std::vector<Eigen::Vector3d>& corners, const Rgb& colour) {
  std::array<vtkIdType, 5> at{};
  for (std::size_t i = 0; i < 5; ++i) at[i] = mesh.add_point(corners[i]);
  for (std::size_t side = 0; side < 4; ++side) {
    mesh.add_cell({at[0], at[1 + side]}, colour);
    mesh.add_cell({at[1 + side], at[1 + (side + 1) % 4]}, colour);
  }
}

void add_pyramids(vtkRenderer& stage, const Scene& scene, const Eigen::Vector3d& origin, double enlargement) {
  if (scene.cameras.empty()) return;
  ColouredMesh sides(origin), edges(origin);
  for (const auto& camera : scene.cameras) {
    if (!camera.T_world_camera.matrix().allFinite()) continue;
    const auto corners = pyramid_corners(camera, scene);
    const bool solid = camera.style == PyramidStyle::Solid;
    if (solid) add_sides(sides, corners, camera.colour);
    add_edges(edges, corners, solid ? shaded(camera.colour, 0.5) : camera.colour);
  }
  const auto body = sides.make_actor(&vtkPolyData::SetPolys);
  const auto outline = edges.make_actor(&vtkPolyData::SetLines);
  outline->GetProperty()->SetLineWidth(static_cast<float>(1.6 * enlargement));
  stage.AddActor(body);
  stage.AddActor(outline);
}

void check(const TexturedSurface& surface) {
  if (surface.texture.type() != CV_8UC3 || surface.texture.empty()) {
    throw std::invalid_argument("TexturedSurface: texture must be CV_8UC3 and not empty");
  }
  const std::size_t count = surface.vertices_world.size();
  if (surface.texture_uv.size() != count) {
    throw std::invalid_argument("TexturedSurface: one texture_uv per vertex needed");
  }
  check_triangles("TexturedSurface", surface.triangles, count);
}

vtkSmartPointer<vtkTexture> make_texture(const cv::Mat& bgr) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(bgr.cols, bgr.rows, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  // Row 0 stays first: the texture's second coordinate runs down the picture like ours.
  cv::Mat rgb(bgr.size(), CV_8UC3, image->GetScalarPointer());
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  auto texture = vtkSmartPointer<vtkTexture>::New();
  texture->SetInputData(image);
  texture->InterpolateOn();
  texture->MipmapOn();
  texture->SetMaximumAnisotropicFiltering(1.0F);
  texture->RepeatOff();
  texture->EdgeClampOn();
  return texture;
}

void add_surface(vtkRenderer& stage, const TexturedSurface& surface, const Eigen::Vector3d& origin) {
  check(surface);
  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> uv;
  uv->SetNumberOfComponents(2);
  for (std::size_t i = 0; i < surface.vertices_world.size(); ++i) {
    const Eigen::Vector3d p = surface.vertices_world[i] - origin;
    points->InsertNextPoint(p.x(), p.y(), p.z());
    uv->InsertNextTuple2(surface.texture_uv[i].x(), surface.texture_uv[i].y());
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& t : surface.triangles) cells->InsertNextCell({t[0], t[1], t[2]});
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  data->GetPointData()->SetTCoords(uv);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->SetTexture(make_texture(surface.texture));
  actor->GetProperty()->LightingOff();
  stage.AddActor(actor);
}

}  // namespace

void fill_stage(vtkRenderer& stage, const Scene& scene, const Eigen::Vector3d& origin, double enlargement) {
  for (const auto& surface : scene.surfaces) check(surface);
  for (const auto& surface : scene.translucent) {
    check_triangles("TranslucentSurface", surface.triangles, surface.vertices_world.size());
  }
  stage.RemoveAllViewProps();
  for (const auto& surface : scene.surfaces) add_surface(stage, surface, origin);
  add_points(stage, scene, origin, enlargement);
  for (const auto& path : scene.paths) add_path(stage, path, origin, enlargement);
  add_pyramids(stage, scene, origin, enlargement);
  for (const auto& surface : scene.translucent) add_translucent(stage, surface, origin);
}

}  // namespace alidade
