#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "framegraph/dump.h"
#include "framegraph_null_executor.h"

namespace tyndall::fg {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

struct Data {
    TextureHandle in, out;
};
constexpr auto kNothing = [](const Data&, PassContext&) {};

struct FrameGraphDump : ::testing::Test {
    NullExecutor executor;
    void SetUp() override {
        FrameGraphImpl& graph = executor.beginFrame();
        const TextureDesc color = texture2D(Format::RGBA16F, 8, 4);
        const Data& a = graph.addPass<Data>(
            "a", [&](Builder& b, Data& d) { d.out = b.create("a.color", color); }, kNothing);
        graph.addPass<Data>(
            "fog",
            [&](Builder& b, Data& d) { b.skip("no \"medium\""), d.out = b.create("fog", color); },
            kNothing);
        graph.addPass<Data>(
            "idle", [&](Builder& b, Data& d) { d.out = b.create("idle", color); }, kNothing);
        const Data& c = graph.addPass<Data>(
            "c",
            [&](Builder& b, Data& d) { d.in = b.read(a.out), d.out = b.create("c.color", color); },
            kNothing);
        graph.markOutput(c.out);
        executor.execute();
    }
};

TEST_F(FrameGraphDump, TextTellsStatusReasonBarriersAndBytes) {
    const std::string text = dump(executor.compiled, DumpFormat::Text);
    EXPECT_THAT(text,
                AllOf(HasSubstr("skipped fog (no \"medium\")"),
                      HasSubstr("culled  idle (nobody reads idle)"),
                      HasSubstr("barrier texture-fetch"), HasSubstr("read  a.color [sampled]")));
    EXPECT_THAT(text, HasSubstr("a.color: RGBA16F 8×4, 256 bytes, transient, passes 0–3, slot 0"));
    EXPECT_THAT(
        text,
        HasSubstr("c.color: RGBA16F 8×4, 256 bytes, transient, passes 3–end, slot 1, output"));
    EXPECT_THAT(text, HasSubstr("fog: RGBA16F 8×4, 256 bytes, transient, passes unused"));
}

TEST_F(FrameGraphDump, JsonSaysTheSame) {
    const nlohmann::json json = nlohmann::json::parse(dump(executor.compiled, DumpFormat::Json));
    ASSERT_EQ(json["passes"].size(), 4u);
    EXPECT_EQ(json["passes"][1]["status"], "skipped");
    EXPECT_EQ(json["passes"][1]["reason"], "no \"medium\"");
    EXPECT_EQ(json["passes"][3]["barriers"], "texture-fetch");
    const nlohmann::json& read = json["passes"][3]["uses"][0];
    EXPECT_EQ(read["access"], "sampled");
    EXPECT_EQ(json["resources"][read["resource"].get<size_t>()]["name"], "a.color")
        << "indices count from 0";
    EXPECT_EQ(json["resources"][0]["bytes"], 256);
    EXPECT_EQ(json["resources"][0]["last_pass"], 3);
    EXPECT_TRUE(json["resources"][1]["slot"].is_null());
    EXPECT_EQ(json["pooled_bytes"], 512);
    EXPECT_TRUE(json["errors"].empty());
}

TEST_F(FrameGraphDump, DotHasANodePerPassAndAnEdgePerUse) {
    const std::string dot = dump(executor.compiled, DumpFormat::Dot);
    EXPECT_THAT(dot, AllOf(HasSubstr("digraph"), HasSubstr("pass0 -> resource1"),
                           HasSubstr("resource1 -> pass3"),
                           HasSubstr("label=\"fog\\nskipped: no \\\"medium\\\"\""),
                           Not(HasSubstr("\\u000a"))));
}

TEST(DumpFormatNames, OnlyTheThreeAreTaken) {
    EXPECT_EQ(parseDumpFormat("dot").value(), DumpFormat::Dot);
    EXPECT_THAT(parseDumpFormat("yaml").message(),
                AllOf(HasSubstr("'yaml'"), HasSubstr("text, dot, json")));
}

} // namespace
} // namespace tyndall::fg
