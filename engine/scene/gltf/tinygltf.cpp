/** @file tinygltf's implementation. */
#define TINYGLTF_IMPLEMENTATION
#include "engine/scene/gltf/tinygltf.hpp"
