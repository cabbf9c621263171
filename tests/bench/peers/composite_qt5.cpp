// SPDX-License-Identifier: Apache-2.0
// Qt 5's raster engine: QPainter, smooth transform, 32-bit premultiplied.
#include <algorithm>
#include <memory>
#include <vector>

#include <QImage>
#include <QPainter>
#include <QTransform>

#include "tests/bench/peers/compositors.h"

namespace talisman::bench {

std::function<void()> qt5_compositor(const SpriteStack& stack, ArgbFrame& frame) {
  const auto image_over = [](const std::uint32_t* argb, layers::ivec2 size) {
    return QImage(reinterpret_cast<const uchar*>(argb), size.x, size.y, size.x * 4,
                  QImage::Format_ARGB32_Premultiplied);
  };
  auto images = std::make_shared<std::vector<QImage>>();
  for (const Picture& picture : stack.pictures)
    images->push_back(image_over(picture.argb.data(), picture.size_px));
  return [&stack, &frame, images] {
    std::fill(frame.begin(), frame.end(), kBackgroundArgb);
    QImage target(reinterpret_cast<uchar*>(frame.data()), kDisplay.x, kDisplay.y, kDisplay.x * 4,
                  QImage::Format_ARGB32_Premultiplied);
    QPainter painter(&target);
    painter.setRenderHint(QPainter::SmoothPixmapTransform, true);
    for (std::size_t i = 0; i < images->size(); ++i) {
      const layers::Affine2& m = stack.screen_from_sprite[i];
      painter.setTransform(QTransform(m.a, m.c, m.b, m.d, m.tx, m.ty));
      painter.drawImage(QPointF(0, 0), (*images)[i]);
    }
  };
}

}  // namespace talisman::bench
