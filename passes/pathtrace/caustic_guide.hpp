#pragma once
/** @file
 * Guides paths to caustics: traces photons through a device scene's mirrors and glass, and holds the tables
 * that are made of them on the device.
 *
 *     CausticGuide guide(device, scene, options);  // compiles
 *     guide.trace();
 *     if (guide.tables() > 0) options.guide = &guide;
 */
#include "passes/pathtrace/guide_tables.hpp"
#include "passes/pathtrace/path_tracer.hpp"

#include <memory>
#include <optional>

namespace helio {

/** Move-only. The device and scene must outlive it. */
class CausticGuide {
public:
    /** Whether the scene has mirrors or glass, lamps, and what receives their light, and the options paths
     * that tables can guide. */
    static bool possible(const DeviceScene& scene, const PathTraceOptions& options);

    /** Where possible(). `options`: of the paths to guide. The driver compiles here. */
    CausticGuide(Device& device, DeviceScene& scene, const PathTraceOptions& options);
    ~CausticGuide();
    CausticGuide(CausticGuide&&) noexcept;
    CausticGuide& operator=(CausticGuide&&) noexcept;

    /** Traces the photons and makes the tables. The same for the same scene, seed and device. */
    void trace();

    std::uint64_t photons() const;
    /** Of what trace() found, without the arrays, which are on the device. */
    const GuideTables& found() const;
    std::uint64_t bytes() const;

    /** uGuideCells and uGuideTables, and the GUIDE_ constants, for kernels compiled with GUIDED. */
    std::vector<Binding> bindings(Graph& graph) const;
    SpecConstants constants() const;
    std::vector<PassTiming> timings() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace helio
