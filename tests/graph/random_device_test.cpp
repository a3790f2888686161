/** @file Random graphs of integer kernels on the device against an interpreter on the host: every value, with
 * aliasing, without, and poisoned, over imported resources that keep their values. */
#include "tests/graph/kernels.hpp"
#include "tests/support/device.hpp"

#include <heliograph/graph.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <random>

namespace helio {
namespace {

using test::device;
using Values = std::vector<std::uint32_t>;

enum class View { None, Storage, Texel, Image };
enum class Change { Overwrite, Part, Modify };

/** What both the kernel and the interpreter compute. */
struct Push {
    std::uint32_t salt, countA, countB, countOut, widthA, widthB, widthOut;
};

std::uint32_t element(std::uint32_t i, std::uint32_t salt, std::uint32_t count) {
    return (i * 7u + salt) % count;
}
std::uint32_t combine(std::uint32_t i, std::uint32_t a, std::uint32_t b, std::uint32_t salt) {
    return a * 1664525u + b * 22695477u + salt + i * 2654435761u;
}

/** GLSL twin of the two functions above, for one way of reaching the inputs and the output. */
Kernel kernelFor(View a, View b, View out, Change change) {
    static std::map<int, Kernel> made;
    const int key = int(a) * 64 + int(b) * 16 + int(out) * 4 + int(change);
    if (const auto found = made.find(key); found != made.end()) return found->second;
    std::string declarations =
        "layout(push_constant) uniform Push { uint salt, countA, countB, countOut, widthA, widthB, widthOut; "
        "} p;\n";
    const auto input = [&](View view, const std::string& name, int binding) -> std::string {
        const std::string at = "layout(set = 0, binding = " + std::to_string(binding);
        const std::string index = "e(i, p.count" + name + ")";
        if (view == View::None) return "0u";
        if (view == View::Storage) {
            declarations += at + ", std430) readonly buffer Block" + name + " { uint v[]; } u" + name + ";\n";
            return "u" + name + ".v[" + index + "]";
        }
        if (view == View::Texel) {
            declarations += at + ") uniform usamplerBuffer u" + name + ";\n";
            return "texelFetch(u" + name + ", int(" + index + ")).x";
        }
        declarations += at + ", r32ui) uniform readonly uimage2D u" + name + ";\n";
        return "imageLoad(u" + name + ", xy(" + index + ", p.width" + name + ")).x";
    };
    declarations +=
        "uint e(uint i, uint n) { return (i * 7u + p.salt) % n; }\nivec2 xy(uint i, uint w) { return ivec2(i "
        "% w, i / w); }\n";
    const std::string readA = input(a, "A", 0), readB = input(b, "B", 1);
    const std::string qualifier = change == Change::Modify ? " " : " writeonly ";
    std::string load, store;
    if (out == View::Storage) {
        declarations +=
            "layout(set = 0, binding = 2, std430)" + qualifier + "buffer BlockOut { uint v[]; } uOut;\n";
        load = "uOut.v[i]";
        store = "uOut.v[i] = v;";
    } else if (out == View::Texel) {
        declarations += "layout(set = 0, binding = 2, r32ui) uniform" + qualifier + "uimageBuffer uOut;\n";
        load = "imageLoad(uOut, int(i)).x";
        store = "imageStore(uOut, int(i), uvec4(v));";
    } else {
        declarations += "layout(set = 0, binding = 2, r32ui) uniform" + qualifier + "uimage2D uOut;\n";
        load = "imageLoad(uOut, xy(i, p.widthOut)).x";
        store = "imageStore(uOut, xy(i, p.widthOut), uvec4(v));";
    }
    const std::string guard = change == Change::Part ? "if (i % 3u == p.salt % 3u) " : "";
    const std::string body =
        // Workgroup counts from an indirect buffer may be more or fewer than the values: every count works.
        "if (gl_WorkGroupID.y + gl_WorkGroupID.z > 0u) return;\n"
        "for (uint i = gl_GlobalInvocationID.x; i < p.countOut; i += gl_NumWorkGroups.x * 64u) {\n"
        "uint v = " +
        readA + " * 1664525u + " + readB + " * 22695477u + p.salt + i * 2654435761u;\n" +
        (change == Change::Modify ? "v += " + load + " * 3u;\n" : "") + guard + store + "\n}";
    return made[key] = test::kernelOf("test/random_" + std::to_string(key), declarations, body);
}

/** A resource, its handle, and its value on the host. */
struct Resource {
    bool image = false, imported = false, written = false;
    std::uint32_t count = 0, width = 0;
    Buffer buffer;
    Image picture;
    std::unique_ptr<DeviceBuffer> owned;
    Values values;  ///< of imported resources kept from run to run

