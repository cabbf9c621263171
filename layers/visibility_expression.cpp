// SPDX-License-Identifier: Apache-2.0
#include "layers/visibility_expression.h"

#include <algorithm>
#include <set>
#include <utility>

namespace talisman::layers {

namespace {

using Operator = CompositeExpression::Operator;

class Builder {
 public:
  explicit Builder(const MergedComponent& component) {
    for (const ExplicitPair& p : component.relations) front_of_.insert({p.behind, p.front});
  }

  bool in_front(int front, int behind) const { return front_of_.contains({behind, front}); }
  bool binary(const std::vector<int>& layers) const {
    return std::any_of(front_of_.begin(), front_of_.end(), [&](const std::pair<int, int>& p) {
      const auto in = [&](int id) { return std::find(layers.begin(), layers.end(), id) != layers.end(); };
      return in(p.first) && in(p.second) && front_of_.contains({p.second, p.first});
    });
  }

  int out(const std::vector<int>& layers) {
    int sum = -1;
    for (const int layer : layers) {
      int term = leaf(layer);
      for (const int other : layers)
        if (other != layer && in_front(other, layer)) term = node(Operator::Out, term, leaf(other));
      sum = sum < 0 ? term : node(Operator::Plus, sum, term);
    }
    return sum;
  }

  int atop(const std::vector<int>& layers) {
    const std::vector<int> line = nearly_sorted(layers);
    int picture = -1;
    for (std::size_t i = 0; i < line.size() && !too_large(); ++i) {
      std::vector<int> drawn_before;
      for (std::size_t k = 0; k < i; ++k)
        if (in_front(line[k], line[i])) drawn_before.push_back(line[k]);
      const int covered = cover(leaf(line[i]), drawn_before);
      picture = picture < 0 ? covered : node(Operator::Over, covered, picture);
    }
    return picture;
  }

  bool too_large() const { return nodes_.size() > kLargestExpression; }
  std::vector<CompositeExpression::Node> take() { return std::move(nodes_); }

 private:
  int leaf(int layer) {
    nodes_.push_back({Operator::Layer, layer, -1, -1});
    return static_cast<int>(nodes_.size()) - 1;
  }
  int node(Operator op, int left, int right) {
    nodes_.push_back({op, -1, left, right});
    return static_cast<int>(nodes_.size()) - 1;
  }

  /// Draws `above` (in the order of the line) within the layer of node `below`.
  int cover(int below, const std::vector<int>& above) {
    bool sorted = true;
    for (std::size_t k = 0; k < above.size(); ++k)
      for (std::size_t j = k + 1; j < above.size(); ++j) sorted = sorted && !in_front(above[k], above[j]);
    if (!sorted) return node(Operator::Atop, atop(above), below);
    for (const int layer : above) below = node(Operator::Atop, leaf(layer), below);
    return below;
  }

  /// Back to front with few relations broken: next comes the layer that has the fewest left behind it.
  std::vector<int> nearly_sorted(std::vector<int> left) const {
    std::vector<int> line;
    while (!left.empty()) {
      const auto behind = [&](int layer) {
        return std::count_if(left.begin(), left.end(), [&](int other) { return in_front(layer, other); });
      };
      const auto next =
          std::min_element(left.begin(), left.end(), [&](int a, int b) { return behind(a) < behind(b); });
      line.push_back(*next);
      left.erase(next);
    }
    return line;
  }

  std::set<std::pair<int, int>> front_of_;  ///< behind, front
  std::vector<CompositeExpression::Node> nodes_;
};

/// Sethi & Ullman's numbers: a sprite is read where it is needed, two pictures need a register each.
int count_registers(const std::vector<CompositeExpression::Node>& nodes) {
  std::vector<int> need(nodes.size(), 0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].op == Operator::Layer) continue;
    const int left = need[nodes[i].left], right = need[nodes[i].right];
    need[i] = left == right ? left + 1 : std::max(left, right);
  }
  return nodes.empty() ? 0 : std::max(1, need.back());
}

/// `name` gives the text of a layer id.
template <typename Name>
std::string write(const std::vector<CompositeExpression::Node>& nodes, int i, bool outermost,
                  const Name& name) {
  const auto& n = nodes[i];
  if (n.op == Operator::Layer) return name(n.layer);
  const char* op = n.op == Operator::Over   ? " over "
                   : n.op == Operator::Atop ? " atop "
                   : n.op == Operator::Out  ? " out "
                                            : " plus ";
  const std::string text = write(nodes, n.left, false, name) + op + write(nodes, n.right, false, name);
  return outermost ? text : "(" + text + ")";
}

template <typename Name>
std::string write(const CompositeExpression& expression, const Name& name) {
  if (expression.nodes.empty()) return "";
  return write(expression.nodes, static_cast<int>(expression.nodes.size()) - 1, true, name);
}

}  // namespace

CompositeExpression occlusion_expression(const MergedComponent& component, ExpressionForm form) {
  CompositeExpression expression;
  Builder builder(component);
  if (builder.binary(component.layers)) {
    expression.status = CompositeExpression::Status::BinaryCycle;
    return expression;
  }
  form == ExpressionForm::Out ? builder.out(component.layers) : builder.atop(component.layers);
  if (builder.too_large()) {
    expression.status = CompositeExpression::Status::TooLarge;
    return expression;
  }
  expression.nodes = builder.take();
  expression.registers = count_registers(expression.nodes);
  for (const auto& node : expression.nodes) expression.reads += node.op == Operator::Layer;
  return expression;
}

std::string to_string(const CompositeExpression& expression) {
  return write(expression, [](int layer) { return std::to_string(layer); });
}

std::string to_string(const CompositeExpression& expression, std::span<const Layer> layers) {
  return write(expression, [&](int layer) { return layers[layer].name; });
}

}  // namespace talisman::layers
