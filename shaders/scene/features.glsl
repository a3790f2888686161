#ifndef HELIOGRAPH_SCENE_FEATURES
#define HELIOGRAPH_SCENE_FEATURES
/** @file
 * What the scene has, as specialization constants (DeviceScene::constants): code behind a constant that is
 * false is not compiled. Identifiers 100 to 119 and 130 to 139 (surface_material.glsl) are kept for the scene.
 */
layout(constant_id = 100) const bool HAS_NORMALS = true;            ///< some vertex normals
layout(constant_id = 101) const bool HAS_COLORS = true;             ///< some vertex colours
layout(constant_id = 102) const bool HAS_BASE_TEXTURES = true;      ///< some base colour is textured
layout(constant_id = 103) const bool HAS_EMISSION = true;           ///< some surface emits
layout(constant_id = 104) const bool HAS_EMISSION_TEXTURES = true;  ///< some emission is textured
layout(constant_id = 105) const bool HAS_FLOAT_TEXTURES = true;     ///< some texture is stored in floats
layout(constant_id = 106) const bool HAS_AREA_LIGHTS = true;        ///< some surface is in the light table
layout(constant_id = 107) const bool HAS_PUNCTUAL_LIGHTS = true;    ///< point, spot or directional lights
layout(constant_id = 108) const bool HAS_ENVIRONMENT = true;        ///< rays that miss bring light
layout(constant_id = 109) const int LIGHT_COUNT = 0;                ///< rows of the light table
layout(constant_id = 117) const int LIGHT_BITS = 1;                 ///< of the table's alias slots
layout(constant_id = 110) const int TRIANGLE_COUNT = 0;
layout(constant_id = 111) const bool HAS_TRIANGLE_LIGHTS = true;    ///< else all area lights are parallelograms
layout(constant_id = 118) const bool HAS_LINEAR_TEXTURES = false;   ///< some 8-bit texture holds data
#endif
