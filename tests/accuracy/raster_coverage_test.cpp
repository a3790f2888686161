/** @file Rows R2 to R5: coverage equals the exact oracle, in every size, shape and order. */
#include "tests/accuracy/raster_runner.hpp"

#include <cstdio>
#include <functional>

namespace helio::test {
namespace {

constexpr std::uint32_t kWidth = 512, kHeight = 320;

using MakeTriangle = std::function<RasterTriangle(Random&, std::uint32_t)>;

/** Many images of random triangles, compared with the oracle. */
Mismatch compareImages(std::uint32_t width, std::uint32_t height, int images, std::uint32_t triangles,
                       std::uint32_t seed, const MakeTriangle& make, double relative = 0.0) {
    const RasterView view = pixelView(width, height);
    // Small triangles directly, and as the library chooses.
    RasterRunner direct(width, height, triangles), chosen(width, height, triangles, {});
    Random random(seed);
    Mismatch all;
    for (int image = 0; image < images * repeats(); ++image) {
        std::vector<RasterTriangle> list;
        for (std::uint32_t i = 0; i < triangles; ++i) list.push_back(make(random, i));
        all.add(compare((image % 2 == 0 ? direct : chosen).run(view, list), view, list, relative));
    }
    std::printf(
        "             %llu pixels, %llu covered, %llu different, %llu too close to tell, depth off by %.1e\n",
        (unsigned long long)all.pixels, (unsigned long long)all.covered, (unsigned long long)all.different,
        (unsigned long long)all.close, all.depthError);
    return all;
}

/** A triangle facing the camera at a distance of its own, so that order in depth is beyond doubt. */
RasterTriangle facing(const std::array<glm::dvec2, 3>& p, double distance, std::uint32_t id) {
    RasterTriangle t;
    t.v0 = atPixel(p[0].x, p[0].y, distance);
    t.v1 = atPixel(p[1].x, p[1].y, distance);
    t.v2 = atPixel(p[2].x, p[2].y, distance);
    t.id = id;
    return t;
}

TEST(RasterCoverage, RandomTrianglesOfEverySize) {
    const Mismatch m = compareImages(kWidth, kHeight, 30, 120, 1, [](Random& random, std::uint32_t id) {
        const double size = std::pow(10.0, random.uniform(-0.5, 3.5));
        const glm::dvec2 centre(random.uniform(-50, kWidth + 50), random.uniform(-50, kHeight + 50));
        std::array<glm::dvec2, 3> p;
        for (auto& corner : p)
            corner = centre + size * glm::dvec2(random.uniform(-1, 1), random.uniform(-1, 1));
        return facing(p, 1.0 + id / 64.0, id);
    });
    EXPECT_EQ(m.different, 0u) << m.first;
    EXPECT_GT(m.covered, m.pixels / 2);
}

TEST(RasterCoverage, TiltedTriangles) {
    const Mismatch m = compareImages(
        kWidth, kHeight, 15, 60, 2,
        [](Random& random, std::uint32_t id) {
            RasterTriangle t;
            for (glm::vec3* v : {&t.v0, &t.v1, &t.v2})
                *v = atPixel(random.uniform(-100, kWidth + 100), random.uniform(-100, kHeight + 100),
                             random.uniform(1, 20));
            t.id = id;
            return t;
        },
        4e-7);
    EXPECT_EQ(m.different, 0u) << m.first;
    EXPECT_LT(m.close, m.pixels / 10000);
    EXPECT_LT(m.depthError, 2.5e-7);
}

TEST(RasterCoverage, CornersOnPixelCentresAndEdgesThroughThem) {
    const Mismatch m = compareImages(kWidth, kHeight, 12, 120, 3, [](Random& random, std::uint32_t id) {
        const double size = std::pow(10.0, random.uniform(0.3, 2.5));
        const glm::dvec2 centre(random.uniform(0, kWidth), random.uniform(0, kHeight));
        std::array<glm::dvec2, 3> p;
        for (auto& corner : p)
            corner =
                glm::floor(centre + size * glm::dvec2(random.uniform(-1, 1), random.uniform(-1, 1))) + 0.5;
        return facing(p, 1.0, id);  // equal depths: the smaller id wins
    });
    EXPECT_EQ(m.different, 0u) << m.first;
}

TEST(RasterCoverage, Slivers) {
    const Mismatch m = compareImages(kWidth, kHeight, 12, 400, 4, [](Random& random, std::uint32_t id) {
        // Lengths up to 10^4 pixels, widths down to a hundredth of one: aspects to 10^6.
        const double length = std::pow(10.0, random.uniform(1, 4)),
                     width = std::pow(10.0, random.uniform(-2, 0.3));
        const double angle =
            id % 8 == 0 ? 0.7853981633974483 * random.below(8) : random.uniform(0, 6.283185307179586);
        const glm::dvec2 along(std::cos(angle), std::sin(angle)), across(-along.y, along.x);
        const glm::dvec2 centre(random.uniform(0, kWidth), random.uniform(0, kHeight));
        return facing({centre - 0.5 * length * along, centre + 0.5 * length * along,
                       centre + random.uniform(-0.5, 0.5) * length * along + width * across},
                      1.0 + id / 64.0, id);
    });
    EXPECT_EQ(m.different, 0u) << m.first;
}

TEST(RasterCoverage, CrossingTheEyesPlane) {
    const Mismatch m = compareImages(
        kWidth, kHeight, 12, 40, 5,
        [](Random& random, std::uint32_t id) {
            RasterTriangle t;
            for (glm::vec3* v : {&t.v0, &t.v1, &t.v2})
                *v = glm::vec3(random.uniform(-1500, 1500), random.uniform(-1500, 1500),
                               random.uniform(-5, 3));
            t.id = id;
            return t;
        },
        4e-7);
    EXPECT_EQ(m.different, 0u) << m.first;
    EXPECT_GT(m.covered, m.pixels / 2);
    EXPECT_LT(m.close, m.pixels / 10000);
}

TEST(RasterCoverage, CoordinatesToTenMillionPixels) {
    const Mismatch m = compareImages(kWidth, kHeight, 12, 100, 6, [](Random& random, std::uint32_t id) {
        const double reach = std::pow(10.0, random.uniform(4, 7));
        std::array<glm::dvec2, 3> p;
        for (auto& corner : p) corner = {random.uniform(-reach, reach), random.uniform(-reach, reach)};
        if (id % 4 == 0) p[0] = {random.uniform(0, kWidth), random.uniform(0, kHeight)};
        return facing(p, 1.0 + id, id);
    });
    EXPECT_EQ(m.different, 0u) << m.first;
    EXPECT_GT(m.covered, m.pixels / 2);
}

TEST(RasterCoverage, ImagesOfOnePixelOneRowAndOddSizes) {
    const std::array<std::uint32_t, 2> sizes[] = {{1, 1},   {1, 700},  {700, 1}, {17, 33}, {15, 16},
                                                  {255, 2}, {65, 129}, {66, 37}, {20, 21}};
    for (const auto& [width, height] : sizes) {
        const Mismatch m = compareImages(width, height, 3, 60, 7, [&](Random& random, std::uint32_t id) {
            const double size = std::pow(10.0, random.uniform(-0.5, 3.0));
            const glm::dvec2 centre(random.uniform(0, width), random.uniform(0, height));
            std::array<glm::dvec2, 3> p;
            for (auto& corner : p)
                corner = centre + size * glm::dvec2(random.uniform(-1, 1), random.uniform(-1, 1));
            return facing(p, 1.0 + id / 64.0, id);
        });
        EXPECT_EQ(m.different, 0u) << width << " x " << height << " " << m.first;
    }
}

/** Every pixel inside the mesh is covered by exactly one of its triangles. The device draws the triangles
 * whose index has a bit set and those that have not: if the two never meet for any bit, no two triangles
 * share a pixel. */
void expectWatertight(const std::vector<RasterTriangle>& mesh, const std::function<bool(int, int)>& inside) {
    const RasterView view = pixelView(kWidth, kHeight);
    RasterRunner runner(kWidth, kHeight, std::uint32_t(mesh.size()));
    const RasterResult whole = runner.run(view, mesh);
    EXPECT_EQ(compare(whole, view, mesh).different, 0u);
    std::uint64_t holes = 0, twice = 0;
    for (std::size_t i = 0; i < whole.keys.size(); ++i)
        holes += inside(int(i % kWidth), int(i / kWidth)) && whole.keys[i] == 0;
    for (std::size_t bit = 1; bit < mesh.size(); bit *= 2) {
        std::vector<RasterTriangle> with, without;
        for (std::size_t i = 0; i < mesh.size(); ++i) (i & bit ? with : without).push_back(mesh[i]);
        const RasterResult a = runner.run(view, with), b = runner.run(view, without);
        for (std::size_t i = 0; i < whole.keys.size(); ++i) {
            twice += a.keys[i] != 0 && b.keys[i] != 0;
            holes += (a.keys[i] != 0 || b.keys[i] != 0) != (whole.keys[i] != 0);
        }
    }
    EXPECT_EQ(holes, 0u);
    EXPECT_EQ(twice, 0u);
}

TEST(RasterWatertight, FansAroundPixelCentres) {
    Random random(8);
    for (int fan = 0; fan < 4; ++fan) {
        // The hub on a centre, rim corners on the 1/256 grid, some on centres.
        const glm::dvec2 hub(kWidth / 2 + 0.5, kHeight / 2 + 0.5);
        const int spokes = 5 + 40 * fan;
        std::vector<glm::dvec2> rim;
        for (int k = 0; k < spokes; ++k) {
            const double angle = 6.283185307179586 * (k + random.uniform(0, 0.9)) / spokes;
            const glm::dvec2 p =
                hub + random.uniform(100, 150) * glm::dvec2(std::cos(angle), std::sin(angle));
            rim.push_back(k % 3 == 0 ? glm::floor(p) + 0.5 : glm::floor(p * 256.0) / 256.0);
        }
        std::vector<RasterTriangle> mesh;
        for (int k = 0; k < spokes; ++k)
            mesh.push_back(facing({hub, rim[std::size_t(k)], rim[std::size_t((k + 1) % spokes)]}, 1.0,
                                  std::uint32_t(k)));
        expectWatertight(
            mesh, [&](int x, int y) { return std::hypot(x - int(kWidth / 2), y - int(kHeight / 2)) < 60; });
    }
}

TEST(RasterWatertight, JitteredMeshesWithEdgesThroughCentres) {
    Random random(9);
    for (double cell : {1.0, 3.0, 17.0, 60.0}) {
        const int columns = int((cell < 2 ? 60 : kWidth - 40) / cell),
                  rows = int((cell < 2 ? 60 : kHeight - 40) / cell);
        std::vector<glm::dvec2> points;
        for (int y = 0; y <= rows; ++y)
            for (int x = 0; x <= columns; ++x) {
                const bool rim = x == 0 || y == 0 || x == columns || y == rows;
                // No fold: corners move by less than a quarter of the cell, rounding included.
                const double shift = rim || cell < 2 ? 0.0 : cell < 10 ? 0.2 * cell : 0.15 * cell;
                const glm::dvec2 p = glm::dvec2(20 + x * cell, 20 + y * cell) +
                                     shift * glm::dvec2(random.uniform(-1, 1), random.uniform(-1, 1));
                const bool onCentre = rim || cell < 2 || (cell > 10 && random.below(4) == 0);
                points.push_back(onCentre ? glm::floor(p) + 0.5 : glm::floor(p * 256.0) / 256.0);
            }
        std::vector<RasterTriangle> mesh;
        const auto point = [&](int x, int y) { return points[std::size_t(y * (columns + 1) + x)]; };
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x) {
                const std::array<glm::dvec2, 4> q = {point(x, y), point(x + 1, y), point(x + 1, y + 1),
                                                     point(x, y + 1)};
                const std::size_t turn = random.below(2);  // either diagonal; either winding
                mesh.push_back(facing({q[turn], q[1 + turn], q[2 + turn]}, 1.0, std::uint32_t(mesh.size())));
                mesh.push_back(
                    facing({q[(3 + turn) % 4], q[2 + turn], q[turn]}, 1.0, std::uint32_t(mesh.size())));
            }
        expectWatertight(mesh, [&](int x, int y) {
            return x > 21 + cell && y > 21 + cell && x < 19 + (columns - 1) * cell &&
                   y < 19 + (rows - 1) * cell;
        });
    }
}

TEST(RasterWatertight, ClippedFansAroundTheView) {
    // A pyramid around the eye, open nowhere: corners behind the eye and far beyond the guard band.
    std::vector<RasterTriangle> mesh;
    const glm::vec3 tip(2.5f, -1.75f, -4.0f);
    Random random(10);
    const int spokes = 24;
    std::vector<glm::vec3> rim;
    for (int k = 0; k < spokes; ++k) {
        const double angle = 6.283185307179586 * k / spokes, radius = std::pow(10.0, random.uniform(4, 7));
        rim.emplace_back(radius * std::cos(angle), radius * std::sin(angle), random.uniform(-10, 30));
    }
    for (int k = 0; k < spokes; ++k) {
        RasterTriangle t;
        t.v0 = tip * 400.0f;
        t.v1 = rim[std::size_t(k)];
        t.v2 = rim[std::size_t((k + 1) % spokes)];
        t.id = std::uint32_t(k);
        mesh.push_back(t);
    }
    // Only parts in front of the eye are seen; neighbours still meet without gaps or overlaps there.
    expectWatertight(mesh, [](int, int) { return false; });
}

TEST(RasterOrder, AnyOrderGivesTheSameBits) {
    const RasterView view = pixelView(kWidth, kHeight);
    Random random(11);
    std::vector<RasterTriangle> list;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const double size = std::pow(10.0, random.uniform(-0.5, 3));
        RasterTriangle t;
        const glm::dvec2 centre(random.uniform(0, kWidth), random.uniform(0, kHeight));
        for (glm::vec3* v : {&t.v0, &t.v1, &t.v2})
            *v = atPixel(centre.x + size * random.uniform(-1, 1), centre.y + size * random.uniform(-1, 1),
                         i % 3 == 0 ? 2.0 : random.uniform(1, 4));
        t.id = i;
        list.push_back(t);
        if (i % 5 == 0) {  // the same surface again under another id: a tie everywhere
            t.id = 10000 - i;
            list.push_back(t);
        }
    }
    RasterRunner whole(kWidth, kHeight, std::uint32_t(list.size()), {});
    RasterRunner pieces(kWidth, kHeight, std::uint32_t(list.size()),
                        {.batch = 700, .entries = 1, .tileLanes = 32, .direct = true});
    const RasterResult first = whole.run(view, list);
    EXPECT_EQ(compare(first, view, list, 4e-7).different, 0u);
    EXPECT_EQ(pieces.run(view, list).keys, first.keys) << "batches, coarse lists, short strips";
    for (int shuffle = 0; shuffle < 4; ++shuffle) {
        for (std::size_t i = list.size() - 1; i > 0; --i)
            std::swap(list[i], list[random.below(std::uint32_t(i + 1))]);
        EXPECT_EQ(whole.run(view, list).keys, first.keys);
        EXPECT_EQ(pieces.run(view, list).keys, first.keys) << "batches, coarse lists, short strips";
    }
}

