#pragma once
/** @file The price list: what a scene's features cost where they are used. */

namespace helio::test {

/** Prints a Markdown table: the plain room, then with each feature of scene_features.hpp: instructions of the
 * path tracer's specialised kernel, bytes of the scene on the device, set-up (compiling with a warm or cold
 * cache, as the machine's is) and CPU time of a sample over the plain room's. A scene without the feature has
 * the plain room's kernel, to the word. Returns an exit code. */
int printFeaturePrices();

/** The same of the raster pipeline, with its settings: instructions of the kernel that shades, most memory in
 * use on the device, number of passes, and CPU time of a frame of 256 x 256 over the plain room's. */
int printRasterPrices();

}  // namespace helio::test
