/** @file What the graph's compiler refuses, and that each refusal names pass, binding, resource and remedy.
 */
#include "tests/graph/builder.hpp"

#include <gtest/gtest.h>

namespace helio::graph {
namespace {

/** Expects exactly one problem with these names, whose message holds `text`. */
void expectProblem(const Builder& g, const std::string& pass, const std::string& binding,
                   const std::string& resource, const std::string& text) {
    const std::vector<GraphProblem> problems = validate(g.input);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].pass, pass);
    EXPECT_EQ(problems[0].binding, binding);
    EXPECT_EQ(problems[0].resource, resource);
    EXPECT_NE(problems[0].message.find(text), std::string::npos) << problems[0].message;
    EXPECT_NE(problems[0].message.find(';'), std::string::npos) << "no remedy: " << problems[0].message;
    EXPECT_THROW(g.compile(), GraphError);
}

TEST(Validate, ReadBeforeWrite) {
    Builder g;
    const auto a = g.buffer("a"), b = g.buffer("b");
    g.pass("use").reads(a, "uA").writes(b, "uB");
    g.readback(b);
    expectProblem(g, "use", "uA", "a", "is read before any pass writes it");
}

TEST(Validate, ReadBeforeALaterWrite) {
    Builder g;
    const auto a = g.buffer("a"), b = g.buffer("b");
    g.pass("use").reads(a, "uA").writes(b, "uB");
    g.pass("make").writes(a, "uA");
    g.readback(b);
    expectProblem(g, "use", "uA", "a", "declare a pass that writes it earlier");
}

TEST(Validate, ModifyBeforeWrite) {
    Builder g;
    const auto a = g.buffer("a");
    g.pass("add").modifies(a, "uA");
    g.readback(a);
    expectProblem(g, "add", "uA", "a", "is modified before any pass writes it");
}

TEST(Validate, ImportedMayBeReadAndModifiedAtOnce) {
    Builder g;
    const auto a = g.importBuffer("a"), b = g.importBuffer("b");
    g.pass("p").reads(a).modifies(b);
    EXPECT_TRUE(validate(g.input).empty());
}

TEST(Validate, ReadbackOfNothing) {
    Builder g;
    const auto a = g.buffer("a");
    g.readback(a);
    expectProblem(g, "", "readback", "a", "is read back but no pass writes it");
}

TEST(Validate, DuplicateBinding) {
    Builder g;
    const auto a = g.importBuffer("a"), b = g.buffer("b");
    g.pass("p").reads(a, "uX").writes(b, "uX");
    g.readback(b);
    expectProblem(g, "p", "uX", "b", "is declared twice");
}

TEST(Validate, UnnamedBinding) {
    Builder g;
    const auto a = g.buffer("a");
    g.input.passes.push_back(
        {.name = "p", .accesses = {{"", a, Builder::serial, Mode::Write, Usage::StorageBuffer, {}}}});
    g.readback(a);
    expectProblem(g, "p", "", "a", "without a name");
}

TEST(Validate, SameResourceReadAndWrittenInOnePass) {
    Builder g;
    const auto a = g.importBuffer("a");
    g.pass("p").reads(a, "uIn").writes(a, "uOut");
    expectProblem(g, "p", "uOut", "a", "overlaps binding 'uIn'");
}

TEST(Validate, SameResourceWrittenTwiceInOnePass) {
    Builder g;
    const auto a = g.importBuffer("a");
    g.pass("p").writes(a, "uX").writes(a, "uY");
    expectProblem(g, "p", "uY", "a", "modifies()");
}

TEST(Validate, SameImageReadAndWrittenInOnePass) {
    Builder g;
    const auto a = g.importImage("a");
    g.pass("p").reads(a, "uIn").modifies(a, "uOut");
    expectProblem(g, "p", "uOut", "a", "overlaps");
}

TEST(Validate, SameResourceReadTwiceIsFine) {
    Builder g;
    const auto a = g.importBuffer("a");
    g.pass("p").reads(a).reads(a).keep();
    EXPECT_TRUE(validate(g.input).empty());
}

TEST(Validate, SameResourceModifiedThroughTwoBindingsIsFine) {
    Builder g;
    const auto a = g.importBuffer("a");
    g.pass("p").modifies(a).modifies(a);
    EXPECT_TRUE(validate(g.input).empty());
}

TEST(Validate, DisjointWindowsOfOneBufferAreFine) {
    Builder g;
    const auto a = g.importBuffer("a", 1024);
    g.pass("p").reads(a, "uLow", {0, 512}).writes(a, "uHigh", {512, 0});
    EXPECT_TRUE(validate(g.input).empty());
}

TEST(Validate, OverlappingWindowsOfOneBuffer) {
    Builder g;
    const auto a = g.importBuffer("a", 1024);
    g.pass("p").reads(a, "uLow", {0, 516}).writes(a, "uHigh", {512, 0});
    expectProblem(g, "p", "uHigh", "a", "overlaps binding 'uLow'");
}

TEST(Validate, IndirectArgumentsWrittenByTheSamePass) {
    Builder g;
    const auto a = g.importBuffer("a");
    g.pass("p").writes(a, "uCounts").indirect(a);
    expectProblem(g, "p", "indirect", "a", "overlaps binding 'uCounts'");
}

