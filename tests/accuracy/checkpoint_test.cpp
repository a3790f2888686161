// Renders that are stopped, killed or refused, and go on to the bits of one that never was.
#include <heliograph/error.hpp>
#include <heliograph/renderer.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

namespace helio::test {
namespace {

namespace fs = std::filesystem;

RenderOptions options() {
    RenderOptions o;
    o.size = {80, 61};
    o.samples = 1200;
    o.checkpointSeconds = 0;
    return o;
}

Renderer& renderer() {
    static Renderer one({.validation = true});
    return one;
}

fs::path fileFor(const char* name) {
    const fs::path file =
        fs::temp_directory_path() / fmt::format("heliograph_{}_{}.checkpoint", name, getpid());
    fs::remove(file);
    return file;
}

/** Everything that must not depend on interruptions. */
void expectSame(const RenderResult& a, const RenderResult& b) {
    ASSERT_EQ(a.image.data.size(), b.image.data.size());
    EXPECT_EQ(std::memcmp(a.image.data.data(), b.image.data.data(), a.image.data.size() * sizeof(float)), 0);
    EXPECT_EQ(a.samples, b.samples);
    EXPECT_EQ(a.rays.camera, b.rays.camera);
    EXPECT_EQ(a.rays.bounce, b.rays.bounce);
    EXPECT_EQ(a.rays.shadow, b.rays.shadow);
    EXPECT_EQ(a.error.relmse, b.error.relmse);
}

TEST(Checkpoint, ACancelledRenderGoesOn) {
    const Scene scene = load("sample:cornell");
    const RenderResult whole = renderer().render(scene, options());
    RenderOptions o = options();
    o.checkpoint = fileFor("cancel");
    o.resume = true;
    int stops = 0;
    for (int calls = 3;; calls += 1) {
        int left = calls;
        o.progress = [&](const Progress& p) { return p.stage != "render" || --left > 0; };
        const RenderResult result = renderer().render(scene, o);
        EXPECT_TRUE(fs::exists(o.checkpoint));
        if (!result.cancelled) {
            expectSame(result, whole);
            break;
        }
        ASSERT_LT(++stops, 100);
    }
    fmt::print("stopped {} times\n", stops);
    EXPECT_GT(stops, 0);
    // Once more: nothing is left to do.
    o.progress = nullptr;
    expectSame(renderer().render(scene, o), whole);
    EXPECT_TRUE(renderer().device().validationMessages().empty());
    fs::remove(o.checkpoint);
}

TEST(Checkpoint, AnAdaptiveRenderWithAnErrorLimitGoesOn) {
    const Scene scene = load("sample:cornell");
    RenderOptions o = options();
    o.size = {40, 30};
    o.samples = 900;
    o.adaptive = true;
    o.maxError = 1e-4;
    const RenderResult whole = renderer().render(scene, o);
    o.checkpoint = fileFor("adaptive");
    o.resume = true;
    for (int calls = 2;; ++calls) {
        ASSERT_LT(calls, 60);
        int left = calls;
        o.progress = [&](const Progress& p) { return p.stage != "render" || --left > 0; };
        const RenderResult result = renderer().render(scene, o);
        if (result.cancelled) continue;
        expectSame(result, whole);
        break;
    }
    fs::remove(o.checkpoint);
}

/** Not a test of its own: the process that KilledAtAnyMoment kills. */
TEST(Checkpoint, DISABLED_Child) {
    const char* file = std::getenv("HELIOGRAPH_TEST_CHECKPOINT");
    ASSERT_NE(file, nullptr);
    RenderOptions o = options();
    o.checkpoint = file;
    o.resume = true;
    Renderer one;
    one.render(load("sample:cornell"), o);
}

/** Of the file of that name, 0 where there is none: every save makes a new one. */
ino_t inodeOf(const std::string& name) {
    struct stat status {};
    return stat(name.c_str(), &status) == 0 ? status.st_ino : 0;
}

TEST(Checkpoint, KilledAtAnyMoment) {
    RenderOptions o = options();
    o.checkpoint = fileFor("kill");
    o.resume = true;
    const std::string place = o.checkpoint.string();
    std::mt19937 random(11);
    int kills = 0;
    for (bool done = false; !done && kills < 12;) {
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            setenv("HELIOGRAPH_TEST_CHECKPOINT", place.c_str(), 1);
            freopen("/dev/null", "w", stdout);
            execl("/proc/self/exe", "checkpoint", "--gtest_filter=Checkpoint.DISABLED_Child",
                  "--gtest_also_run_disabled_tests", nullptr);
            _exit(127);
        }
        // The first at once, the others a little after they have saved something, on any machine.
        const ino_t before = inodeOf(place);
        int status = 0;
        const auto pause = std::chrono::milliseconds(random() % 60);
        while (!done && kills > 0 && inodeOf(place) == before) {
            done = waitpid(child, &status, WNOHANG) == child;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        if (!done) std::this_thread::sleep_for(pause);
        done = done || waitpid(child, &status, WNOHANG) == child;
        if (done) {
            EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
        } else {
            kill(child, SIGKILL);
            waitpid(child, &status, 0);
            ++kills;
        }
    }
    fmt::print("killed {} times\n", kills);
    const Scene scene = load("sample:cornell");
    const RenderResult resumed = renderer().render(scene, o);
    o.checkpoint.clear();
    o.resume = false;
    expectSame(resumed, renderer().render(scene, o));
    EXPECT_GT(kills, 0);
    fs::remove(place);
    for (const auto& entry : fs::directory_iterator(fs::temp_directory_path())) {
        const std::string name =
            entry.path().filename().string();  // what a kill in the midst of writing leaves
        if (name.find(fs::path(place).filename().string()) != std::string::npos) fs::remove(entry.path());
    }
}

std::string refusal(const Scene& scene, const RenderOptions& o) {
    try {
        renderer().render(scene, o);
    } catch (const InputError& error) {
        return error.what();
    }
    return "not refused";
}

TEST(Checkpoint, OfAnotherRenderIsRefused) {
    Scene scene = load("sample:cornell");
    RenderOptions o = options();
    o.size = {16, 16};
    o.samples = 8;
    o.checkpoint = fileFor("refuse");
    const RenderResult first = renderer().render(scene, o);
    o.resume = true;
    expectSame(renderer().render(scene, o), first);

    RenderOptions other = o;
    other.seed = 3;
    EXPECT_NE(refusal(scene, other).find("another seed: 0 there, 3 now"), std::string::npos)
        << refusal(scene, other);
    other = o;
    other.samples = 16;
    EXPECT_NE(refusal(scene, other).find("number of samples"), std::string::npos);
    other = o;
    other.size = {16, 17};
    EXPECT_NE(refusal(scene, other).find("size"), std::string::npos);
    Scene painted = scene;
    painted.materials[0].baseColor.r *= 0.5f;
    EXPECT_NE(refusal(painted, o).find("another scene"), std::string::npos);

    const auto write = [&](const std::string& bytes) {
        std::ofstream(o.checkpoint, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
    };
    std::ifstream stream(o.checkpoint, std::ios::binary);
    const std::string whole((std::istreambuf_iterator<char>(stream)), {});
    for (std::size_t at : {std::size_t(30), whole.size() / 2, whole.size() - 3}) {
        std::string damaged = whole;
        damaged[at] = char(damaged[at] ^ 4);
        write(damaged);
        EXPECT_NE(refusal(scene, o).find("damaged"), std::string::npos) << at;
    }
    for (std::size_t size : {std::size_t(0), std::size_t(10), whole.size() / 3, whole.size() - 1}) {
        write(whole.substr(0, size));
        EXPECT_NE(refusal(scene, o), "not refused") << size;
    }
    fs::remove(o.checkpoint);
    const RenderResult anew = renderer().render(scene, o);
    EXPECT_EQ(anew.warnings.size(), first.warnings.size() + 1);
    expectSame(anew, first);
    o.checkpoint.clear();
    EXPECT_NE(refusal(scene, o).find("no checkpoint"), std::string::npos);
}

}  // namespace
}  // namespace helio::test
