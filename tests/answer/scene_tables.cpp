#include "tests/answer/scene_table.hpp"

namespace yuragi::answer {

const std::vector<SceneTable>& scene_tables() {
  static const std::vector<SceneTable> kTables = {
      flag_table(),  curtain_table(),     banner_table(),     tree_table(), zelkova_table(), poplar_table(),
      grass_table(), short_grass_table(), tall_grass_table(), fur_table(),  flame_table(),   ripple_table()};
  return kTables;
}

}  // namespace yuragi::answer
