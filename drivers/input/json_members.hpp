// Structs as JSON objects, by one list of their members that is used for writing, reading and
// checking: a member that is not in the list is in no file, and one that is in it is checked.
//
//   template <class Members>
//   void describe(Members& members, EnsemblePlan& plan) {
//     members("runs", plan.runs, WithinRange{1, 100000});
//   }
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/input/json_file.hpp"
#include "kernel/core/named_list.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/types.hpp"

namespace traceraft::input {

// Allowed values of a member. A list is checked value by value, an object by its own members.
struct WithinRange {
  double low, high;             // both are allowed
  bool may_be_unknown = false;  // NaN, which is null in JSON
};
inline constexpr double kAnyNumber = std::numeric_limits<double>::max();
struct OneOf {
  std::string kind;  // "integrator"
  std::vector<std::string> names;
};
// A list of at least one item, none twice, and each as `item` says.
template <class Check>
struct Distinct {
  Check item;
};
template <class Check>
Distinct(Check) -> Distinct<Check>;
struct AnyText {};
struct AnyFlag {};
struct AsDescribed {};  // an object
// Whatever the type holds; null is infinity, which JSON has not.
struct AnyValue {};

// Throw InputError.
void check_value(const std::string& where, double value, const WithinRange& range);
void check_value(const std::string& where, const std::string& name, const OneOf& list);
inline void check_value(const std::string&, const std::string&, const AnyText&) {}
inline void check_value(const std::string&, bool, const AnyFlag&) {}
template <class T>
void check_value(const std::string&, const T&, const AnyValue&) {}

// The words for the values of an enumeration.
template <class T>
using Words = std::vector<std::pair<T, std::string>>;

class JsonWriter {
 public:
  static constexpr bool reads = false;

  template <class T, class Check = AnyValue>
  void operator()(const char* name, T& member, const Check& = {}) {
    json_[name] = json_of(member);
  }
  template <class T>
  void word(const char* name, T& member, const Words<T>& words) {
    for (const auto& [value, text] : words)
      if (value == member) json_[name] = text;
  }
  // A member that is stored as another type, which has members that a file can hold.
  template <class T, class ToStored, class FromStored>
  void stored(const char* name, T& member, const ToStored& to_stored, const FromStored&) {
    auto copy = to_stored(member);
    json_[name] = json_of(copy);
  }
  // One that earlier versions did not know: it keeps its value where a file lacks it.
  template <class T, class Check>
  void later(const char* name, T& member, const Check& check) {
    (*this)(name, member, check);
  }
  Json take() { return std::move(json_); }

  template <class T>
  static Json json_of(T& value) {
    if constexpr (std::is_same_v<T, double>)
      return std::isfinite(value) ? Json(value) : Json();  // JSON has neither NaN nor infinity
    else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>)
      return value;
    else
      return object_or_list(value);
  }

 private:
  template <class T>
  static Json object_or_list(std::vector<T>& list) {
    Json json = Json::array();
    for (auto&& value : list) json.push_back(json_of(value));
    return json;
  }
  template <class T>
  static Json object_or_list(std::map<std::string, T>& map) {
    Json json = Json::object();
    for (auto& [name, value] : map) json[name] = json_of(value);
    return json;
  }
  template <class T>
  static Json object_or_list(std::map<std::size_t, T>& map) {
    Json json = Json::object();
    for (auto& [number, value] : map) json[std::to_string(number)] = json_of(value);
    return json;
  }
  template <class T>
  static Json object_or_list(std::optional<T>& value) {
    return value ? json_of(*value) : Json();
  }
  template <class T, int Rows>
  static Json object_or_list(Eigen::Matrix<T, Rows, 1>& vector) {
    Json json = Json::array();
    for (T& value : vector) json.push_back(json_of(value));
    return json;
  }
  // Column after column.
  static Json object_or_list(Eigen::MatrixXd& matrix) {
    Vec values = matrix.reshaped();
    return {{"rows", matrix.rows()}, {"values", json_of(values)}};
  }
  template <class T>
  static Json object_or_list(T& value) {
    JsonWriter writer;
    describe(writer, value);
    return writer.take();
  }

