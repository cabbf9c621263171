// SPDX-License-Identifier: Apache-2.0
#include "sequences/view/live_view.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "sequences/files/errors.h"
#include "sequences/results/column_tables.h"
#include "sequences/results/settings_json.h"
#include "sequences/view/flights.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kStale = 409, kInvalid = 422, kFailed_status = 500;

ViewAnswer error_answer(int status, const std::string& line) {
  return {status, Json{{"error", line}}.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

/// What `answer` says, or the tool's line.
template <typename Answer>
ViewAnswer answered(const Answer& answer) try {
  return answer();
} catch (const InputError& error) {
  return error_answer(kInvalid, error.what());
} catch (const std::exception& error) {
  return error_answer(kFailed_status, error.what());
}

Json vector_json(const layers::dvec3& v) { return {v.x, v.y, v.z}; }

Json controls_json(const std::vector<ViewControl>& controls) {
  Json json = Json::array();
  for (const ViewControl& control : controls)
    json.push_back({{"option", control.option},
                    {"group", control.group},
                    {"meaning", control.meaning},
                    {"words", control.words}});
  return json;
}

Json about_json(const ViewSource& source) {
  const Variant variant = live_scene(source, ViewRequest{}).variant;
  const Sequence& sequence = variant.sequence;
  Json effects = Json::array(), columns = Json::array();
  for (const layers::EffectCall& call : effects_of(variant))
    if (call.called) effects.push_back({{"name", layers::name(call.effect)}, {"why", call.why}});
  for (const ColumnInfo& column : live_columns())
    columns.push_back({{"name", column.name}, {"unit", column.unit}, {"meaning", column.meaning}});
  const layers::dmat4 camera = sequence.scene->at(0).camera.world_from_camera;
  return {{"sequence", sequence.name},
          {"frames", sequence.frames},
          {"fps", sequence.fps},
          {"effects", effects},
          {"columns", columns},
          {"controls", controls_json(source.controls)},
          {"modes", picture_mode_names()},
          {"settings", json_of(variant.settings)},
          {"camera",
           {{"position", vector_json(layers::dvec3(camera[3]))},
            {"forward", vector_json(-layers::dvec3(camera[2]))}}},
          {"folder", source.out},
          {"can_save", !source.base.empty()}};
}

}  // namespace

/// Plans a slice further. The more do so, the shorter it is: nobody is to wait long for an answer.
void LiveView::advance(LivePlan& plan, double slice_ms, const std::function<bool()>& is_stale) {
  struct Counted {
    explicit Counted(std::atomic<int>& of) : number(++of), counter(of) {}
    ~Counted() { --counter; }
    int number;
    std::atomic<int>& counter;
  };
  const Counted planning(planning_);
  plan.advance(slice_ms / planning.number, is_stale);
}

/// The tab's plan; null: it has none.
std::shared_ptr<LiveView::TabPlan> LiveView::kept_plan(const std::string& tab) {
  const std::lock_guard lock(tabs_mutex_);
  const auto found = std::find_if(tabs_.begin(), tabs_.end(), [&](const auto& t) { return t->tab == tab; });
  if (found == tabs_.end()) return nullptr;
  tabs_.splice(tabs_.begin(), tabs_, found);
  return tabs_.front();
}

/// The tab's plan, made where it has none or one of other settings. A setting that is invalid leaves it as it is.
std::shared_ptr<LiveView::TabPlan> LiveView::plan_of(const ViewRequest& request) {
  ViewRequest settings = request;
  settings.flight.clear();
  auto made = std::make_shared<TabPlan>();
  made->tab = request.tab;
  made->key = request.plan_key();
  made->settings_key = settings.plan_key();
  auto kept = kept_plan(request.tab);
  if (kept && kept->key == made->key) return kept;
  if (kept && kept->settings_key == made->settings_key) {  // another flight through the same scene
    const std::unique_lock idle(kept->mutex, std::try_to_lock);
    if (idle && kept->plan && kept->plan->follow(request.flight)) made->plan = std::move(kept->plan);
  }
  if (!made->plan) made->plan = std::make_unique<LivePlan>(live_scene(source_, request));
  const std::lock_guard lock(tabs_mutex_);
  tabs_.remove_if([&](const auto& other) { return other->tab == request.tab; });
  tabs_.push_front(made);
  if (tabs_.size() > kMostTabs) tabs_.pop_back();
  return made;
}

ViewAnswer LiveView::about() {
  if (!source_.fault.empty()) return error_answer(kInvalid, source_.fault);
  return answered([&] { return ViewAnswer{200, about_json(source_).dump()}; });
}

ViewAnswer LiveView::plan(const std::string& body) {
  return answered([&] {
    const ViewRequest request = view_request_from(body);
    if (is_stale(request, "plan")) return error_answer(kStale, "stale");
    const auto tab = plan_of(request);
    const std::lock_guard lock(tab->mutex);
    if (!tab->plan || is_stale(request, "plan")) return error_answer(kStale, "stale");
    advance(*tab->plan, request.from == 0 ? kFirstSlice_ms : kSlice_ms,
            [&] { return is_stale(request, "plan"); });
    Json answer = tab->plan->rows(request.from);
    if (request.from == 0) answer["settings"] = json_of(tab->plan->settings());
    return ViewAnswer{200, answer.dump()};
  });
}

ViewAnswer LiveView::frame(const std::string& body) {
  return answered([&] {
    const ViewRequest request = view_request_from(body);
    const auto tab = kept_plan(request.tab);
    if (!tab || tab->key != request.plan_key()) return error_answer(kStale, "stale");
    const std::lock_guard lock(tab->mutex);
    if (!tab->plan) return error_answer(kStale, "stale");
    return ViewAnswer{200, tab->plan->frame(request.frame).dump()};
  });
}

ViewAnswer LiveView::lines(const std::string& body) {
  return answered([&] {
    const ViewRequest request = view_request_from(body);
    const auto tab = plan_of(request);
    const std::lock_guard lock(tab->mutex);
    while (tab->plan && !stop_ && tab->plan->planned() < tab->plan->frames())
      advance(*tab->plan, kSlice_ms, [] { return false; });
    return tab->plan ? ViewAnswer{200, tab->plan->lines(), "application/x-ndjson"}
                     : error_answer(kStale, "stale");
  });
}

/// Notes the request; is there a later one of its tab for the same, or is there nobody any more to answer?
bool LiveView::is_stale(const ViewRequest& request, const std::string& what) {
  constexpr std::size_t kMostNoted = 256;
  const std::lock_guard lock(requests_mutex_);
  const std::string who = what + " " + request.tab;
  if (last_requests_.size() > kMostNoted && !last_requests_.contains(who)) last_requests_.clear();
  std::int64_t& last = last_requests_[who];
  last = std::max(last, request.request);
  return stop_ || request.request < last;
}

/// Under pictures_mutex_. Where they were asked for with another flight they go on, as long as the camera moves.
LivePictures& LiveView::pictures_of(const ViewRequest& request) {
  ViewRequest settings = request;
  settings.flight.clear();
  const std::string key = settings.plan_key() + (request.flight.empty() ? "" : " flown");
  const auto found = std::find_if(pictures_.begin(), pictures_.end(),
                                  [&](const KeptPictures& kept) { return kept.key == key; });
  if (found != pictures_.end()) {
    pictures_.splice(pictures_.begin(), pictures_, found);
  } else {
    LiveScene live = live_scene(source_, request);
    auto ready = ready_.of(live, request);
    auto made = std::make_unique<LivePictures>(std::move(live), std::move(ready));
    if (pictures_.size() >= kMostPictures) pictures_.pop_back();
    pictures_.push_front({key, std::move(made)});
  }
  const bool is_moving = request.scale < 1;
  pictures_.front().pictures->follow(request.flight, is_moving);
  return *pictures_.front().pictures;
}

ViewAnswer LiveView::picture(const std::string& body) {
  return answered([&] {
    const ViewRequest request = view_request_from(body);
    const PictureMode mode = picture_mode(request.mode);
    is_stale(request, "picture");
    const std::lock_guard lock(pictures_mutex_);
    if (is_stale(request, "picture")) return error_answer(kStale, "stale");
    const auto image =
        pictures_of(request).draw(request.frame, mode, [&] { return is_stale(request, "picture"); });
    if (!image) return error_answer(kStale, "stale");
    const EncodedPicture png = encoded_png(*image);
    if (!png.error.empty()) throw OutputError(png.error);
    return ViewAnswer{200, {png.bytes.begin(), png.bytes.end()}, "image/png"};
  });
}

ViewAnswer LiveView::save(const std::string& body) {
  return answered([&] {
    const ViewRequest request = view_request_from(body);
    const Variant variant = live_scene(source_, ViewRequest{}).variant;
    const layers::Scene& scene = *variant.sequence.scene;
    return ViewAnswer{200, Json{{"file", save_flight(source_, scene.cameras[scene.active_camera],
                                                     variant.sequence.fps, request)}}
                               .dump()};
  });
}

}  // namespace talisman::sequences
