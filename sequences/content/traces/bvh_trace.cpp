// SPDX-License-Identifier: Apache-2.0
// BVH: a skeleton, and for each frame the values of its channels. The pose is that of one joint in the file's world:
// T(position) · R(first channel) · R(second) · R(third), from the root down; where a joint has channels of position they
// stand in the place of its OFFSET.
#include <algorithm>
#include <charconv>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "sequences/content/nearest_word.h"
#include "sequences/content/traces/trace_readers.h"
#include "sequences/files/quoted.h"

namespace talisman::sequences {

namespace {

constexpr std::size_t kMostJoints = 4096;

/// x, y, z of the position, then of the rotation.
using Channel = int;
constexpr const char* kChannels[] = {"Xposition", "Yposition", "Zposition",
                                     "Xrotation", "Yrotation", "Zrotation"};

struct Joint {
  std::string name;
  int parent = -1;
  layers::dvec3 offset{0};
  std::size_t first_channel = 0;  ///< in a frame
  std::vector<Channel> channels;
};

class BvhReader {
 public:
  explicit BvhReader(TraceText& text) : text_(text) {}

  void read_skeleton() {
    expect("HIERARCHY");
    expect("ROOT");
    std::vector<int> open = {add_joint(-1)};
    while (!open.empty()) {
      const std::string word = next("OFFSET, CHANNELS, JOINT, End Site or }");
      if (word == "OFFSET")
        read_offset(joints_[static_cast<std::size_t>(open.back())]);
      else if (word == "CHANNELS")
        read_channels(joints_[static_cast<std::size_t>(open.back())]);
      else if (word == "JOINT")
        open.push_back(add_joint(open.back()));
      else if (word == "End")
        skip_end();
      else if (word == "}")
        open.pop_back();
      else
        text_.fail("has " + word_in_message(word) + ", rule: OFFSET, CHANNELS, JOINT, End Site or }");
    }
  }

  void read_head_of_motion() {
    if (next("MOTION") == "ROOT") text_.fail("has a second ROOT, rule: one skeleton");
    if (word_ != "MOTION") text_.fail("has " + word_in_message(word_) + ", rule: MOTION");
    expect("Frames:");
    const double frames = number();
    if (!(frames >= 0) || frames != std::floor(frames))
      text_.fail("has Frames: " + word_ + ", rule: how many there are");
    frames_ = static_cast<std::int64_t>(frames);
    expect("Frame");
    expect("Time:");
    period_s_ = number();
  }

  /// Returns what is to be said of them, or nothing.
  std::string read_frames(const std::vector<int>& chain, std::optional<double> fps, const PoseSink& sink) {
    if (!fps && !(period_s_ > 0))
      text_.fail("has Frame Time: " + word_ + ", rule: seconds above 0, or the key fps");
    std::vector<double> values(channel_count_);
    for (std::int64_t frame = 0; frame < frames_; ++frame) {
      for (double& value : values) {
        std::string_view word;
        if (!text_.next_word(word))
          text_.fail("ends in frame " + std::to_string(frame) + " of " + std::to_string(frames_) +
                     ", rule: as many as Frames: says");
        value = number_of(word);
      }
      RawPose pose = pose_of(chain, values);
      const auto count = static_cast<double>(frame);
      pose.stamp = {0, fps ? count / *fps : count * period_s_};
      pose.line = text_.line();
      if (!sink(pose)) return {};
    }
    return read_past_rest();
  }

  /// There are files that have whole frames more than they say.
  std::string read_past_rest() {
    std::string_view word;
    std::size_t numbers = 0;
    std::string first;
    bool are_numbers = true;
    while (are_numbers && text_.next_word(word)) {
      if (numbers++ == 0) first = std::string(word);
      are_numbers = trace_number(word).has_value();
    }
    if (numbers == 0) return {};
    if (!are_numbers || channel_count_ == 0 || numbers % channel_count_ != 0)
      text_.fail("goes on with " + word_in_message(first) + " after frame " + std::to_string(frames_ - 1) +
                 ", rule: as many frames as Frames: says");
    return "holds " + std::to_string(numbers / channel_count_) + " frames more than the " +
           std::to_string(frames_) + " that it says, which are left out";
  }

