// SPDX-License-Identifier: Apache-2.0

// talisman_import PATH SECONDS MEGABYTES [FOLDER…]: reads a model (glTF 2, OBJ, PLY and STL by readers made for them, all others with
// assimp) and writes it to stdout as a scene stream. FOLDER: where else files that it names may lie. Started by
// import_model; limits itself first, so that nothing in the file can take more than that.

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "sequences/import/assimp_scene.h"
#include "sequences/import/gltf_scene.h"
#include "sequences/import/scene_stream.h"
#include "sequences/import/surfaces/obj_scene.h"
#include "sequences/import/surfaces/ply_scene.h"
#include "sequences/import/surfaces/stl_scene.h"

namespace {

using talisman::sequences::ExitCode;

void limit(int resource, rlim_t soft) {
  const rlimit limits{soft, soft};
  setrlimit(resource, &limits);
}

void limit_ourselves(int seconds, long megabytes) {
  std::signal(SIGINT, SIG_IGN);  // Ctrl-C is for the tool; it ends its reader when it ends itself
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  limit(RLIMIT_CPU, static_cast<rlim_t>(seconds));
  limit(RLIMIT_CORE, 0);
#if !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)  // they reserve terabytes of address space
  limit(RLIMIT_AS, static_cast<rlim_t>(megabytes) << 20);
#else
  (void)megabytes;
#endif
}

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
  if (argc < 4) return fail("usage: talisman_import PATH SECONDS MEGABYTES [FOLDER…] (started by talisman)");
  limit_ourselves(std::atoi(argv[2]), std::atol(argv[3]));
  try {
    const auto bytes = talisman::sequences::bytes_from_model(read_model({argv[1], {argv + 4, argv + argc}}));
    if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() || std::fflush(stdout) != 0)
      return fail("the reader could not hand its result over");
    _exit(ExitCode::kSuccess);  // libraries of readers are not trusted to end cleanly either
  } catch (const std::bad_alloc&) {
    return fail("needs more memory than its reader may take");
  } catch (const std::exception& e) {
    return fail(e.what());
  }
}
