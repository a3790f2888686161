/** @file The dumps of compiled plans. */
#include "tests/graph/plan_queries.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace helio::graph {
namespace {

using Names = std::vector<std::string>;

TEST(Dump, JsonNamesEverything) {
    Builder g;
    const auto a = g.buffer("a"), b = g.buffer("b"), x = g.importBuffer("x");
    g.pass("a").overwrites(a);
    g.pass("use a").reads(a).modifies(x);
    g.pass("b").overwrites(b);
    g.pass("use b").reads(b).modifies(x);
    g.pass("useless").writes(g.image("spare"));
    const nlohmann::json json = nlohmann::json::parse(dumpJson(g.input, g.compile()));
    EXPECT_EQ(json["steps"].size(), 4u);
    EXPECT_EQ(json["culled"][0]["pass"], "useless");
    EXPECT_EQ(json["culled"][0]["reason"], "no root needs what it writes: 'spare'");
    EXPECT_EQ(json["resources"][a]["memory"]["shares_with"], nlohmann::json::array({b}));
    EXPECT_EQ(json["resources"][3]["used"], false);
    EXPECT_EQ(json["steps"][2]["barriers"][0]["cause"], "aliasing");
    EXPECT_EQ(json["steps"][1]["barriers"][0]["from"]["access"], "storage-write");
    EXPECT_EQ(json["transient_bytes"], 2048);
    EXPECT_EQ(json["allocated_bytes"], 1024);
}

TEST(Dump, GraphvizEscapesNamesAndShowsCulledAndShared) {
    Builder g;
    const auto a = g.buffer("a \"quoted\""), b = g.buffer("b"), x = g.importBuffer("x");
    g.pass("back\\slash").overwrites(a);
    g.pass("use a").reads(a).modifies(x);
    g.pass("b").overwrites(b);
    g.pass("use b").reads(b).modifies(x);
    g.pass("useless").writes(g.buffer("spare"));
    const std::string dot = dumpGraphviz(g.input, g.compile());
    EXPECT_EQ(dot.rfind("digraph plan {", 0), 0u);
    EXPECT_NE(dot.find("a \\\"quoted\\\" v1"), std::string::npos);
    EXPECT_NE(dot.find("back\\\\slash"), std::string::npos);
    EXPECT_NE(dot.find("shares with b"), std::string::npos);
    EXPECT_NE(dot.find("useless\\nculled: no root needs"), std::string::npos);
    EXPECT_NE(dot.find("spare\\nunused"), std::string::npos);
}

}  // namespace
}  // namespace helio::graph