  Json json_ = Json::object();
};

class JsonReader {
 public:
  // `where`: the file, and the way to the object in it.
  JsonReader(const Json& json, std::string where) : json_(json), where_(std::move(where)) {
    if (!json.is_object()) throw DamagedFile(where_ + " is damaged: it holds no object");
  }

  static constexpr bool reads = true;

  template <class T, class Check = AnyValue>
  void operator()(const char* name, T& member, const Check& check = {}) {
    read(at(name), where_ + ": " + name, member, check);
  }
  template <class T>
  void word(const char* name, T& member, const Words<T>& words) {
    std::string text;
    (*this)(name, text, AnyText{});
    for (const auto& [value, word] : words)
      if (word == text) {
        member = value;
        return;
      }
    throw DamagedFile(where_ + " is damaged: " + name + " cannot be '" + text + "'");
  }
  template <class T, class ToStored, class FromStored>
  void stored(const char* name, T& member, const ToStored& to_stored,
              const FromStored& from_stored) {
    auto copy = to_stored(member);
    (*this)(name, copy);
    member = from_stored(copy);
  }
  // Refuses members that do not fit each other; `what` is wrong with them.
  void require(bool fits, const char* what) const {
    if (!fits) throw DamagedFile(where_ + " is damaged: " + what);
  }
  template <class T, class Check>
  void later(const char* name, T& member, const Check& check) {
    names_.push_back(name);
    if (json_.contains(name)) (*this)(name, member, check);
  }
  // After all members: refuses what none of them is.
  void refuse_others() const {
    for (const auto& [name, value] : json_.items())
      if (std::find(names_.begin(), names_.end(), name) == names_.end())
        throw DamagedFile(where_ + " is damaged: " + unknown_name_message("member", name, names_));
  }

 private:
  [[noreturn]] static void refuse(const std::string& where, const char* needed) {
    throw DamagedFile(where + " is damaged: it is no " + needed);
  }
  const Json& at(const char* name) {
    names_.push_back(name);
    const auto found = json_.find(name);
    if (found == json_.end()) throw DamagedFile(where_ + " is damaged: there is no " + name);
    return *found;
  }

