// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/traces/pose_sieve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "layers/animation.h"
#include "sequences/content/value_type.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;

constexpr std::size_t kMostNoted = 1000;
constexpr double kJumpTimes = 10, kJumpMoved_m = 0.05, kJumpTurned_deg = 5;

BodyFrame usual_frame(TraceFormat format) {
  return format == TraceFormat::Iwer || format == TraceFormat::Bvh ? BodyFrame::Gl : BodyFrame::OpenCv;
}

/// U of trace.h.
glm::dquat turned_upright(UpwardAxis up) {
  const double half = std::numbers::sqrt2 / 2;
  if (up == UpwardAxis::Z) return {half, -half, 0, 0};
  return up == UpwardAxis::MinusY ? glm::dquat{0, 1, 0, 0} : glm::dquat{1, 0, 0, 0};
}

dvec3 upright(const dvec3& p, UpwardAxis up) {
  if (up == UpwardAxis::Z) return {p.x, p.z, -p.y};
  return up == UpwardAxis::MinusY ? dvec3{p.x, -p.y, -p.z} : p;
}

/// Of the shorter way from one rotation to the other.
double degrees_between(const glm::dquat& a, const glm::dquat& b) {
  const glm::dquat turn = glm::conjugate(a) * b;
  return glm::degrees(2 * std::atan2(std::hypot(turn.x, turn.y, turn.z), std::fabs(turn.w)));
}

/// The same rotation about the same axis, `times` as far.
glm::dquat further(const glm::dquat& turn, double times) {
  const glm::dquat q = turn.w < 0 ? -turn : turn;
  const double sine = std::hypot(q.x, q.y, q.z);
  if (sine == 0) return {1, 0, 0, 0};
  return glm::angleAxis(2 * times * std::atan2(sine, q.w), dvec3(q.x, q.y, q.z) / sine);
}

bool is_finite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

PoseSieve::PoseSieve(const TraceOptions& options, Out out)
    : options_(options),
      frame_(options.frame.value_or(usual_frame(options.format.value_or(format_of_name(options.file))))),
      out_(std::move(out)) {}

glm::dquat PoseSieve::checked(const RawPose& pose) const {
  const double norm = std::sqrt(glm::dot(pose.rotation, pose.rotation));
  if (!is_finite(pose.position) || !std::isfinite(norm))
    throw InputError("has a pose that is not finite, rule: finite numbers", options_.file, pose.line);
  if (!(std::fabs(norm - 1) <= 0.01))
    throw InputError("has a quaternion of norm " + shown(norm) + ", rule: 1, to 1 %", options_.file,
                     pose.line);
  return layers::unit(pose.rotation);
}

bool PoseSieve::add(const RawPose& raw) {
  if (!wanted_) return false;
  Held held;
  held.line = raw.line;
  const glm::dquat flip = frame_ == BodyFrame::OpenCv ? glm::dquat{0, 1, 0, 0} : glm::dquat{1, 0, 0, 0};
  held.pose.rotation = turned_upright(options_.up) * checked(raw) * flip;
  held.pose.position = upright(options_.scale * raw.position, options_.up);
  if (!first_) first_ = raw.stamp;
  held.pose.t_s = raw.stamp.since(*first_);
  if (!held_.empty()) {
    const Held& before = held_.back();
    held.step_s = held.pose.t_s - before.pose.t_s;
    if (!(held.step_s > 0))
      throw InputError("has a stamp " + shown(held.pose.t_s) +
                           " s after the first, and the one before it is " + shown(before.pose.t_s) +
                           " s after it, rule: each after the one before",
                       options_.file, raw.line);
    if (glm::dot(before.pose.rotation, held.pose.rotation) < 0) held.pose.rotation = -held.pose.rotation;
    held.moved_m = glm::distance(before.pose.position, held.pose.position);
    held.turned_deg = degrees_between(before.pose.rotation, held.pose.rotation);
    note_step(held);
  }
  ++findings_.poses;
  findings_.length_s = held.pose.t_s;
  held_.push_back(held);
  while (wanted_ && released_ + 2 < held_.size()) wanted_ = release(released_++);
  while (released_ > 2) held_.pop_front(), --released_;
  return wanted_;
}

