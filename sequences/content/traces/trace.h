// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How did somebody's head, camera or body really move? Recorded poses as the motion of a node.
///
///   format   a line or entry                       poses                                 source
///   tum      t tx ty tz qx qy qz qw                body→world, seconds                   [TUM] "Ground-truth trajectories"
///   euroc    t,px,py,pz,qw,qx,qy,qz,…              body→world, whole nanoseconds         [EuRoC] state_groundtruth_estimate0
///   colmap   id qw qx qy qz tx ty tz camera name   world→camera, no time: number in the
///            and a line of points that is skipped  name, or order of the names, by fps    [COLMAP] images.txt
///   iwer     [t, px,py,pz, qx,qy,qz,qw, inputs…]   body→world, milliseconds              npm iwer, ActionRecorder
///   bvh      HIERARCHY and MOTION                  of one joint, in the file's world,
///                                                  angles in the order of its channels    [BVH] Biovision, as Blender reads it
///
/// What the pose is in, here: world_from_body = U · P · B, where P is the pose of the file as body→world (inverted where
/// the file says world→body), positions times `scale`,
///   U   turns the file's upward axis to +y: y as it is; z: (x, y, z) → (x, z, −y); -y: (x, y, z) → (x, −y, −z)
///   B   gl: as it is (x right, y up, looks along −z); opencv: diag(1, −1, −1), an optical frame (y down, z forward)
/// Time 0 of the sequence is `start_s` after the first pose. Before and after the poses the nearest one holds.
///
/// What is wrong is refused with file and line: what is no number, a quaternion whose norm is off by more than 1 %, a
/// stamp that is not after the one before, less than two poses. Quaternions that change sign are the same rotation and
/// are repaired silently. What may be meant is said: a gap of more than three periods (the median of the steps in time),
/// which is interpolated; a jump, a single step more than ten times as fast as the two before and the two after it
/// (their median) and of more than 5° or 5 cm; a sequence that outlasts its trace.
///
/// Memory: the poses between the sequence's begin and end, at most `kMostPoses`; the rest is read past.
///
/// [TUM]    Sturm et al., A Benchmark for the Evaluation of RGB-D SLAM Systems, IROS 2012; its page "File formats"
/// [EuRoC]  Burri et al., The EuRoC micro aerial vehicle datasets, IJRR 2016
/// [COLMAP] colmap.github.io/format.html
/// [BVH]    Meredith & Maddock, Motion Capture File Formats Explained, Sheffield 2001

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "layers/scene.h"
#include "sequences/content/traces/trace_findings.h"

namespace talisman::sequences {

inline constexpr std::size_t kMostPoses = 500'000;   ///< 88 MB with slopes; eight minutes at 1 kHz
inline constexpr std::size_t kMostImages = 250'000;  ///< of COLMAP: they are sorted by name

enum class TraceFormat { Tum, Euroc, Colmap, Iwer, Bvh };
enum class BodyFrame { Gl, OpenCv };
enum class UpwardAxis { Y, Z, MinusY };
enum class Resampling {
  Slerp,  ///< positions linear, rotations along the shorter arc: nothing overshoots, speeds have steps
  Cubic,  ///< Hermite with the slopes of the parabola through three poses: speeds are continuous
};
enum class Jumps {
  Keep,
  Clip,  ///< the step goes on as the one before it, and what follows is moved and turned by as much
};

struct TraceOptions {
  std::string file;                   ///< where it lies
  std::string otherwise;              ///< another one that stands in where that is not there; empty: none
  std::string missing;                ///< what `otherwise` stands in for: why it is not there; empty: it is
  std::optional<TraceFormat> format;  ///< empty: as the file's name says (format_of_name)
  std::string joint = "Head";         ///< of bvh
  std::optional<double> fps;          ///< > 0; of colmap, which has no time, and of bvh, instead of its own
  double start_s = 0;                 ///< ≥ 0, after the first pose
  double scale = 1;                   ///< > 0, metres per unit of the file
  std::optional<BodyFrame> frame;     ///< empty: opencv of tum, euroc and colmap, gl of iwer and bvh
  UpwardAxis up = UpwardAxis::Y;
  Resampling resample = Resampling::Slerp;
  Jumps jumps = Jumps::Keep;
  std::string sequence_file;  ///< and line: where it is written; empty: on the command line
  int line = 0;
};

/// .bvh: bvh; .json: iwer; images.txt: colmap; .csv: euroc; else tum.
TraceFormat format_of_name(const std::string& file);
const char* word_of(TraceFormat format);
/// Of the option --format. Throws InputError.
TraceFormat trace_format_from(const std::string& word);

struct Trace {
  layers::Keys<layers::dvec3> positions;     ///< m, over seconds of the sequence
  layers::Keys<glm::dquat> rotations;        ///< unit, each on the side of the one before it
  TraceFindings findings;                    ///< of all that was read
  std::vector<std::string> warnings, notes;  ///< one line each, with the file's name
};

/// The poses that a sequence from 0 to `last_s` needs: from the last one before 0 to the second one behind the end.
/// Throws InputError.
Trace read_trace(const TraceOptions& options, double last_s);

/// Of the whole file, without keeping its poses: for `inspect --motion`. Throws InputError.
TraceFindings look_through_trace(const TraceOptions& options);

/// The motion of a node.
layers::TransformTrack track_of(Trace trace, Resampling resample);

}  // namespace talisman::sequences
