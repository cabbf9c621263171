// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/culling/cell_keys.h"

#include "sequences/content/nearest_word.h"
#include "sequences/files/errors.h"

namespace talisman::sequences {

namespace {

int cell_named(const layers::CellSet& set, const std::string& name, const PortalRecipe& portal) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < set.cells.size(); ++i) {
    if (set.cells[i].name == name) return static_cast<int>(i);
    names.push_back(set.cells[i].name);
  }
  throw InputError("portals: '" + name + "' is no cell, rule: the name of one" + did_you_mean(name, names),
                   portal.file, portal.line);
}

void read_corners(const YamlValue& value, PortalRecipe& portal) {
  for (const YamlValue& corner : value.items(3)) portal.corners.push_back(corner.vector());
}

/// Which of them is it? The set up to each is looked at anew.
template <typename Recipe>
void throw_if_defect(const layers::CellSet& so_far, const Recipe& last) {
  if (const std::string defect = first_defect(so_far); !defect.empty())
    throw InputError(defect, last.file, last.line);
}
void add_one_by_one(const std::vector<CellRecipe>& cells, layers::CellSet& so_far) {
  for (const CellRecipe& recipe : cells) {
    so_far.cells.push_back(recipe.cell);
    throw_if_defect(so_far, recipe);
  }
}

template <typename Recipe>
void note_place(Recipe& recipe, const YamlValue& self) {
  recipe.file = self.file();
  recipe.line = self.line();
}

}  // namespace

const Table<CellRecipe>& cell_keys() {
  using C = CellRecipe;
  static const Table<C> table =
      Table<C>("cell")
          .key("name", at(&C::cell, &layers::Cell::name), text(), "", "shown, and named by portals")
          .required()
          .key("lo", at(&C::cell, &layers::Cell::lo), vector(), "m", "the corner with the least coordinates")
          .required()
          .key("hi", at(&C::cell, &layers::Cell::hi), vector(), "m", "the corner with the greatest")
          .required()
          .placed(note_place<C>);
  return table;
}

const Table<PortalRecipe>& portal_keys() {
  using P = PortalRecipe;
  static const Table<P> table =
      Table<P>("portal")
          .key("from", &P::from, text(), "", "a cell")
          .required()
          .key("to", &P::to, text(), "", "another, which touches it")
          .required()
          .custom("corners", list_type(vector().type, 3), read_corners, "m",
                  "of the hole, in their order around it: flat, convex, in the faces of both cells")
          .required()
          .placed(note_place<P>);
  return table;
}

void add_cells(const std::vector<CellRecipe>& cells, const std::vector<PortalRecipe>& portals,
               layers::CellSet& set) {
  layers::CellSet so_far = set;
  for (const CellRecipe& recipe : cells) set.cells.push_back(recipe.cell);
  if (!first_defect(set).empty()) add_one_by_one(cells, so_far);
  so_far = set;
  for (const PortalRecipe& recipe : portals)
    set.portals.push_back(
        {{cell_named(set, recipe.from, recipe), cell_named(set, recipe.to, recipe)}, recipe.corners});
  if (first_defect(set).empty()) return;
  for (std::size_t i = 0; i < portals.size(); ++i) {
    so_far.portals.push_back(set.portals[so_far.portals.size()]);
    throw_if_defect(so_far, portals[i]);
  }
}

}  // namespace talisman::sequences
