// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/picture_codec.h"

#include "sequences/files/program_folder.h"

namespace talisman::sequences {
namespace {

const PictureCodec* load_codec() {
  void* const symbol =
      program_symbol("talisman_pictures.so", kPictureCodecSymbol, "pictures cannot be read or written");
  return reinterpret_cast<PictureCodecFunction*>(symbol)();
}

}  // namespace

const PictureCodec& picture_codec() {
  static const PictureCodec* const codec = load_codec();
  return *codec;
}

}  // namespace talisman::sequences
