// What the rasterizer's kernels hand to each other within one batch of triangles, and the counters they keep.
#ifndef SHADERS_RASTER_STATE_GLSL
#define SHADERS_RASTER_STATE_GLSL

// Triangles that are not drawn directly are put into the lists of square cells of pixels. Level k has cells of
// 16 << 2k pixels; a triangle goes to the finest level at which it needs at most `maxCells` cells, chosen so that
// all entries fit the list whatever comes: maxCells x records <= capacity. A tile reads the lists of the cell
// of every level that contains it.
const int TILE_SIZE = 16;
const int LEVELS = 6;  // the last has one cell of 16384 pixels: the largest image

// Slots that a tile's own list has, in images of at most SLOT_TILES tiles; and most of a cell.
const uint TILE_SLOTS = 128u, MOST_SLOTS = 2048u;
const int SLOT_TILES = 32768;

// A tile's lists are read in segments, each by its own workgroup, so that no loop comes near the 65,535
// iterations after which some drivers stop loops silently.
const uint SEGMENT = 16384u;

struct RasterState {
    uint largeCount;    // triangles listed by set-up for the tiles
    uint clippedCount;  // triangles listed for clipping
    uint maxCells;
    uint recordCount;   // largeCount + CLIP_PARTS clippedCount
    uint largeGroups[3];  // workgroups of the indirect dispatches
    uint clipGroups[3];
    uint fillGroups[3];  // none where every list fits its slots
    uint tileGroups[3];  // for the first segment of every tile with entries
    uint moreGroups[3];  // for the others, most often none
    uint tileCount;      // tiles with entries, each x | y << 16
    uint freshGroups[3];  // in place of tileGroups where nothing has been drawn before
    uint smallPixels;     // that triangles drawn directly cover
};
const int STATE_TILE_COUNT = 19;  // its place among the words
const uint TILE_ROW = 32768u;     // workgroups of tiles in x: some devices have no more than 65,535

// Clipping a triangle by five planes leaves at most eight corners: a fan of at most six triangles.
const uint CLIP_PARTS = 6u;

int cellShift(int level) { return 4 + 2 * level; }

// Indices of the 64-bit counters.
const int COUNT_TRIANGLES = 0;      // read by set-up
const int COUNT_OUTSIDE = 1;        // wholly outside the view
const int COUNT_BACK = 2;           // back faces left out on request
const int COUNT_EMPTY = 3;          // no area, or no pixel centre in the bounding box
const int COUNT_SMALL = 4;          // drawn directly
const int COUNT_LARGE = 5;          // sent to the tiles
const int COUNT_CLIPPED = 6;        // sent to clipping
const int COUNT_SMALL_VISITED = 7;  // pixels tested by direct drawing
const int COUNT_SMALL_COVERED = 8;  // of these, covered
const int COUNT_PARTS = 9;          // triangles that clipping made
const int COUNT_ENTRIES = 10;       // entries of the cells' lists
const int COUNT_TILE_VISITED = 11;  // triangles times tiles tested by the tile kernel
const int COUNT_HIDDEN = 12;        // triangles of clusters that what is drawn hides
const int COUNT_CLUSTERS = 13;      // looked at, where clusters are culled
const int COUNT_CLUSTERS_OUTSIDE = 14;
const int COUNT_CLUSTERS_HIDDEN = 15;
const int COUNTERS = 16;

#endif
