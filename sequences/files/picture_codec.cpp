// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/picture_codec.h"

#include <dlfcn.h>

#include "sequences/files/errors.h"
#include "sequences/files/program_folder.h"

namespace talisman::sequences {
namespace {

const PictureCodec* load_codec() {
  const std::string file = picture_module();
  void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);  // for as long as the program lasts
  void* symbol = module ? ::dlsym(module, kPictureCodecSymbol) : nullptr;
  if (!symbol) {
    const char* why = ::dlerror();
    throw OutputError("pictures cannot be read or written: " + std::string(why ? why : file));
  }
  return reinterpret_cast<PictureCodecFunction*>(symbol)();
}

}  // namespace

const PictureCodec& picture_codec() {
  static const PictureCodec* const codec = load_codec();
  return *codec;
}

}  // namespace talisman::sequences
