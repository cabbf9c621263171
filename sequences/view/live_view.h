// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the live view answers, apart from how it is asked: requests as JSON in, JSON or PNG out. Any number of threads may
/// ask; plans of different tabs are made beside each other, pictures one after another.

#include <atomic>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "sequences/view/http_service.h"
#include "sequences/view/live_pictures.h"
#include "sequences/view/live_plan.h"

namespace talisman::sequences {

class LiveView {
 public:
  /// What is being made when `stop` becomes true is given up.
  LiveView(ViewSource source, const std::atomic<bool>& stop) : source_(std::move(source)), stop_(stop) {}

  /// The sequence, its layers, settings and effects; or why there is none.
  ViewAnswer about();
  ViewAnswer plan(const std::string& body);   ///< rows from frame `from` on, as far as a slice of time goes
  ViewAnswer frame(const std::string& body);  ///< all columns of `frame`; of no rows while it is not planned
  ViewAnswer lines(const std::string& body);  ///< the whole plan, as decisions.jsonl
  ViewAnswer picture(const std::string& body);  ///< `frame` in `mode`, a PNG
  ViewAnswer save(const std::string& body);     ///< the flight, under `name`

 private:
  static constexpr std::size_t kMostTabs = 4, kMostPictures = 4;
  /// Of planning in one answer, shared by those who plan at the same time. The first is soon there to be seen; those after
  /// it cost less on the way when they are few.
  static constexpr double kFirstSlice_ms = 80, kSlice_ms = 240;

  /// The plan of a tab. It is replaced rather than changed: what is being planned for a setting that is no more asked for
  /// ends by itself, and nobody waits for it.
  struct TabPlan {
    std::string tab, key, settings_key;
    std::mutex mutex;  ///< of the plan
    std::unique_ptr<LivePlan> plan;
  };
  struct KeptPictures {
    std::string key;
    std::unique_ptr<LivePictures> pictures;
  };

  void advance(LivePlan& plan, double slice_ms, const std::function<bool()>& is_stale);
  std::shared_ptr<TabPlan> kept_plan(const std::string& tab);
  std::shared_ptr<TabPlan> plan_of(const ViewRequest& request);
  LivePictures& pictures_of(const ViewRequest& request);
  bool is_stale(const ViewRequest& request, const std::string& what);

  ViewSource source_;
  const std::atomic<bool>& stop_;
  std::atomic<int> planning_ = 0;
  std::mutex tabs_mutex_, pictures_mutex_, requests_mutex_;
  std::list<std::shared_ptr<TabPlan>> tabs_;  ///< the one asked for last is the first
  ReadyScenes ready_;
  std::list<KeptPictures> pictures_;                   ///< likewise
  std::map<std::string, std::int64_t> last_requests_;  ///< by what was asked for, and the tab
};

}  // namespace talisman::sequences