    Binding bind(const std::string& name, View view) const {
        if (image) return Binding(name, picture);
        return view == View::Texel ? Binding(name, buffer, Format::R32UI) : Binding(name, buffer);
    }
};

/** One pass on the host. */
using HostPass = std::function<void(std::vector<Values>&)>;

struct RandomProgram {
    Graph graph{device()};
    std::vector<Resource> resources;
    std::vector<HostPass> host;
    std::vector<std::pair<std::size_t, Readback<std::uint32_t>>> results;

    explicit RandomProgram(std::uint32_t seed) : random_(seed) {
        const std::uint32_t resourceCount = 3 + below(8);
        for (std::uint32_t i = 0; i < resourceCount; ++i) addResource(i);
        const std::uint32_t passCount = 2 + below(10);
        for (std::uint32_t i = 0; i < passCount; ++i) addPass(i);
        for (std::size_t i = 0; i < resources.size(); ++i) {
            const Resource& r = resources[i];
            if (!r.written || !(r.imported || chance(40) || results.empty())) continue;
            results.emplace_back(i, r.image ? graph.readback<std::uint32_t>(r.picture)
                                            : graph.readback<std::uint32_t>(r.buffer));
        }
    }

    /** What the readbacks must hold after one more execution. */
    std::vector<Values> interpret() {
        std::vector<Values> values;
        for (const Resource& r : resources) values.push_back(r.imported ? r.values : Values(r.count, 0));
        for (const HostPass& pass : host) pass(values);
        for (std::size_t i = 0; i < resources.size(); ++i)
            if (resources[i].imported) resources[i].values = values[i];
        return values;
    }

private:
    std::uint32_t below(std::uint32_t n) { return std::uint32_t(random_() % n); }
    bool chance(std::uint32_t percent) { return below(100) < percent; }

    void addResource(std::uint32_t index) {
        Resource r;
        const std::string name = "r" + std::to_string(index);
        r.image = chance(30);
        r.width = 1 + below(16);
        r.count = r.image ? r.width * (1 + below(16)) : 1 + below(500);
        r.imported = !r.image && chance(25);
        if (r.image) {
            r.picture = graph.image(name, {{r.width, r.count / r.width}, Format::R32UI});
        } else if (r.imported) {
            for (std::uint32_t i = 0; i < r.count; ++i) r.values.push_back(i * 77u);
            r.owned = std::make_unique<DeviceBuffer>(makeBuffer(device(), name, r.values));
            r.buffer = graph.import(*r.owned);
            r.written = true;
        } else {
            r.buffer = graph.buffer(name, {r.count * 4ull});
        }
        resources.push_back(std::move(r));
    }

    /** A written resource other than the given ones; the number of resources where there is none. */
    std::size_t pickWritten(std::size_t no, std::size_t neither) {
        for (int tries = 0; tries < 8; ++tries) {
            const std::size_t i = below(std::uint32_t(resources.size()));
            if (resources[i].written && i != no && i != neither) return i;
        }
        return resources.size();
    }

