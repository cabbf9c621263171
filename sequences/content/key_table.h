// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How a map of a sequence file is described: one row per key, from which it is read, documented and checked.
///
///   const Table<CameraRecipe>& camera_keys() {
///     static const auto table =
///         Table<CameraRecipe>("camera")
///             .key("fov_deg", &CameraRecipe::fov_deg, number({1, 170}), "°", "vertical field of view")
///             .key("near_m", &CameraRecipe::near_m, number(kPositive), "m", "nearest distance drawn")
///             .key("far_m", &CameraRecipe::far_m, number(kPositive), "m", "farthest distance drawn")
///             .rule("near_m below far_m", [](const CameraRecipe& c) { return c.near_m < c.far_m; })
///             .include(&CameraRecipe::motion, motion_keys());
///     return table;
///   }
///
///   CameraRecipe camera = camera_keys().read(value);
///
/// The defaults that the document shows are the values of a CameraRecipe that nothing was read into. Where a
/// member is nested or computed, a function from T& to a reference stands for it.

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "sequences/content/map_keys.h"
#include "sequences/content/value_format.h"

namespace talisman::sequences {

template <typename T>
class Table {
 public:
  explicit Table(std::string name = "") { keys_.name = std::move(name); }

  const MapKeys& keys() const { return keys_; }

  T read(const YamlValue& value) const { return read(value.map()); }
  T read(const YamlMap& map) const {
    T into{};
    keys_.read(map, &into);
    return into;
  }

  // --- Rows ---

  /// A key with a member of its own. `member` is a pointer to it or a function from T& to a reference; the
  /// value of the format is converted to its type.
  template <typename Member, typename Value>
  Table& key(const std::string& name, Member member, Format<Value> format, const std::string& unit,
             const std::string& meaning) {
    KeyRow row = described(name, format.type, unit, meaning);
    row.standard = written(std::invoke(member, defaults_), format);
    row.read = [member, read = std::move(format.read)](const YamlValue& value, void* into) {
      auto& place = std::invoke(member, *static_cast<T*>(into));
      place = static_cast<std::remove_reference_t<decltype(place)>>(read(value));
    };
    keys_.rows.push_back(std::move(row));
    return *this;
  }

  /// A key that is read in a way of its own.
  Table& custom(std::string name, ValueType type, std::function<void(const YamlValue&, T&)> read,
                std::string unit, std::string meaning) {
    KeyRow row = described(std::move(name), std::move(type), std::move(unit), std::move(meaning));
    row.read = [read = std::move(read)](const YamlValue& value, void* into) {
      read(value, *static_cast<T*>(into));
    };
    keys_.rows.push_back(std::move(row));
    return *this;
  }

  /// What follows is about the row before it.
  Table& required() {
    last().is_required = true;
    last().standard.clear();
    return *this;
  }
  /// What holds without the key, where no value of it says that.
  Table& otherwise(const std::string& words) {
    last().standard_in_words = words;
    last().standard.clear();
    return *this;
  }
  Table& only_with(const std::string& key) {
    last().only_with = key;
    return *this;
  }
  Table& not_with(const std::vector<std::string>& keys) {
    last().not_with = keys;
    return *this;
  }

  /// The rows of another table, read into `member`. The document refers to it by its name (it must live as long
  /// as this one), and takes the rows of a table without a name as if they were written here.
  template <typename Member, typename Other>
  Table& include(Member member, const Table<Other>& other) {
    const auto at = [member](void* into) -> void* { return &std::invoke(member, *static_cast<T*>(into)); };
    take_over(other.keys(), at);
    return *this;
  }
  Table& include(const Table& other) {
    take_over(other.keys(), [](void* into) { return into; });
    return *this;
  }

  // --- The map as a whole ---