  /// From the root to the joint of this name.
  std::vector<int> chain_to(const std::string& name) const {
    std::vector<std::string> names;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      names.push_back(joints_[j].name);
      if (joints_[j].name != name) continue;
      std::vector<int> chain;
      for (int at = static_cast<int>(j); at >= 0; at = joints_[static_cast<std::size_t>(at)].parent)
        chain.push_back(at);
      std::reverse(chain.begin(), chain.end());
      return chain;
    }
    const std::string nearest = did_you_mean(name, names);
    throw InputError("has no joint '" + name + "'" +
                         (nearest.empty() ? ", rule: one of " + quoted(names, 40)
                                          : nearest + ", rule: a joint of the file"),
                     text_.file());
  }

 private:
  std::string next(const char* rule) {
    std::string_view word;
    if (!text_.next_word(word)) text_.fail(std::string("ends too early, rule: ") + rule);
    return word_ = std::string(word);
  }
  void expect(const char* what) {
    if (next(what) != what) text_.fail("has " + word_in_message(word_) + ", rule: " + what);
  }
  double number_of(std::string_view word) const {
    const std::optional<double> number = trace_number(word);
    if (!number) text_.fail("has " + word_in_message(word) + ", rule: a number from -1e9 to 1e9");
    return *number;
  }
  double number() { return number_of(next("a number")); }

  int add_joint(int parent) {
    if (joints_.size() == kMostJoints) text_.fail("has more than 4096 joints, rule: at most as many");
    Joint joint;
    joint.name = next("the name of a joint");
    joint.parent = parent;
    joints_.push_back(std::move(joint));
    expect("{");
    return static_cast<int>(joints_.size()) - 1;
  }
  void read_offset(Joint& joint) {
    for (int axis = 0; axis < 3; ++axis) joint.offset[axis] = number();
  }
  void read_channels(Joint& joint) {
    const double count = number();
    if (!joint.channels.empty() || !(count >= 0 && count <= 6) || count != std::floor(count))
      text_.fail("has CHANNELS " + word_ + " of joint '" + joint.name + "', rule: once, from 0 to 6");
    joint.first_channel = channel_count_;
    for (int i = 0; i < static_cast<int>(count); ++i) {
      const std::string word = next("a channel");
      const auto found = std::find(std::begin(kChannels), std::end(kChannels), word);
      if (found == std::end(kChannels))
        text_.fail("has channel " + word_in_message(word) + ", rule: Xposition … Zrotation");
      joint.channels.push_back(static_cast<Channel>(found - std::begin(kChannels)));
    }
    channel_count_ += joint.channels.size();
  }
  void skip_end() {
    expect("Site");
    expect("{");
    expect("OFFSET");
    for (int axis = 0; axis < 3; ++axis) number();
    expect("}");
  }

  RawPose pose_of(const std::vector<int>& chain, const std::vector<double>& values) const {
    RawPose pose;
    for (const int index : chain) {
      const Joint& joint = joints_[static_cast<std::size_t>(index)];
      layers::dvec3 place = joint.offset;
      glm::dquat turn(1, 0, 0, 0);
      for (std::size_t i = 0; i < joint.channels.size(); ++i) {
        const double value = values[joint.first_channel + i];
        const Channel channel = joint.channels[i];
        if (channel < 3) {
          place[channel] = value;
          continue;
        }
        layers::dvec3 axis{0};
        axis[channel - 3] = 1;
        turn = turn * glm::angleAxis(glm::radians(value), axis);
      }
      pose.position += pose.rotation * place;
      pose.rotation = glm::normalize(pose.rotation * turn);
    }
    return pose;
  }

  TraceText& text_;
  std::string word_;
  std::vector<Joint> joints_;
  std::size_t channel_count_ = 0;
  std::int64_t frames_ = 0;
  double period_s_ = 0;
};

}  // namespace

std::string read_bvh(TraceText& text, const std::string& joint, std::optional<double> fps,
                     const PoseSink& sink) {
  BvhReader reader(text);
  reader.read_skeleton();
  const std::vector<int> chain = reader.chain_to(joint);
  reader.read_head_of_motion();
  return reader.read_frames(chain, fps, sink);
}

}  // namespace talisman::sequences
