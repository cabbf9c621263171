// SPDX-License-Identifier: Apache-2.0
#include "sequences/view/flights.h"

#include <cstdio>
#include <filesystem>

#include "layers/scene.h"
#include "sequences/content/starter/yaml_page.h"
#include "sequences/files/errors.h"
#include "sequences/files/folders.h"

namespace talisman::sequences {

namespace {

constexpr const char* kFlownNode = "camera of the live view";
constexpr std::size_t kLongestName = 64;

std::string flight_yaml(const ViewSource& source, const layers::Camera& camera, double fps,
                        const ViewRequest& request) {
  std::string text = "# A flight recorded in the live view of " + yaml_text(source.name) + "\n";
  text += "extends: " + yaml_text(std::filesystem::absolute(source.base).string()) + "\n";
  text += "name: " + yaml_text(request.name) + "\nframes: " + std::to_string(request.flight.size()) + "\n";
  text += "camera:\n  fov_deg: " + yaml_number(glm::degrees(camera.fov_y_rad)) +
          "\n  near_m: " + yaml_number(camera.near_m) + "\n  far_m: " + yaml_number(camera.far_m) +
          "\n  flight:\n";
  for (std::size_t f = 0; f < request.flight.size(); ++f)
    text += "    - {t: " + yaml_number(static_cast<double>(f) / fps) +
            ", position: " + yaml_vector(request.flight[f].position) +
            ", target: " + yaml_vector(request.flight[f].target) + "}\n";
  return text;
}

}  // namespace

layers::Scene flyable(const layers::Scene& scene) {
  layers::Scene copy = scene;
  copy.nodes.push_back({kFlownNode, -1, {}, {}});
  copy.tracks.push_back({static_cast<int>(copy.nodes.size()) - 1, layers::FlightTrack{}});
  copy.cameras[copy.active_camera].node = static_cast<int>(copy.nodes.size()) - 1;
  return copy;
}

void fly(layers::Scene& scene, const std::vector<CameraPose>& flight, double fps) {
  layers::FlightTrack track;
  track.position.interpolation = track.target.interpolation = track.bank_rad.interpolation =
      layers::Interpolation::CatmullRom;
  for (std::size_t f = 0; f < flight.size(); ++f) {
    const double t_s = static_cast<double>(f) / fps;
    track.position.times_s.push_back(t_s);
    track.position.values.push_back(flight[f].position);
    track.target.times_s.push_back(t_s);
    track.target.values.push_back(flight[f].target);
  }
  scene.tracks.back().motion = std::move(track);
}

std::string save_flight(const ViewSource& source, const layers::Camera& camera, double fps,
                        const ViewRequest& request) {
  const std::string letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  if (request.name.empty() || request.name.size() > kLongestName ||
      request.name.find_first_not_of(letters) != std::string::npos)
    throw InputError("the name of a flight must be 1 to 64 letters, digits, '-' or '_'");
  if (source.base.empty())
    throw InputError("a flight is saved for a sequence file; talisman init makes one of a model");
  if (request.flight.size() < 2) throw InputError("a flight must have at least two frames");
  create_folder(source.out);
  std::string path = source.out + "/" + request.name + ".yaml";
  std::FILE* const file = std::fopen(path.c_str(), "wx");  // new files alone
  if (!file) throw InputError("cannot be made, must be a new name", path);
  const std::string text = flight_yaml(source, camera, fps, request);
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  if (std::fclose(file) == 0 && written) return path;
  std::remove(path.c_str());
  throw OutputError(path + ": cannot be written");
}

}  // namespace talisman::sequences