  /// Further keys, while the condition holds.
  Table& when(Condition condition, Table further) {
    keys_.branches.push_back({std::move(condition), std::move(further.keys_)});
    return *this;
  }
  /// What the values are before anything is read, where it is not T{}: stands before the rows, since it says
  /// their defaults too.
  Table& begins(std::function<void(T&)> begin) {
    begin(defaults_);
    keys_.begins.push_back([begin = std::move(begin)](void* into) { begin(*static_cast<T*>(into)); });
    return *this;
  }
  /// Is told where the map is written.
  Table& placed(std::function<void(T&, const YamlValue& self)> place) {
    keys_.places.push_back([place = std::move(place)](void* into, const YamlValue& self) {
      place(*static_cast<T*>(into), self);
    });
    return *this;
  }
  /// Finishes what was read.
  Table& ends(std::function<void(T&)> end) {
    keys_.ends.push_back([end = std::move(end)](void* into) { end(*static_cast<T*>(into)); });
    return *this;
  }
  /// A rule over several keys that no schema can say.
  Table& rule(std::string words, std::function<bool(const T&)> holds) {
    keys_.rules.push_back({std::move(words), [holds = std::move(holds)](const void* read) {
                             return holds(*static_cast<const T*>(read));
                           }});
    return *this;
  }
  Table& exactly_one_of(std::vector<std::string> keys) {
    keys_.groups.push_back({std::move(keys), true});
    return *this;
  }
  /// `why` is said when none is there, before the rule.
  Table& at_least_one_of(std::vector<std::string> keys, std::string why = "") {
    keys_.groups.push_back({std::move(keys), false, std::move(why)});
    return *this;
  }
  /// Where this key is written, another file may say what is required here.
  Table& extends_by(std::string key) {
    keys_.base_key = std::move(key);
    return *this;
  }

 private:
  KeyRow& last() { return keys_.rows.back(); }

  static KeyRow described(std::string name, ValueType type, std::string unit, std::string meaning) {
    KeyRow row;
    row.key = std::move(name);
    row.type = std::move(type);
    row.unit = std::move(unit);
    row.meaning = std::move(meaning);
    return row;
  }

  template <typename Member, typename Value>
  static std::string written(const Member& member, const Format<Value>& format) {
    return format.written ? format.written(static_cast<Value>(member)) : "";
  }
  template <typename Member, typename Value>
  static std::string written(const std::optional<Member>& member, const Format<Value>& format) {
    return member ? written(*member, format) : "";
  }

  void take_over(const MapKeys& other, const std::function<void*(void*)>& at) {
    for (KeyRow row : other.rows) {
      row.read = [at, read = row.read](const YamlValue& value, void* into) { read(value, at(into)); };
      if (!row.from && !other.name.empty()) row.from = &other;
      keys_.rows.push_back(std::move(row));
    }
    for (const auto& begin : other.begins)
      keys_.begins.push_back([at, begin](void* into) { begin(at(into)); });
    for (const auto& end : other.ends) keys_.ends.push_back([at, end](void* into) { end(at(into)); });
    for (const auto& place : other.places)
      keys_.places.push_back([at, place](void* into, const YamlValue& self) { place(at(into), self); });
    for (const KeyRule& rule : other.rules)
      keys_.rules.push_back({rule.words, [at, holds = rule.holds](const void* read) {
                               return holds(at(const_cast<void*>(read)));
                             }});
    keys_.groups.insert(keys_.groups.end(), other.groups.begin(), other.groups.end());
  }

  MapKeys keys_;
  T defaults_{};
};

/// The formats of a map and of a list of maps.
template <typename T>
Format<T> map_of(const Table<T>& table) {
  return {map_type(table.keys()), [&table](const YamlValue& value) { return table.read(value); }};
}

template <typename T>
Format<std::vector<T>> list_of(const Table<T>& table, std::size_t at_least = 1) {
  return {list_type(map_type(table.keys()), at_least), [&table, at_least](const YamlValue& list) {
            std::vector<T> values;
            for (const YamlValue& item : list.items(at_least)) values.push_back(table.read(item));
            return values;
          }};
}

/// A list of things over time: the member `t` of each is above that of the one before it.
template <typename T>
Format<std::vector<T>> keys_over_time(const Table<T>& table, double T::*t) {
  const ValueType type =
      with_rule(list_type(map_type(table.keys()), 1), "each t above that of the key before it");
  return {type, [&table, t](const YamlValue& list) {
            std::vector<T> keys;
            for (const YamlValue& item : list.items()) {
              const YamlMap map = item.map();
              keys.push_back(table.read(map));
              if (keys.size() > 1 && !(keys.back().*t > keys[keys.size() - 2].*t))
                map.find("t")->fail("after the key before it");
            }
            return keys;
          }};
}

/// A member of a member: `at(&Film::settings, &Settings::fps)`.
template <typename T, typename Outer, typename Inner>
auto at(Outer T::*outer, Inner Outer::*inner) {
  return [outer, inner](T& t) -> Inner& { return t.*outer.*inner; };
}

}  // namespace talisman::sequences