TEST(Validate, WindowBeyondTheBuffer) {
    Builder g;
    const auto a = g.importBuffer("a", 1024);
    g.pass("p").reads(a, "uA", {512, 516}).keep();
    expectProblem(g, "p", "uA", "a", "is bound at bytes 512 to 1028 but has 1024");
}

TEST(Validate, WindowStartsAtTheEnd) {
    Builder g;
    const auto a = g.importBuffer("a", 1024);
    g.pass("p").reads(a, "uA", {1024, 0}).keep();
    expectProblem(g, "p", "uA", "a", "to its end but has 1024");
}

TEST(Validate, WindowWhoseEndWrapsAround) {
    Builder g;
    const auto a = g.importBuffer("a", 1024);
    g.pass("p").reads(a, "uA", {16, ~std::uint64_t(0) - 7}).keep();
    expectProblem(g, "p", "uA", "a", "move the window inside");
}

TEST(Validate, OverwriteThroughAPartialWindow) {
    Builder g;
    const auto a = g.importBuffer("a", 1024);
    g.pass("p").overwrites(a, "uA", {0, 512});
    expectProblem(g, "p", "uA", "a", "declare it with writes()");
}

TEST(Validate, ForeignHandle) {
    Builder g;
    const auto a = g.importBuffer("a");
    g.pass("p").writes(a, "uA");
    g.input.passes[0].accesses.push_back(
        {"uB", a, Builder::serial + 1, Mode::Read, Usage::StorageBuffer, {}});
    expectProblem(g, "p", "uB", "", "handle of another graph");
}

TEST(Validate, HandleBeyondTheResources) {
    Builder g;
    const auto a = g.importBuffer("a");
    g.pass("p").writes(a, "uA").reads(99, "uB");
    expectProblem(g, "p", "uB", "", "handle of another graph");
}

TEST(Validate, EmptyHandle) {
    Builder g;
    const auto a = g.importBuffer("a");
    g.pass("p").writes(a, "uA").reads(none, "uB");
    expectProblem(g, "p", "uB", "", "empty handle");
}

TEST(Validate, ForeignReadback) {
    Builder g;
    const auto a = g.importBuffer("a");
    g.pass("p").writes(a, "uA");
    g.input.readbacks.push_back({a, Builder::serial + 1});
    expectProblem(g, "", "readback", "", "handle of another graph");
}

TEST(Validate, BufferOfNoBytes) {
    Builder g;
    const auto a = g.buffer("a", 0);
    g.pass("p").writes(a, "uA");
    g.readback(a);
    expectProblem(g, "", "", "a", "has 0 bytes");
}

TEST(Validate, ImageOfNoTexels) {
    Builder g;
    const auto a = g.image("a", 16, 0);
    g.pass("p").writes(a, "uA");
    g.readback(a);
    expectProblem(g, "", "", "a", "16 x 0 texels");
}

TEST(Validate, ImageWithoutFormat) {
    Builder g;
    const auto a = g.image("a");
    g.input.resources[a].format = Format::Undefined;
    g.pass("p").writes(a, "uA");
    g.readback(a);
    expectProblem(g, "", "", "a", "has no format");
}

TEST(Validate, ResourceTooLargeToAllocate) {
    Builder g;
    const auto a = g.buffer("a", 4096);
    g.input.limits.maxArenaBytes = 4095;
    g.pass("p").writes(a, "uA");
    g.readback(a);
    expectProblem(g, "", "", "a", "more than the device allocates at once");
}

TEST(Validate, ImageWhereABufferBelongs) {
    Builder g;
    const auto a = g.importImage("a");
    g.pass("p").access(a, Mode::Write, Usage::StorageBuffer, "uA");
    expectProblem(g, "p", "uA", "a", "is an image where a buffer belongs");
}

TEST(Validate, BufferWhereAnImageBelongs) {
    Builder g;
    const auto a = g.importBuffer("a");
    g.pass("p").access(a, Mode::Write, Usage::StorageImage, "uA");
    expectProblem(g, "p", "uA", "a", "is a buffer where an image belongs");
}

TEST(Validate, WriteThroughAUniformBinding) {
    Builder g;
    const auto a = g.importBuffer("a");
    g.pass("p").access(a, Mode::Write, Usage::UniformTexelBuffer, "uA");
    expectProblem(g, "p", "uA", "a", "declare it with reads(), not writes()");
}

TEST(Validate, NoRoots) {
    Builder g;
    const auto a = g.buffer("a");
    g.pass("p").writes(a);
    expectProblem(g, "", "", "", "no pass is needed");
}

TEST(Validate, AnEmptyGraphIsFine) {
    Builder g;
    EXPECT_TRUE(g.compile().steps.empty());
}

TEST(Validate, AllProblemsAtOnceAndAlsoOfCulledPasses) {
    Builder g;
    const auto a = g.buffer("a"), b = g.buffer("b"), c = g.buffer("c", 0);
    g.pass("first").reads(a, "uA").writes(b, "uB");
    g.pass("unneeded").reads(c, "uC").reads(c, "uC");
    g.readback(b);
    try {
        g.compile();
        FAIL() << "compiled";
    } catch (const GraphError& error) {
        // a read early; c empty, read early twice, bound twice.
        EXPECT_EQ(error.problems.size(), 5u) << error.what();
        EXPECT_NE(std::string(error.what()).find("pass 'first': binding 'uA': resource 'a'"),
                  std::string::npos);
    }
}

}  // namespace
}  // namespace helio::graph