  template <class T, class Check>
  static void read(const Json& json, const std::string& where, std::vector<T>& list,
                   const Check& check) {
    if (!json.is_array()) refuse(where, "list");
    list.resize(json.size());
    for (std::size_t k = 0; k < list.size(); ++k)
      read(json[k], where + "[" + std::to_string(k) + "]", list[k], check);
  }
  template <class T, class Check>
  static void read(const Json& json, const std::string& where, std::vector<T>& list,
                   const Distinct<Check>& check) {
    read(json, where, list, check.item);
    if (list.empty()) refuse(where, "list of at least one");
    for (std::size_t k = 1; k < list.size(); ++k)
      if (std::find(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(k), list[k]) !=
          list.begin() + static_cast<std::ptrdiff_t>(k))
        throw DamagedFile(where + " is damaged: [" + std::to_string(k) + "] repeats another");
  }
  template <class T, class Check>
  static void read(const Json& json, const std::string& where, std::map<std::string, T>& map,
                   const Check& check) {
    if (!json.is_object()) refuse(where, "object");
    map.clear();
    for (const auto& [name, value] : json.items())
      read(value, where + "." + name, map[name], check);
  }
  template <class T, class Check>
  static void read(const Json& json, const std::string& where, std::map<std::size_t, T>& map,
                   const Check& check) {
    std::map<std::string, T> named;
    read(json, where, named, check);
    map.clear();
    for (auto& [name, value] : named) {
      if (name.empty() || name.size() > 9 ||
          name.find_first_not_of("0123456789") != std::string::npos)
        refuse(where + "." + name, "number");
      map[std::stoul(name)] = std::move(value);
    }
  }
  template <class T, class Check>
  static void read(const Json& json, const std::string& where, std::optional<T>& value,
                   const Check& check) {
    value.reset();
    if (!json.is_null()) read(json, where, value.emplace(), check);
  }
  template <class T, int Rows, class Check>
  static void read(const Json& json, const std::string& where, Eigen::Matrix<T, Rows, 1>& vector,
                   const Check& check) {
    std::vector<T> values;
    read(json, where, values, check);
    const auto size = static_cast<Eigen::Index>(values.size());
    if (Rows != Eigen::Dynamic && size != Rows) refuse(where, "point");
    vector = Eigen::Map<const Eigen::Matrix<T, Rows, 1>>(values.data(), size);
  }
  template <class Check>
  static void read(const Json& json, const std::string& where, Eigen::MatrixXd& matrix,
                   const Check& check) {
    JsonReader reader(json, where);
    Eigen::Index rows = 0;
    Vec values;
    reader("rows", rows);
    reader("values", values, check);
    const bool fits = rows > 0 ? values.size() % rows == 0 : rows == 0 && values.size() == 0;
    reader.require(fits, "it is no matrix");
    matrix = values.reshaped(rows, rows > 0 ? values.size() / rows : 0);
  }
  template <class T, class Check>
  static void read(const Json& json, const std::string& where, T& value, const Check& check) {
    if constexpr (std::is_same_v<Check, AsDescribed> ||
                  (std::is_same_v<Check, AnyValue> && std::is_class_v<T> &&
                   !std::is_same_v<T, std::string>)) {
      JsonReader reader(json, where);
      describe(reader, value);
      reader.refuse_others();
    } else if constexpr (std::is_same_v<T, bool>) {
      if (!json.is_boolean()) refuse(where, "true or false");
      value = json.get<bool>();
    } else if constexpr (std::is_arithmetic_v<T>) {
      read_number(json, where, value, check);
    } else {
      if (!json.is_string()) refuse(where, "text");
      value = json.get<std::string>();
      check_value(where, value, check);
    }
  }
  template <class T>
  static void read_number(const Json& json, const std::string& where, T& value,
                          const WithinRange& range) {
    if (json.is_null() && std::is_floating_point_v<T>) {
      value = std::numeric_limits<T>::has_quiet_NaN ? std::numeric_limits<T>::quiet_NaN() : T();
      check_value(where, static_cast<double>(value), range);
      return;
    }
    if (!json.is_number()) refuse(where, "number");
    // Before it is made smaller, which is not defined for what does not fit.
    const double number = json.get<double>();
    check_value(where, number, range);
    if (std::is_integral_v<T> && number != std::floor(number)) refuse(where, "whole number");
    value = json.get<T>();
  }

  template <class T>
  static void read_number(const Json& json, const std::string& where, T& value, const AnyValue&) {
    if (json.is_null() && std::is_floating_point_v<T>) {
      value = std::numeric_limits<T>::infinity();
      return;
    }
    read_number(json, where, value,
                WithinRange{static_cast<double>(std::numeric_limits<T>::lowest()),
                            static_cast<double>(std::numeric_limits<T>::max())});
  }

  const Json& json_;
  std::string where_;
  std::vector<std::string> names_;  // of the members
};

template <class T>
Json object_of(const T& value) {
  T copy = value;  // one list of members serves both ways, and so takes no constant
  return JsonWriter::json_of(copy);
}

// Throws IoError if the file cannot be read, DamagedFile unless it holds all members, each of its
// kind, and no others, InputError for a value that is out of range and for a name that is unknown.
template <class T>
T read_object(const std::filesystem::path& file, T value = {}) {
  return from_json(file, [&](const Json& json) {
    JsonReader reader(json, file.string());
    describe(reader, value);
    reader.refuse_others();
    return value;
  });
}

}  // namespace traceraft::input