TEST(RasterCapacity, MoreFullScreenTrianglesThanALoopMayHaveIterations) {
    const RasterView view = pixelView(70, 50);
    constexpr std::uint32_t count = 70000;
    std::vector<RasterTriangle> list;
    for (std::uint32_t i = 0; i < count; ++i)
        list.push_back(facing({glm::dvec2(-10, -10), glm::dvec2(300, -10), glm::dvec2(-10, 300)},
                              1.0 + (i * 7919u % count), i));
    RasterRunner runner(70, 50, count, {.batch = count});
    const RasterResult result = runner.run(view, list);
    for (std::uint64_t key : result.keys) ASSERT_EQ(visibleTriangle(key), 0);
    EXPECT_EQ(result.counters.large, count);
    EXPECT_EQ(result.counters.tileVisited, count * 5ull * 4ull);
    // The nearest last, in the last of the segments.
    std::reverse(list.begin(), list.end());
    EXPECT_EQ(runner.run(view, list).keys, result.keys);
}

TEST(RasterCapacity, ListsThatHoldOneEntryForATriangle) {
    const RasterView view = pixelView(kWidth, kHeight);
    Random random(12);
    std::vector<RasterTriangle> list;
    for (std::uint32_t i = 0; i < 500; ++i) {
        std::array<glm::dvec2, 3> p;
        for (auto& corner : p) corner = {random.uniform(-400, 900), random.uniform(-300, 600)};
        list.push_back(facing(p, 1.0 + i / 64.0, i));
    }
    for (std::uint64_t entries : {1u, 20000u, 200000u}) {
        // Memory is poisoned: nothing may be read that was not written.
        RasterRunner runner(kWidth, kHeight, 500, {.batch = 200, .entries = entries}, {.poison = true});
        const RasterResult result = runner.run(view, list);
        EXPECT_EQ(compare(result, view, list).different, 0u) << entries;
        EXPECT_LE(result.counters.entries, 3 * std::max<std::uint64_t>(entries, 6 * 200));
    }
}

