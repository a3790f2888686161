#pragma once
/**
 * @file
 * tinygltf's typed model, for this library alone: its implementation is built in (tinygltf.cpp) and hidden.
 * Other libraries in a process bring versions of their own (libdraco exports one), whose classes differ under
 * the same names. What holds its types is hidden too. Files and images are read here, not by it.
 */
// These stay visible: included below they would be hidden with it.
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iomanip>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#pragma GCC visibility push(hidden)
#include <tiny_gltf.h>
#pragma GCC visibility pop
