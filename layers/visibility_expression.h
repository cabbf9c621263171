// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a compositor with more operators than `over` would do about occlusion cycles: the profile `extended`,
/// an experiment after Snyder & Lengyel 1998 ("Resolving Non-Binary Cyclic Occlusions").
///
/// Layers that go round (A behind B behind C behind A) have no order for `over`. But where no *two* of them
/// occlude each other, every pixel has one: of the layers that cover it, each pair is related in one
/// direction, and they cannot go round, being at different depths of one ray. An expression of compositing
/// operators can follow the pairs instead of an order, and the layers keep sprites of their own.
///
///   Out    Σ over layers L of   L out F₁ out F₂ …,     F the layers in front of L
///   Atop   D(Lₙ) over … over D(L₂) over D(L₁),         D(L) = X₂ atop X₁ atop L,
///          X the layers drawn before L that are in front of it, from back to front
///          (where these go round again: their own expression, atop L)
///
/// With premultiplied colours, alphas a and b:  A over B = A + (1-a) B,  A atop B = b A + (1-a) B,
/// A out B = (1-b) A,  A plus B = A + B.
///
/// `Out` is right for translucent layers too, and for partly covered pixels as far as `over` is. `Atop` takes
/// fewer reads but shows what lies under L only once if L is opaque: it is right where all are opaque.
///
/// What it needs from hardware: the operators atop or out and plus beside over; image registers of the size
/// of the picture (or of a band) that can be the operand of an operator: two for `Out` and for `Atop` as long
/// as no cycle is nested in another, else as many as `registers` says; and one more read of a sprite for each
/// pair (`reads`). Talisman's compositor has one band buffer and `over`: it cannot evaluate any of this, and
/// merges (layers/visibility.h).
///
/// Where it does not apply: two layers that occlude each other (a binary cycle) have no pixel-wise order
/// either, and are merged in both profiles. An author's pair that contradicts the depth of a pixel can make
/// three layers go round in one pixel; `Out` then shows none of them.

#include <span>
#include <string>
#include <vector>

#include "layers/visibility.h"

namespace talisman::layers {

struct CompositeExpression {
  enum class Status {
    Resolved,
    BinaryCycle,  ///< two layers occlude each other; no expression
    TooLarge      ///< more than kLargestExpression nodes (Atop with cycles nested in cycles); use Out
  };
  enum class Operator { Layer, Over, Atop, Out, Plus };
  struct Node {
    Operator op = Operator::Layer;
    int layer = -1;             ///< of Layer
    int left = -1, right = -1;  ///< earlier nodes: left op right
  };
  Status status = Status::Resolved;
  std::vector<Node> nodes;  ///< operands before their operators; the last is the picture
  int registers = 0;        ///< images that have to be kept at once
  int reads = 0;            ///< of sprites
};

enum class ExpressionForm { Out, Atop };
inline constexpr int kLargestExpression = 20000;

/// The expression of `component` (with its relations, as VisibilitySorter reports them; without a cycle it is
/// a chain of over's). Relations to other layers are ignored. Cost: Out: O(layers + relations) nodes; Atop:
/// the same, and as many again for each cycle nested in a cycle.
CompositeExpression occlusion_expression(const MergedComponent& component,
                                         ExpressionForm form = ExpressionForm::Out);

/// "((2 atop 0) over 1) over 2", with the layers' ids.
std::string to_string(const CompositeExpression& expression);
/// The same with the names of `layers`, which are by id.
std::string to_string(const CompositeExpression& expression, std::span<const Layer> layers);

}  // namespace talisman::layers