TEST(RasterCapacity, ListsThatJustFillATilesSlotsOrNot) {
    const RasterView view = pixelView(32, 16);
    for (std::uint32_t count : {127u, 128u, 129u, 256u}) {
        std::vector<RasterTriangle> list;
        for (std::uint32_t i = 0; i < count; ++i) {  // each is seen at a pixel of the first tile
            const double x = i % 16 + 0.2, y = i / 16 + 0.2;
            list.push_back(
                facing({glm::dvec2(x, y), glm::dvec2(33, y + 0.3), glm::dvec2(x, y + 0.6)}, 20 - x, i));
        }
        RasterRunner runner(32, 16, count, {}, {.poison = true});
        for (int time = 0; time < 2; ++time) {
            const RasterResult result = runner.run(view, list);
            EXPECT_EQ(compare(result, view, list).different, 0u) << count;
            EXPECT_EQ(result.counters.entries, 2 * count);
        }
        RasterRunner batches(32, 16, count, {.batch = 50}, {.poison = true});
        const RasterResult result = batches.run(view, list);
        EXPECT_EQ(compare(result, view, list).different, 0u) << count;
        EXPECT_EQ(result.counters.entries, 2 * count) << "each batch's alone";
    }
}

TEST(RasterCapacity, SmallTrianglesGatheredOrNot) {
    const RasterView view = pixelView(kWidth, kHeight);
    for (std::uint32_t count : {1u, 7u, 33u, 600u, 20000u}) {
        Random random(count);
        std::vector<RasterTriangle> list;
        for (std::uint32_t i = 0; i < count; ++i) {
            // Most cover few pixels or none; some are for the tiles, some cross the eye's plane.
            const double side = random.uniform(0, 1) < 0.02 ? 60 : random.uniform(0, 1) < 0.5 ? 1.5 : 8;
            const glm::dvec2 centre(random.uniform(0, kWidth), random.uniform(0, kHeight));
            std::array<glm::dvec2, 3> p;
            for (auto& corner : p)
                corner = centre + side * glm::dvec2(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
            list.push_back(facing(p, 1.0 + random.uniform(0, 1), i));
            if (i % 50 == 49) list.back().v2.z = 0.5f;
        }
        RasterRunner apart(kWidth, kHeight, count, {.gather = false, .direct = true});
        RasterRunner together(kWidth, kHeight, count, {.gather = true, .direct = true}, {.poison = true});
        const RasterResult result = together.run(view, list), expected = apart.run(view, list);
        EXPECT_EQ(compare(result, view, list).different, 0u) << count;
        EXPECT_EQ(result.keys, expected.keys) << count;
        EXPECT_EQ(result.counters.smallCovered, expected.counters.smallCovered) << count;
    }
}

TEST(RasterCapacity, SmallTrianglesDrawnDirectlyOrLeftToTheTiles) {
    const RasterView view = pixelView(kWidth, kHeight);
    std::vector<RasterTriangle> list;
    for (std::uint32_t i = 0; i < 640; ++i) {
        const double side = i % 4 != 0 ? 7.5 : 30;
        const glm::dvec2 corner(5.3 + 11.7 * (i % 40), 4.1 + 17.9 * (i / 40));
        list.push_back(facing({corner, corner + glm::dvec2(side, 0), corner + glm::dvec2(0, side)},
                              1.0 + double(i * 37 % 640) / 64, i));
    }
    RasterRunner direct(kWidth, kHeight, 640, {.direct = true}),
        left(kWidth, kHeight, 640, {.direct = false});
    const RasterResult a = direct.run(view, list), b = left.run(view, list);
    EXPECT_EQ(compare(a, view, list).different, 0u);
    EXPECT_EQ(a.keys, b.keys);
    EXPECT_EQ(a.counters.small, 480u);
    EXPECT_EQ(a.counters.large, 160u);
    EXPECT_EQ(b.counters.small, 0u);
    EXPECT_EQ(b.counters.large, 640u);
}

TEST(RasterCapacity, AMillionTinyTriangles) {
    const RasterView view = pixelView(kWidth, kHeight);
    constexpr std::uint32_t count = 1000000;
    Random random(13);
    std::vector<RasterTriangle> list;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::dvec2 centre(random.uniform(0, kWidth), random.uniform(0, kHeight));
        std::array<glm::dvec2, 3> p;
        for (auto& corner : p)
            corner = centre + glm::dvec2(random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8));
        list.push_back(facing(p, 1.0 + i / 1048576.0, i));
    }
    RasterRunner runner(kWidth, kHeight, count);
    const RasterResult result = runner.run(view, list);
    const Mismatch m = compare(result, view, list);
    EXPECT_EQ(m.different, 0u) << m.first;
    EXPECT_EQ(result.counters.triangles, count);
    EXPECT_EQ(result.counters.small + result.counters.outside + result.counters.empty, count);
}

