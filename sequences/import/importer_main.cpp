// SPDX-License-Identifier: Apache-2.0

// talisman_import PATH SECONDS MEGABYTES [FOLDER…]: reads a model (glTF 2, OBJ, PLY and STL by readers made for them, all others with
// assimp) and writes it to stdout as a scene stream. FOLDER: where else files that it names may lie. Started by
// import_model; confines itself first (confinement.h), so that nothing in the file can take or do more than that.
// talisman_import --confinement: says what holds here.

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>

#include <unistd.h>

#include "sequences/import/assimp_scene.h"
#include "sequences/import/confinement.h"
#include "sequences/import/gltf_scene.h"
#include "sequences/import/scene_stream.h"
#include "sequences/import/surfaces/obj_scene.h"
#include "sequences/import/surfaces/ply_scene.h"
#include "sequences/import/surfaces/stl_scene.h"

namespace {

using talisman::sequences::ExitCode;

/// glTF 1 has the same extensions, and assimp reads it.
talisman::sequences::ImportedModel read_model(const talisman::sequences::ModelPlace& place) {
  if (talisman::sequences::is_gltf2(place.path)) return talisman::sequences::read_gltf(place);
  if (talisman::sequences::is_obj(place.path)) return talisman::sequences::read_obj(place);
  if (talisman::sequences::is_stl(place.path)) return talisman::sequences::read_stl(place);
  if (talisman::sequences::is_ply(place.path)) return talisman::sequences::read_ply(place);
  return talisman::sequences::read_with_assimp(place);
}

int fail(const char* what) {
  std::fprintf(stderr, "error: %s\n", what);
  return ExitCode::kBadInput;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string(argv[1]) == talisman::sequences::kAskForConfinement) {
    const talisman::sequences::ImportLimits usual;
    const std::string why = talisman::sequences::confine(usual.seconds, usual.megabytes);
    std::printf("%s\n", talisman::sequences::confinement_in_words(why).c_str());
    return ExitCode::kSuccess;
  }
  if (argc < 4) return fail("usage: talisman_import PATH SECONDS MEGABYTES [FOLDER…] (started by talisman)");
  talisman::sequences::confine(std::atoi(argv[2]), std::atol(argv[3]));
  try {
    const auto bytes = talisman::sequences::bytes_from_model(read_model({argv[1], {argv + 4, argv + argc}}));
    if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() || std::fflush(stdout) != 0)
      return fail("the reader could not hand its result over");
    _exit(ExitCode::kSuccess);  // libraries of readers are not trusted to end cleanly either
  } catch (const std::bad_alloc&) {
    return fail(
        ("needs more memory to read than the limit of " + std::string(argv[3]) + " MB (--import-memory-mb)")
            .c_str());
  } catch (const std::exception& e) {
    return fail(e.what());
  }
}
