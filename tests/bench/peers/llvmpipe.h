// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Mesa's software rasteriser llvmpipe through OSMesa, on one thread.

#include <memory>
#include <string>

#include "tests/bench/peers/ball.h"

namespace talisman::bench {

class Llvmpipe {
 public:
  /// A context; `frame`'s first part, material, texture, ambient and directional light are uploaded. Throws
  /// std::runtime_error: no context, or Mesa has another software driver than llvmpipe.
  explicit Llvmpipe(const layers::SceneFrame& frame);
  ~Llvmpipe();
  Llvmpipe(const Llvmpipe&) = delete;
  Llvmpipe& operator=(const Llvmpipe&) = delete;

  /// Clears, draws and waits; with 4 samples also resolves them.
  void draw(bool four_samples);
  const LinearBytes& picture() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace talisman::bench