    void addPass(std::uint32_t index) {
        const std::string name = "p" + std::to_string(index);
        const std::size_t none = resources.size();
        const std::size_t out = below(std::uint32_t(none));
        Resource& target = resources[out];
        const std::uint32_t salt = std::uint32_t(random_());
        if (!target.image && chance(10)) {
            graph.fill(name, target.buffer, salt);
            host.push_back([=](std::vector<Values>& v) { v[out].assign(v[out].size(), salt); });
            target.written = true;
            return;
        }
        const std::size_t a = chance(80) ? pickWritten(out, none) : none;
        const std::size_t b = chance(50) ? pickWritten(out, a) : none;
        if (!target.image && a != none && !resources[a].image && resources[a].count <= target.count &&
            (resources[a].count == target.count || target.written) && chance(30)) {
            graph.copy(name, resources[a].buffer, target.buffer);
            host.push_back(
                [=](std::vector<Values>& v) { std::copy(v[a].begin(), v[a].end(), v[out].begin()); });
            target.written = true;
            return;
        }
        const auto viewOf = [&](std::size_t r) {
            if (r == none) return View::None;
            return resources[r].image ? View::Image : chance(50) ? View::Storage : View::Texel;
        };
        const View viewA = viewOf(a), viewB = viewOf(b), viewOut = viewOf(out);
        const Change change = target.written ? Change(below(3)) : Change::Overwrite;
        const auto countOf = [&](std::size_t r) { return r == none ? 1u : resources[r].count; };
        const auto widthOf = [&](std::size_t r) { return r == none ? 1u : resources[r].width; };
        const Push push{salt, countOf(a), countOf(b), countOf(out), widthOf(a), widthOf(b), widthOf(out)};

        Buffer arguments;
        const bool indirect = chance(15);
        if (indirect) {
            arguments = graph.buffer(name + " arguments", {12});
            graph.fill(name + " fill", arguments, 1 + below(4));
        }
        Pass pass = graph.compute(name, kernelFor(viewA, viewB, viewOut, change));
        if (a != none) pass.reads({resources[a].bind("uA", viewA)});
        if (b != none) pass.reads({resources[b].bind("uB", viewB)});
        const Binding binding = target.bind("uOut", viewOut);
        if (change == Change::Modify)
            pass.modifies({binding});
        else if (change == Change::Part || chance(30))
            pass.writes({binding});
        else
            pass.overwrites({binding});
        if (indirect) pass.indirect(arguments);
        if (chance(10)) pass.keep();
        pass.record([=](Commands& c) {
            c.push(push);
            if (indirect)
                c.dispatchIndirect(arguments);
            else
                c.dispatchInvocations(push.countOut);
        });
        host.push_back([=](std::vector<Values>& v) {
            for (std::uint32_t i = 0; i < push.countOut; ++i) {
                const std::uint32_t x = a == none ? 0 : v[a][element(i, salt, push.countA)];
                const std::uint32_t y = b == none ? 0 : v[b][element(i, salt, push.countB)];
                if (change == Change::Part && i % 3 != salt % 3) continue;
                v[out][i] = combine(i, x, y, salt) + (change == Change::Modify ? v[out][i] * 3u : 0u);
            }
        });
        target.written = true;
    }

    std::mt19937 random_;
};

TEST(RandomPrograms, AgreeWithTheHost) {
    std::uint64_t compared = 0, culled = 0, apart = 0, shared = 0;
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        RandomProgram program(seed);
        std::vector<Plan> plans;
        plans.push_back(program.graph.compile());
        plans.push_back(program.graph.compile({.alias = false}));
        plans.push_back(program.graph.compile({.poison = true}));
        culled += plans[0].culled().size();
        shared += plans[0].aliasing().allocatedBytes;
        apart += plans[1].aliasing().allocatedBytes;
        for (const std::size_t which : {0, 0, 1, 2, 0}) {
            const std::vector<Values> expected = program.interpret();
            const Execution run = plans[which].execute();
            for (const auto& [resource, readback] : program.results) {
                const Values values = readback.wait(run);
                ASSERT_EQ(values, expected[resource])
                    << "seed " << seed << " plan " << which << " resource " << resource;
                compared += values.size();
            }
        }
    }
    std::cout << compared << " values, " << culled << " passes culled, " << shared << " of " << apart
              << " bytes\n";
    EXPECT_GT(compared, 100000u);
    EXPECT_GT(culled, 20u);
    EXPECT_LT(shared, apart);
}

}  // namespace
}  // namespace helio
