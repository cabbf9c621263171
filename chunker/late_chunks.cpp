// SPDX-License-Identifier: Apache-2.0
#include "chunker/late_chunks.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "chunker/chunk_work.h"
#include "chunker/prepared.h"
#include "chunker/raster.h"

namespace talisman::chunker {
namespace {

/// Triangles and their bins, of the sprite's own instant. A list stays where it is: shaders refer to it.
struct KeptTriangles {
  DrawList list;
  ChunkWork work;
  std::shared_ptr<const PreparedScene::Impl> textures;  ///< that the shaders refer to
};

template <int kCount>
class DrawnWhenRead final : public LateChunks {
 public:
  DrawnWhenRead(std::unique_ptr<KeptTriangles> kept, const RenderOptions& options)
      : kept_(std::move(kept)), options_(options), slots_(kept_->work.places.size()) {
    not_drawn_ = count();
  }

  int count() const override { return static_cast<int>(slots_.size()); }
  const Chunk* chunk(int slot) override { return drawn(slot).chunk.get(); }
  std::uint16_t opaque_blocks(int slot) override {
    const Slot& at = drawn(slot);
    return at.chunk ? at.opaque : std::uint16_t{0};
  }

  bool all_drawn() const override { return kept_ == nullptr; }
  RenderCounters rest() override {
    RenderCounters counters = std::exchange(counted_, {});
    for (const auto& renderer : idle_) counters += renderer->counters();
    idle_.clear();
    if (not_drawn_ == 0) kept_.reset();
    return counters;
  }

 private:
  enum class State : std::uint8_t { NotDrawn, BeingDrawn, Drawn };
  struct Slot {
    std::atomic<State> state{State::NotDrawn};
    std::uint16_t opaque = 0;
    std::unique_ptr<Chunk> chunk;  ///< null: clear, or not drawn
  };

  const Slot& drawn(int slot) {
    Slot& at = slots_[slot];
    for (;;) {
      State state = at.state.load(std::memory_order_acquire);
      if (state == State::Drawn) return at;
      if (state == State::NotDrawn && at.state.compare_exchange_strong(state, State::BeingDrawn))
        draw_for_all(slot, at);
      else
        at.state.wait(State::BeingDrawn, std::memory_order_acquire);
    }
  }

  /// Whoever waits goes on, also where memory ran out.
  void draw_for_all(int slot, Slot& at) {
    const auto tell = [&at](State state) {
      at.state.store(state, std::memory_order_release);
      at.state.notify_all();
    };
    try {
      draw(slot, at);
    } catch (...) {
      tell(State::NotDrawn);
      throw;
    }
    tell(State::Drawn);
  }

  void draw(int slot, Slot& at) {
    const int place = kept_->work.places[slot], columns = kept_->work.bins.chunks.x;
    std::unique_ptr<ChunkRenderer<kCount>> renderer = take_renderer();
    const Chunk chunk = renderer->draw(kept_->work.bins.of(place),
                                       {place % columns * kChunkSize, place / columns * kChunkSize});
    if (is_clear_chunk(chunk)) {
      give_back(std::move(renderer), {.chunks_clear = 1});
      return;
    }
    at.opaque = opaque_blocks_of(chunk);
    at.chunk = std::make_unique<Chunk>(chunk);
    give_back(std::move(renderer), {.chunks_rendered = 1});
  }

  std::unique_ptr<ChunkRenderer<kCount>> take_renderer() {
    {
      const std::scoped_lock lock(mutex_);
      if (!idle_.empty()) {
        auto renderer = std::move(idle_.back());
        idle_.pop_back();
        return renderer;
      }
    }
    return std::make_unique<ChunkRenderer<kCount>>(kept_->list, options_);
  }

  void give_back(std::unique_ptr<ChunkRenderer<kCount>> renderer, const RenderCounters& more) {
    const std::scoped_lock lock(mutex_);
    idle_.push_back(std::move(renderer));
    counted_ += more;
    --not_drawn_;
  }

  std::unique_ptr<KeptTriangles> kept_;
  RenderOptions options_;
  std::vector<Slot> slots_;
  std::mutex mutex_;  ///< of what follows
  std::vector<std::unique_ptr<ChunkRenderer<kCount>>> idle_;
  RenderCounters counted_;
  int not_drawn_ = 0;
};

/// What is looked up may be gone, or another, when a chunk is drawn.
bool looks_up(const ShadeInputs& inputs) {
  const auto there = [](const ShadowMap* map) { return map != nullptr; };
  return !inputs.reflections.empty() ||
         std::any_of(inputs.shadow_maps.begin(), inputs.shadow_maps.end(), there);
}

}  // namespace

RenderResult render_late(const PreparedScene& prepared, const layers::SceneFrame& frame,
                         std::span<const int> parts, layers::ivec2 display_px,
                         const layers::SpritePlacement& placement, const RenderOptions& options,
                         const ShadeInputs& inputs) {
  if (looks_up(inputs)) return render(prepared, frame, parts, display_px, placement, options, inputs);
  auto kept = std::make_unique<KeptTriangles>();
  kept->work = set_up_chunks(prepared, frame, parts, display_px, placement, options, inputs, kept->list);
  kept->textures = prepared.shared_impl();
  RenderResult result;
  result.counters.polygons_in = kept->list.polygons_in;
  result.counters.polygons_drawn = static_cast<std::int64_t>(kept->list.triangles.size());
  const std::vector<int> places = kept->work.places;
  result.counters.chunks_clear = kept->work.bins.count() - static_cast<std::int64_t>(places.size());
  const layers::ivec2 size = kept->list.size_px;
  std::shared_ptr<LateChunks> late =
      with_samples(options.samples, [&](auto count) -> std::shared_ptr<LateChunks> {
        return std::make_shared<DrawnWhenRead<decltype(count)::value>>(std::move(kept), options);
      });
  result.sprite = Sprite::late(size, places, std::move(late));
  return result;
}

}  // namespace talisman::chunker
