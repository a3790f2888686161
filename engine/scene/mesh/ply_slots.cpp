#include "engine/scene/mesh/ply_slots.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace helio::mesh {

std::size_t slotOf(const std::string& name) {
    static const std::array<std::vector<const char*>, slotCount> names{{
        {"x"},
        {"y"},
        {"z"},
        {"nx", "normal_x"},
        {"ny", "normal_y"},
        {"nz", "normal_z"},
        {"u", "s", "texture_u", "texture_s", "texcoord_u", "texture_coord_u", "tu"},
        {"v", "t", "texture_v", "texture_t", "texcoord_v", "texture_coord_v", "tv"},
        {"red", "r", "diffuse_red"},
        {"green", "g", "diffuse_green"},
        {"blue", "b", "diffuse_blue"},
        {"alpha", "a", "diffuse_alpha"},
    }};
    for (std::size_t slot = 0; slot < slotCount; ++slot) {
        if (std::find(names[slot].begin(), names[slot].end(), name) != names[slot].end()) return slot;
    }
    return slotCount;
}

double colorScale(PlyType type) {
    if (type == PlyType::Uint8) return 1.0 / 255;
    if (type == PlyType::Uint16) return 1.0 / 65535;
    return type < PlyType::Float32 ? 1.0 / 255 : 1.0;
}

}  // namespace helio::mesh
