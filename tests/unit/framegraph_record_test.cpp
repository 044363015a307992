// What the recorder itself promises: versions, absence, and sentences for every misuse.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "framegraph_null_executor.h"

namespace tyndall::fg {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct Data {
    TextureHandle in, out;
    BufferHandle buffer;
};
constexpr auto kNothing = [](const Data&, PassContext&) {};
const TextureDesc kColor = texture2D(Format::RGBA32F, 8, 4);

struct FrameGraphRecord : ::testing::Test {
    NullExecutor executor;
    FrameGraphImpl& graph = executor.beginFrame();

    TextureHandle produce(const char* name, bool skipped = false) {
        return graph
            .addPass<Data>(
                name,
                [&](Builder& b, Data& d) {
                    if (skipped) b.skip("not needed");
                    d.out = b.create(name, kColor);
                },
                kNothing)
            .out;
    }
    /// Compiles and returns the only error.
    std::string onlyError() {
        executor.compile();
        EXPECT_EQ(executor.compiled.errors.size(), 1u);
        return executor.compiled.errors.empty() ? std::string() : executor.compiled.errors[0];
    }
};

TEST_F(FrameGraphRecord, AWriteMakesTheNextVersionAndKeepsTheResource) {
    const TextureHandle first = produce("x");
    const Data& second = graph.addPass<Data>(
        "again", [&](Builder& b, Data& d) { d.out = b.write(first); }, kNothing);
    EXPECT_EQ(first.version, 1u);
    EXPECT_EQ(second.out.resource, first.resource);
    EXPECT_EQ(second.out.version, 2u);
    EXPECT_EQ(graph.desc(second.out), kColor);
}

TEST_F(FrameGraphRecord, WhatASkippedPassCreatesIsAbsentAtOnce) {
    const TextureHandle there = produce("there"), gone = produce("gone", true);
    EXPECT_FALSE(graph.isAbsent(there));
    EXPECT_TRUE(graph.isAbsent(gone));
    EXPECT_TRUE(graph.isAbsent(TextureHandle{})) << "nothing is there under a null handle";
}

TEST_F(FrameGraphRecord, ASkippedWriteIsPresentExactlyWhereTheContentBeforeWas) {
    const auto skippedWrite = [&](TextureHandle h) {
        return graph
            .addPass<Data>(
                "skipped", [&](Builder& b, Data& d) { d.out = b.write(h), b.skip("no"); }, kNothing)
            .out;
    };
    EXPECT_FALSE(graph.isAbsent(skippedWrite(produce("a"))));
    const TextureHandle absent = skippedWrite(produce("b", true));
    EXPECT_TRUE(graph.isAbsent(absent));
    const Data& later = graph.addPass<Data>(
        "later", [&](Builder& b, Data& d) { d.out = b.write(absent); }, kNothing);
    EXPECT_FALSE(graph.isAbsent(later.out));
    EXPECT_TRUE(graph.isAbsent(absent)) << "the old handle still means the old state";
}

TEST_F(FrameGraphRecord, ReadingWhatASkippedPassLeftIsLegal) {
    const TextureHandle x = produce("x");
    graph.addPass<Data>(
        "skipped", [&](Builder& b, Data& d) { d.out = b.write(x), b.skip("no"); }, kNothing);
    graph.addPass<Data>(
        "reader", [&](Builder& b, Data& d) { d.in = b.read(x), b.sideEffect(); }, kNothing);
    executor.compile();
    EXPECT_TRUE(executor.compiled.errors.empty());
}

TEST_F(FrameGraphRecord, TwoWritersOfOneVersionAreNamedWithTheirPlaces) {
    const TextureHandle x = produce("x");
    graph.addPass<Data>(
        "first", [&](Builder& b, Data& d) { d.out = b.write(x); }, kNothing);
    graph.addPass<Data>(
        "second", [&](Builder& b, Data& d) { d.out = b.write(x); }, kNothing);
    EXPECT_THAT(onlyError(),
                AllOf(HasSubstr("'first'"), HasSubstr("'second'"), HasSubstr("version 1 of 'x'"),
                      HasSubstr("tests/unit/framegraph_record_test.cpp:")));
}

TEST_F(FrameGraphRecord, AStaleHandleIsRefused) {
    const TextureHandle x = produce("x");
    graph.addPass<Data>(
        "over", [&](Builder& b, Data& d) { d.out = b.write(x); }, kNothing);
    graph.addPass<Data>(
        "late", [&](Builder& b, Data& d) { d.in = b.read(x); }, kNothing);
    EXPECT_THAT(onlyError(), AllOf(HasSubstr("pass 'late' reads version 1 of 'x'"),
                                   HasSubstr("pass 'over' has written over it")));
}

TEST_F(FrameGraphRecord, OnePassMayReadWhatItWritesOverWhenItDeclaresBoth) {
    const TextureHandle x = produce("x");
    graph.addPass<Data>(
        "inplace",
        [&](Builder& b, Data& d) { d.out = b.write(x), d.in = b.read(x, Access::StorageRead); },
        kNothing);
    executor.compile();
    EXPECT_TRUE(executor.compiled.errors.empty());
}

TEST_F(FrameGraphRecord, HistoryThatNobodyWroteCannotBeReadAsCurrent) {
    const TextureHistory history = graph.historyTexture("h", kColor);
    graph.addPass<Data>(
        "reader", [&](Builder& b, Data& d) { d.in = b.read(history.current); }, kNothing);
    EXPECT_THAT(onlyError(),
                AllOf(HasSubstr("pass 'reader' reads 'h'"), HasSubstr("no pass has written")));
}

TEST_F(FrameGraphRecord, HandlesOfOtherFramesAndNullHandlesAreRefused) {
    const TextureHandle old = produce("x");
    executor.beginFrame();
    graph.addPass<Data>(
        "reader", [&](Builder& b, Data& d) { d.in = b.read(old); }, kNothing);
    EXPECT_THAT(onlyError(), HasSubstr("handles end with their frame"));
    executor.beginFrame();
    graph.addPass<Data>(
        "reader", [&](Builder& b, Data& d) { d.in = b.read(TextureHandle{}); }, kNothing);
    EXPECT_THAT(onlyError(), HasSubstr("pass 'reader' reads a null handle"));
}

TEST_F(FrameGraphRecord, RenderingToATextureThatIsSampledIsRefused) {
    const TextureHandle x = produce("x");
    graph.addPass<Data>(
        "loop",
        [&](Builder& b, Data& d) {
            d.in = b.read(x, Access::Sampled), d.out = b.write(x, Access::ColorTarget);
        },
        kNothing);
    EXPECT_THAT(onlyError(),
                AllOf(HasSubstr("pass 'loop' reads 'x' as sampled"), HasSubstr("renders to it")));
}

TEST_F(FrameGraphRecord, AccessesMustSuitTheResource) {
    graph.addPass<Data>(
        "a", [](Builder& b, Data& d) { d.out = b.create("color", kColor, Access::DepthTarget); },
        kNothing);
    graph.addPass<Data>(
        "b",
        [](Builder& b, Data& d) { d.out = b.create("depth", texture2D(Format::Depth32F, 4, 4)); },
        kNothing);
    graph.addPass<Data>(
        "c",
        [](Builder& b, Data& d) {
            d.buffer = b.create("buffer", BufferDesc{16}, Access::ColorTarget);
        },
        kNothing);
    graph.addPass<Data>(
        "d", [](Builder& b, Data& d) { d.out = b.create("read", kColor, Access::Sampled); },
        kNothing);
    executor.compile();
    ASSERT_EQ(executor.compiled.errors.size(), 4u) << "errors are collected, not only the first";
    EXPECT_THAT(executor.compiled.errors[0],
                AllOf(HasSubstr("'color' as depth target"), HasSubstr("Depth32F")));
    EXPECT_THAT(executor.compiled.errors[1],
                AllOf(HasSubstr("'depth' as storage write"), HasSubstr("depth format")));
    EXPECT_THAT(executor.compiled.errors[2],
                AllOf(HasSubstr("'buffer' as color target"), HasSubstr("needs a texture")));
    EXPECT_THAT(executor.compiled.errors[3], HasSubstr("is an access that reads"));
}

TEST_F(FrameGraphRecord, ImpossibleSizesAreRefused) {
    TextureDesc tooManyMips = kColor; // 8×4 has levels of 8, 4, 2 and 1
    tooManyMips.mips = 5;
    graph.addPass<Data>(
        "a", [](Builder& b, Data& d) { d.out = b.create("flat", texture2D(Format::R8, 0, 4)); },
        kNothing);
    graph.addPass<Data>(
        "b", [&](Builder& b, Data& d) { d.out = b.create("deep", tooManyMips); }, kNothing);
    graph.addPass<Data>(
        "c", [](Builder& b, Data& d) { d.buffer = b.create("none", BufferDesc{}); }, kNothing);
    executor.compile();
    ASSERT_EQ(executor.compiled.errors.size(), 3u);
    EXPECT_THAT(executor.compiled.errors[0], HasSubstr("'flat' is 0×4"));
    EXPECT_THAT(executor.compiled.errors[1], HasSubstr("has 5 mips"));
    EXPECT_THAT(executor.compiled.errors[2], HasSubstr("'none' has no bytes"));
    executor.beginFrame();
    tooManyMips.mips = 4;
    graph.addPass<Data>(
        "b", [&](Builder& b, Data& d) { d.out = b.create("deep", tooManyMips); }, kNothing);
    executor.compile();
    EXPECT_TRUE(executor.compiled.errors.empty()) << "a full chain is legal";
}

TEST_F(FrameGraphRecord, BindingWhatWasNotDeclaredIsNamed) {
    const TextureHandle x = produce("x"), y = produce("y");
    const Data& pass = graph.addPass<Data>(
        "user", [&](Builder& b, Data& d) { d.in = b.read(x), d.out = b.create("z", kColor); },
        kNothing);
    const uint32_t user = 2;
    EXPECT_EQ(checkTouch(graph, user, x.resource, x.version, Touch::Sample, "image"), "");
    EXPECT_EQ(checkTouch(graph, user, pass.out.resource, 1, Touch::WriteStorage, "target"), "");
    EXPECT_THAT(checkTouch(graph, user, y.resource, y.version, Touch::Sample, "noise"),
                AllOf(HasSubstr("pass 'user'"), HasSubstr("'y'"), HasSubstr("'noise'"),
                      HasSubstr("without having declared")));
    EXPECT_THAT(checkTouch(graph, user, x.resource, x.version, Touch::WriteStorage, "image"),
                HasSubstr("needs a write as storage write"));
    EXPECT_THAT(checkTouch(graph, user, pass.out.resource, 1, Touch::Sample, "image"),
                HasSubstr("declared it otherwise"));
    EXPECT_THAT(checkTouch(graph, user, 0, 0, Touch::Sample, "image"), HasSubstr("null handle"));
}

TEST_F(FrameGraphRecord, AWriteMayBeBoundByTheHandleBeforeOrAfter) {
    const TextureHandle x = produce("x");
    const Data& pass = graph.addPass<Data>(
        "user", [&](Builder& b, Data& d) { d.out = b.write(x); }, kNothing);
    EXPECT_EQ(checkTouch(graph, 1, x.resource, x.version, Touch::WriteStorage, "image"), "");
    EXPECT_EQ(checkTouch(graph, 1, x.resource, pass.out.version, Touch::WriteStorage, "image"), "");
}

TEST_F(FrameGraphRecord, FindTextureGivesTheNewestVersionByName) {
    const TextureHandle x = produce("x");
    const Data& pass = graph.addPass<Data>(
        "user", [&](Builder& b, Data& d) { d.out = b.write(x); }, kNothing);
    EXPECT_EQ(graph.findTexture("x"), pass.out);
    EXPECT_FALSE(graph.findTexture("nothing"));
    const TextureHistory history = graph.historyTexture("h", kColor);
    EXPECT_EQ(graph.findTexture("h"), history.previous) << "nothing else can be read yet";
}

TEST_F(FrameGraphRecord, PassesCannotNestAndAFailedSetupDoesNotPoisonTheNextFrame) {
    EXPECT_THROW(graph.addPass<Data>(
                     "outer", [&](Builder&, Data&) { produce("inner"); }, kNothing),
                 CheckFailure);
    executor.beginFrame();
    produce("fine");
    executor.compile();
    EXPECT_TRUE(executor.compiled.errors.empty());
}

TEST(ResourceDesc, BytesFollowTheSizesOfTheLevels) {
    TextureDesc d = texture2D(Format::RGBA16F, 8, 4);
    d.mips = 4; // 8×4 + 4×2 + 2×1 + 1×1 texels of 8 bytes
    EXPECT_EQ(byteSize(d), (32u + 8u + 2u + 1u) * 8u);
    TextureDesc volume = texture3D(Format::R32F, 4, 4, 4);
    volume.mips = 3;
    EXPECT_EQ(byteSize(volume), (64u + 8u + 1u) * 4u);
    TextureDesc array = texture2DArray(Format::Depth32F, 4, 4, 3);
    array.mips = 2;
    EXPECT_EQ(byteSize(array), (48u + 12u) * 4u) << "layers do not shrink";
}

} // namespace
} // namespace tyndall::fg
