#pragma once
/** @file
 * What the raster pipeline's glossy reflections of the surroundings are taken from, made on the device once
 * for a scene: directional albedos of microfacets, and the environment's image filtered for eight roughnesses
 * (shaders/scene/specular_environment.glsl has the layout).
 */
#include "passes/scene/device_scene.hpp"

#include <heliograph/device.hpp>

namespace helio {

/** Whether shading of the scene reads the tables: some surface is more than diffuse, and there are
 * surroundings. */
bool needsSpecularEnvironment(const DeviceScene& scene);

/** Makes the tables; one texel unless `needed`, the albedos alone where the environment is no image. Blocks
 * until they are made. */
DeviceBuffer makeSpecularEnvironment(Device& device, DeviceScene& scene, bool needed);

}  // namespace helio
