#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/settings/feeds/feeds.hpp"
#include "daemon/values/moment.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::daemon::settings::feeds {

/// An entry of a list as it is written: its values, and those of the lists below it.
struct Entry {
  std::string name = {};  ///< empty in a list below another
  ParameterValues values{};
  std::map<std::string_view, std::vector<ParameterValues>> below{};
};

/// A list of tables of the configuration, or one below an entry of it ([[osc]], [[osc.map]]). All that reads, writes,
/// describes or compares these lists walks list_tables().
struct ListTable {
  std::string_view name;
  std::string_view summary;
  std::size_t max_entries;
  /// Each entry must have a name. Otherwise it may have one, and a list below another has none.
  bool needs_name;
  std::span<const Parameter> parameters;
  /// Adds the typed entry to `config`; below another list, to its newest entry. `names`: of the installation. Returns
  /// what is wrong with the values, with the keys; then nothing is added.
  std::vector<ParameterError> (*add)(Config& config, const std::string& name, const ParameterValues& values,
                                     const values::Names& names);
  std::span<const ListTable> below = {};
};

/// Places first, since the others refer to them.
std::span<const ListTable> list_tables();

/// The entries of the lists by their names.
using Lists = std::map<std::string_view, std::vector<Entry>>;

}  // namespace yuragi::daemon::settings::feeds
