#pragma once
/** @file What the pictures of several samples share. */
#include "passes/raster/view.hpp"
#include "passes/renderer/render_job.hpp"

#include <cstddef>
#include <optional>

namespace helio {

/** The view of sample k: from a point of the lens, where there is one. */
RasterView sampleView(const RasterView& view, const std::optional<ThinLens>& lens, std::size_t k);

/** Tells the application of a finished sample; false where it cancels before the last. */
bool notifySample(RenderJob& job, std::size_t done, std::size_t all);

}  // namespace helio