TEST(RasterCounters, BoundingBoxesOfRightTrianglesAreTwiceTheirArea) {
    const RasterView view = pixelView(kWidth, kHeight);
    std::vector<RasterTriangle> list;
    for (std::uint32_t i = 0; i < 32; ++i) {
        const glm::dvec2 corner(8 + 12 * (i % 8), 8 + 12 * (i / 8));
        const glm::dvec2 across = corner + glm::dvec2(8, 8), right = corner + glm::dvec2(8, 0),
                         down = corner + glm::dvec2(0, 8);
        list.push_back(facing({corner, right, across}, 1.0, 2 * i));
        list.push_back(facing({corner, across, down}, 1.0, 2 * i + 1));
    }
    RasterRunner runner(kWidth, kHeight, std::uint32_t(list.size()), {.direct = true});
    const RasterCounters counters = runner.run(view, list).counters;
    EXPECT_EQ(counters.triangles, 64u);
    EXPECT_EQ(counters.small, 64u);
    EXPECT_EQ(counters.smallVisited, 64u * 64u);
    EXPECT_EQ(counters.smallCovered, 64u * 32u);
    EXPECT_EQ(counters.entries, 0u);
}

TEST(RasterCounters, WhatIsOutsideEmptyOrTurnedAway) {
    const RasterView view = pixelView(kWidth, kHeight);
    const glm::dvec2 a(10, 10), b(30, 10), c(10, 30);
    std::vector<RasterTriangle> list = {
        facing({a, b, c}, 1.0, 0),                       // clockwise on the screen: a back face
        facing({a + 40.0, c + 40.0, b + 40.0}, 1.0, 1),  // a front face
        facing({a, b, 0.5 * (a + b)}, 1.0, 2),           // no area
        facing({glm::dvec2(10.6, 10.6), glm::dvec2(11.4, 10.6), glm::dvec2(10.6, 11.4)}, 1.0,
               3),                                          // between centres
        facing({a - 100.0, b - 100.0, c - 100.0}, 1.0, 4),  // left of the view
        facing({a, b, c}, -1.0, 5),                         // behind the eye
    };
    RasterRunner both(kWidth, kHeight, 6), front(kWidth, kHeight, 6, {.cullBackFaces = true});
    const RasterResult all = both.run(view, list), culled = front.run(view, list);
    EXPECT_EQ(all.counters.large, 2u);
    EXPECT_EQ(all.counters.empty, 2u);
    EXPECT_EQ(all.counters.outside, 2u);
    EXPECT_EQ(all.counters.backFacing, 0u);
    EXPECT_EQ(culled.counters.large, 1u);
    EXPECT_GE(culled.counters.backFacing, 1u);
    const auto at = [&](const RasterResult& r, int x, int y) {
        return visibleTriangle(r.keys[std::size_t(y) * kWidth + std::size_t(x)]);
    };
    EXPECT_EQ(at(all, 12, 12), 0);
    EXPECT_EQ(at(all, 52, 52), 1);
    EXPECT_EQ(at(culled, 12, 12), -1);
    EXPECT_EQ(at(culled, 52, 52), 1);
}

}  // namespace
}  // namespace helio::test
