// Clusters of triangles that lie beside each other in memory, and the pyramid of depths that tells which of them nothing
// can be seen of. Both phases of an image share one list: clusters that showed before from its front, others from its
// end (phase 0); then, in a second half, those of the others that may show after all (phase 1).
#ifndef SHADERS_RASTER_CLUSTER_GLSL
#define SHADERS_RASTER_CLUSTER_GLSL

const uint CLUSTER_TRIANGLES = 64u;

struct ClusterState {
    uint count[2];       // clusters that each phase draws
    uint seen;           // of these in phase 0, those at the front of the list
    uint unseen;         // clusters at its end
    uint candidates;     // of these, tested against depth: all or none
    uint clusters;       // all there are
    uint depthGroups[3]; // workgroups of the indirect dispatches
    uint pyramidGroups[3];
    uint testGroups[3];
    uint unused;
};
// Its words, then of every batch of phase 0 workgroups of set-up and of what follows, three each; then of phase 1.
const int CLUSTER_COUNT = 0, CLUSTER_SEEN = 2, CLUSTER_ALL = 5, CLUSTER_STATE_WORDS = 16;

// The pyramid holds the least depth code of square cells of pixels: level k of cells of 16 << k.
const int DEPTH_CELL = 16;

ivec2 depthCells(ivec2 size, int level) { return ((size + (DEPTH_CELL - 1)) / DEPTH_CELL + (1 << level) - 1) >> level; }

#endif