void PoseSieve::note_step(const Held& held) {
  findings_.way_m += held.moved_m;
  findings_.step_s.add(held.step_s);
  findings_.speed_m_per_s.add(held.speed());
  findings_.turn_deg_per_s.add(held.turn());
  std::vector<TraceGap>& steps = findings_.longest_steps;
  if (steps.size() == kMostNoted && !(held.step_s > steps.back().length_s)) return;
  if (steps.size() == kMostNoted) steps.pop_back();
  const auto place = std::upper_bound(steps.begin(), steps.end(), held.step_s,
                                      [](double s, const TraceGap& step) { return s > step.length_s; });
  steps.insert(place, {held.pose.t_s - held.step_s, held.step_s, held.line});
}

/// The median of the speeds of the two steps before and the two after; of an even number the mean of the middle two.
double PoseSieve::beside(std::size_t index, double (Held::*speed)() const) const {
  std::vector<double> speeds;
  const std::size_t last = std::min(index + 2, held_.size() - 1);
  for (std::size_t i = index < 2 ? 0 : index - 2; i <= last; ++i)
    if (i != index && held_[i].step_s > 0) speeds.push_back((held_[i].*speed)());
  if (speeds.empty()) return HUGE_VAL;  // nothing to be faster than
  std::sort(speeds.begin(), speeds.end());
  const std::size_t middle = speeds.size() / 2;
  return speeds.size() % 2 == 1 ? speeds[middle] : (speeds[middle - 1] + speeds[middle]) / 2;
}

bool PoseSieve::release(std::size_t index) {
  const Held& held = held_[index];
  const double speed_beside = beside(index, &Held::speed), turn_beside = beside(index, &Held::turn);
  const bool moved = held.moved_m > kJumpMoved_m && held.speed() > kJumpTimes * speed_beside;
  const bool turned = held.turned_deg > kJumpTurned_deg && held.turn() > kJumpTimes * turn_beside;
  if ((moved || turned) && findings_.jump_count++ < static_cast<std::int64_t>(kMostNoted)) {
    const double times =
        std::max(moved ? held.speed() / speed_beside : 0, turned ? held.turn() / turn_beside : 0);
    findings_.jumps.push_back(
        {held.pose.t_s, turned ? held.turned_deg : 0, moved ? held.moved_m : 0, times, held.line});
  }
  if (options_.jumps == Jumps::Keep) return out_(held.pose);
  return out_(clipped(held.pose, moved, turned));
}

TracePose PoseSieve::clipped(const TracePose& pose, bool moved, bool turned) {
  TracePose now = {pose.t_s, pose.position + moved_by_, layers::unit(turned_by_ * pose.rotation)};
  if ((moved || turned) && !shown_.empty()) {
    TracePose next = shown_.back();
    if (shown_.size() == 2) {
      const double times = std::min((pose.t_s - shown_[1].t_s) / (shown_[1].t_s - shown_[0].t_s), 3.0);
      next.position += times * (shown_[1].position - shown_[0].position);
      next.rotation = further(shown_[1].rotation * glm::conjugate(shown_[0].rotation), times) * next.rotation;
    }
    if (moved) moved_by_ += next.position - now.position, now.position = next.position;
    if (turned) {
      turned_by_ = layers::unit(next.rotation * glm::conjugate(now.rotation) * turned_by_);
      now.rotation = layers::unit(next.rotation);
    }
  }
  if (!shown_.empty() && glm::dot(shown_.back().rotation, now.rotation) < 0) now.rotation = -now.rotation;
  if (shown_.size() == 2) shown_.erase(shown_.begin());
  shown_.push_back(now);
  return now;
}

void PoseSieve::finish() {
  if (findings_.poses < 2)
    throw InputError(
        findings_.poses == 0 ? "has no pose, rule: at least two" : "has one pose, rule: at least two",
        options_.file);
  while (wanted_ && released_ < held_.size()) wanted_ = release(released_++);
}

}  // namespace talisman::sequences
