#ifndef HELIOGRAPH_DISPATCH
#define HELIOGRAPH_DISPATCH
/** @file How workgroups are numbered. */

/** Workgroups are handed to the driver's threads in halves: neighbours go to different ones. */
uint interleavedGroup() {
    const uint count = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
    const uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    const uint middle = count >> 1;
    return group < 2u * middle ? (group < middle ? group * 2u : (group - middle) * 2u + 1u) : group;
}
#endif
