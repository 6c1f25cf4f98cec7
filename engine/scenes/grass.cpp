#include "engine/scenes/scene.hpp"
namespace yuragi {
extern const SceneDescription kGrassScene;
const SceneDescription kGrassScene{"grass", "", {}, nullptr};
}  // namespace yuragi
