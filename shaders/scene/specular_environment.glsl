// Where the tables of passes/environment lie that shading takes glossy reflections of the surroundings from: the split
// sum of Karis, "Real shading in Unreal Engine 4", SIGGRAPH 2013 courses.
#ifndef SHADERS_SCENE_SPECULAR_ENVIRONMENT_GLSL
#define SHADERS_SCENE_SPECULAR_ENVIRONMENT_GLSL

/// Nodes along the square root of the viewer's cosine (columns) and the roughness (rows), both 0 to 1.
const int DIRECTIONAL_ALBEDO_NODES = 32;
/// Behind those: images of the surroundings as lobes of roughness k / 8 see them that leave along their normal, k = 1..8;
/// of latitude and longitude, in the frame of the environment's image.
const int PREFILTERED_LEVELS = 8;
/// The lobes of levels 1 and 2 are narrow.
int prefilteredWidth(int level) { return level == 1 ? 256 : (level == 2 ? 128 : 64); }
int prefilteredFirst(int level) {
    int first = DIRECTIONAL_ALBEDO_NODES * DIRECTIONAL_ALBEDO_NODES;
    return first + (level == 1 ? 0 : (level == 2 ? 32768 : 40960 + (level - 3) * 2048));
}

#endif
