#pragma once
/** @file Importers of files that hold a mesh and little else: OBJ with MTL, PLY, STL. */
#include "engine/image/read_file.hpp"
#include "engine/scene/load_monitor.hpp"

#include <heliograph/scene.hpp>

#include <string>

namespace helio {

/**
 * Load a file of one kind, given as its bytes and the name for messages, in whose folder further files are
 * looked for. The scene has one mesh on one node, placed as it is in the file: +Y up, metres. Throw
 * InputError with the line, element or byte. Memory at the peak is at most three times that of the geometry
 * in the scene or in the file, whichever is more.
 *
 * OBJ: polygons (cut by ear clipping), texture coordinates (v up in the file, down in the scene), normals,
 * colours after positions (sRGB), materials; a primitive per material in the order of use. Groups, objects
 * and smoothing groups do not part it. A missing MTL file or material is a warning, and white is shown.
 */
Scene loadObj(const ByteSource& source, const std::string& file, LoadMonitor& monitor);

/** PLY, as text or binary of either byte order: vertices with positions, normals, texture coordinates (v up),
 * colours and alpha (sRGB) under their usual names; faces as lists of any length, triangle strips. A comment
 * "TextureFile NAME" is the base colour. The surface is Lambert; points alone are left out. */
Scene loadPly(const ByteSource& source, const std::string& file, LoadMonitor& monitor);

/** STL, as text or binary; a binary one may begin with "solid" too. Facets are flat, their normals are those
 * of their corners, and the surface is Lambert of albedo 0.8. */
Scene loadStl(const ByteSource& source, const std::string& file, LoadMonitor& monitor);

}  // namespace helio
