// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Scenes drawn by lot, as sequence files of the tool's own format: for properties that must hold whatever is
/// shown. The same seed gives the same text on every machine.
///
/// 96 × 72 pixels, 12 frames at 24 a second. A floor (plain, mirroring, shining or with two textures that are
/// blended over time) and two to five bodies, some of which hold a second part that moves against the first,
/// are half transparent, glow, touch each other or go round so that they are merged; up to four lights of all
/// kinds, some of which fly and some of which cast shadows; shade layers of every kind, at full and at half
/// resolution; fades; open shutters; layers of every group; a camera that stands or flies. Whatever moves
/// rests for part of the time, so that there is something to reuse. Nothing asks for a maximum update rate.
///
/// Skins come with no sequence file without a model: random_sequence adds the bar of skinned_bar_scene to every
/// third scene, as a layer of its own, after the file is read.

#include <cstdint>
#include <string>

#include "sequences/content/sequence.h"

namespace talisman::tests {

/// The sequence file; it refers to checker.ppm beside it.
std::string random_sequence_text(std::uint32_t seed);

/// Writes `folder`/random_SEED.yaml, and the picture; returns the file's path.
std::string write_random_sequence(std::uint32_t seed, const std::string& folder);

/// The picture that they refer to, 4 × 4 texels.
void write_checker(const std::string& folder);

/// That file as the tool reads it, and the bar where the seed can be divided by three.
sequences::Sequence random_sequence(std::uint32_t seed, const std::string& folder);

/// A standing part "bar" with the skin of skinned_bar_scene: bends all the time.
void add_skinned_bar(layers::Scene& scene, layers::dvec3 place);

}  // namespace talisman::tests
