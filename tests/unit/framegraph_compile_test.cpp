// Culling, skips and order.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "framegraph_null_executor.h"

namespace tyndall::fg {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Data {
    TextureHandle in, out;
};
constexpr auto kDispatch = [](const Data&, PassContext& c) { c.compute("x.comp").dispatch(1); };
const TextureDesc kColor = texture2D(Format::RGBA32F, 8, 4);

struct FrameGraphCompile : ::testing::Test {
    NullExecutor executor;
    FrameGraphImpl& graph = executor.beginFrame();

    TextureHandle produce(const char* name) {
        return graph
            .addPass<Data>(
                name, [&](Builder& b, Data& d) { d.out = b.create(name, kColor); }, kDispatch)
            .out;
    }
    TextureHandle filter(const char* name, TextureHandle in) {
        return graph
            .addPass<Data>(
                name,
                [&](Builder& b, Data& d) { d.in = b.read(in), d.out = b.create(name, kColor); },
                kDispatch)
            .out;
    }
    TextureHandle modify(const char* name, TextureHandle in, bool skipped = false) {
        return graph
            .addPass<Data>(
                name,
                [&](Builder& b, Data& d) {
                    d.out = b.write(in);
                    if (skipped) b.skip("no medium in the scene");
                },
                kDispatch)
            .out;
    }
    std::vector<std::string> ranNames() {
        std::vector<std::string> names;
        for (const CompiledPass& pass : executor.compiled.passes)
            if (pass.status == PassStatus::Ran) names.emplace_back(pass.name);
        return names;
    }
};

TEST_F(FrameGraphCompile, OnlyWhatTheOutputsNeedRunsInOrderOfDeclaration) {
    const TextureHandle a = produce("a"), unused = produce("unused");
    filter("unused.too", unused);
    graph.markOutput(filter("c", filter("b", a)));
    executor.execute();
    EXPECT_THAT(ranNames(), ElementsAre("a", "b", "c"));
    EXPECT_THAT(executor.calls,
                ElementsAre("a: compute x.comp", "a: dispatch 1 1 1", "b: compute x.comp",
                            "b: dispatch 1 1 1", "c: compute x.comp", "c: dispatch 1 1 1"));
    EXPECT_EQ(statusOf(executor.compiled, "unused"), PassStatus::Culled);
    EXPECT_EQ(passNamed(executor.compiled, "unused").reason,
              "only passes that do not run read what it writes");
    EXPECT_EQ(passNamed(executor.compiled, "unused.too").reason, "nobody reads unused.too");
}

TEST_F(FrameGraphCompile, NothingIsNeededWithoutOutputsUnlessItHasSideEffects) {
    const TextureHandle a = produce("a");
    graph.addPass<Data>(
        "readback", [&](Builder& b, Data& d) { d.in = b.read(a), b.sideEffect(); }, kDispatch);
    produce("b");
    executor.execute();
    EXPECT_THAT(ranNames(), ElementsAre("a", "readback"));
}

TEST_F(FrameGraphCompile, AWriteNeedsWhatItDoesNotWriteOver) {
    graph.markOutput(modify("second", produce("first")));
    executor.execute();
    EXPECT_THAT(ranNames(), ElementsAre("first", "second"));
}

TEST_F(FrameGraphCompile, LaterWritesThatNobodyReadsAreCulledFromTheEnd) {
    const TextureHandle first = produce("first");
    graph.markOutput(first);
    modify("second", first);
    executor.execute();
    EXPECT_THAT(ranNames(), ElementsAre("first"));
}

TEST_F(FrameGraphCompile, WritesToWhatOutlivesTheFrameAreNeverCulled) {
    const PersistentTexture sum = graph.persistentTexture("sum", kColor);
    modify("accumulate", sum.handle);
    const TextureHandle import = graph.importTexture("import", StaticTexture{7}, kColor, 1);
    modify("change", import);
    executor.execute();
    EXPECT_THAT(ranNames(), ElementsAre("accumulate", "change"));
}

TEST_F(FrameGraphCompile, ASkippedPassLeavesTheContentBefore) {
    const TextureHandle skipped = modify("fog", produce("color"), true);
    graph.markOutput(filter("tonemap", skipped));
    executor.execute();
    EXPECT_THAT(ranNames(), ElementsAre("color", "tonemap"));
    EXPECT_EQ(statusOf(executor.compiled, "fog"), PassStatus::Skipped);
    EXPECT_EQ(passNamed(executor.compiled, "fog").reason, "no medium in the scene");
}

TEST_F(FrameGraphCompile, InputsOfASkippedPassAreNotMade) {
    const TextureHandle costly = produce("costly");
    const Data& skipped = graph.addPass<Data>(
        "skipped",
        [&](Builder& b, Data& d) {
            b.skip("no"), d.in = b.read(costly), d.out = b.create("s", kColor);
        },
        kDispatch);
    graph.markOutput(filter("reader", skipped.out));
    executor.execute();
    EXPECT_THAT(ranNames(), ElementsAre("reader"));
    EXPECT_TRUE(graph.isAbsent(skipped.out));
    EXPECT_FALSE(resourceNamed(executor.compiled, "s").used) << "an absent resource has no storage";
}

TEST_F(FrameGraphCompile, WritingOverSomethingAbsentStartsFromNothing) {
    const Data& skipped = graph.addPass<Data>(
        "skipped", [&](Builder& b, Data& d) { b.skip("no"), d.out = b.create("s", kColor); },
        kDispatch);
    graph.markOutput(modify("late", skipped.out));
    executor.execute();
    const CompiledResource& s = resourceNamed(executor.compiled, "s");
    EXPECT_TRUE(s.clearFirst);
    EXPECT_EQ(s.firstPass, 1u);
}

TEST_F(FrameGraphCompile, ErrorsKeepTheGraphFromRunning) {
    const TextureHandle a = produce("a");
    modify("b", a);
    modify("c", a);
    graph.markOutput(a);
    executor.execute();
    EXPECT_EQ(executor.compiled.errors.size(), 1u);
    EXPECT_TRUE(executor.calls.empty());
}

TEST_F(FrameGraphCompile, HistoryAdvancesOnlyWhenItIsWritten) {
    const auto frame = [&](bool write) {
        executor.beginFrame();
        const TextureHistory h = graph.historyTexture("h", kColor);
        graph.addPass<Data>(
            "use", [&](Builder& b, Data& d) { d.in = b.read(h.previous), b.sideEffect(); },
            kDispatch);
        const TextureHandle current = modify("update", h.current, !write);
        graph.addPass<Data>(
            "show", [&](Builder& b, Data& d) { d.in = b.read(current), b.sideEffect(); },
            kDispatch);
        executor.execute();
        EXPECT_TRUE(executor.compiled.errors.empty());
        return h.wasReset;
    };
    const auto half = [&](const char* name) {
        return resourceNamed(executor.compiled, name).persistent;
    };
    EXPECT_TRUE(frame(false)) << "nothing yet";
    EXPECT_TRUE(resourceNamed(executor.compiled, "h.previous").clearFirst);
    EXPECT_NE(resourceNamed(executor.compiled, "h").aliasOf, kNoIndex) << "reads as the previous";
    EXPECT_TRUE(frame(true)) << "a skipped writer does not count";
    const uint32_t written = half("h");
    EXPECT_FALSE(frame(true));
    EXPECT_EQ(half("h.previous"), written) << "what was current is now the past";
    const uint32_t second = half("h");
    EXPECT_NE(second, written);
    EXPECT_FALSE(frame(false));
    EXPECT_EQ(half("h.previous"), second);
    EXPECT_FALSE(frame(true));
    EXPECT_EQ(half("h.previous"), second) << "not advanced by the frame that skipped";
    executor.persistent.resetHistory();
    EXPECT_TRUE(frame(true));
}

TEST_F(FrameGraphCompile, ReadingThePastMakesTheNextPast) {
    const auto frame = [&](bool readsPrevious) {
        executor.beginFrame();
        const TextureHistory h = graph.historyTexture("h", kColor);
        if (readsPrevious)
            graph.addPass<Data>(
                "use", [&](Builder& b, Data& d) { d.in = b.read(h.previous), b.sideEffect(); },
                kDispatch);
        modify("update", h.current);
        executor.execute();
        return statusOf(executor.compiled, "update");
    };
    EXPECT_EQ(frame(false), PassStatus::Culled);
    EXPECT_EQ(frame(true), PassStatus::Ran);
}

TEST_F(FrameGraphCompile, ResourcesThatOutliveTheFrameStartAnewWhenTheirSizeChanges) {
    const auto wasReset = [&](int width) {
        executor.beginFrame();
        const PersistentTexture p = graph.persistentTexture("p", texture2D(Format::R32F, width, 4));
        modify("update", p.handle);
        executor.execute();
        return p.wasReset;
    };
    EXPECT_TRUE(wasReset(4));
    EXPECT_FALSE(wasReset(4));
    EXPECT_TRUE(wasReset(8));
    EXPECT_FALSE(wasReset(8));
    for (uint64_t i = 0; i <= PersistentTable::kFramesKept; ++i)
        executor.beginFrame(), executor.execute();
    EXPECT_TRUE(wasReset(8)) << "forgotten when nobody asks for it";
}

TEST_F(FrameGraphCompile, SkipsAndCullingAgreeWithAWalkFromTheOutputsOnRandomGraphs) {
    // An independent statement of what must run: a pass is needed when an output, or a needed pass, uses what it made.
    uint32_t state = 12345;
    const auto random = [&](uint32_t n) {
        return (state = state * 1664525u + 1013904223u) / 65536u % n;
    };
    for (int trial = 0; trial < 50; ++trial) {
        executor.beginFrame();
        const uint32_t count = 2 + random(30);
        std::vector<TextureHandle> made;
        std::vector<std::vector<uint32_t>> inputs(count);
        std::vector<bool> skipped(count), needed(count);
        for (uint32_t i = 0; i < count; ++i) {
            skipped[i] = random(5) == 0;
            for (uint32_t k = i == 0 ? 0 : random(3); k > 0; --k) inputs[i].push_back(random(i));
            const std::string name = "p" + std::to_string(i);
            made.push_back(graph
                               .addPass<Data>(
                                   name.c_str(),
                                   [&](Builder& b, Data& d) {
                                       for (const uint32_t input : inputs[i])
                                           d.in = b.read(made[input]);
                                       if (skipped[i]) b.skip("random");
                                       d.out = b.create(name.c_str(), kColor);
                                   },
                                   kDispatch)
                               .out);
        }
        const uint32_t output = random(count);
        graph.markOutput(made[output]);
        needed[output] = true;
        for (uint32_t i = count; i-- > 0;)
            if (needed[i] && !skipped[i])
                for (const uint32_t input : inputs[i]) needed[input] = true;
        executor.execute();
        for (uint32_t i = 0; i < count; ++i)
            ASSERT_EQ(executor.compiled.passes[i].status, skipped[i]  ? PassStatus::Skipped
                                                          : needed[i] ? PassStatus::Ran
                                                                      : PassStatus::Culled)
                << "trial " << trial << ", pass " << i;
    }
}

TEST_F(FrameGraphCompile, ThousandPassesCompileQuickly) {
    double best = 1e9;
    for (int repeat = 0; repeat < 20; ++repeat) {
        executor.beginFrame();
        TextureHandle color = produce("start");
        for (int i = 0; i < 999; ++i) color = filter("filter", color);
        graph.markOutput(color);
        const auto start = std::chrono::steady_clock::now();
        executor.compile();
        best = std::min(best, std::chrono::duration<double, std::milli>(
                                  std::chrono::steady_clock::now() - start)
                                  .count());
    }
    EXPECT_EQ(executor.compiled.slots.size(), 2u) << "two textures take turns";
    std::printf("1000 passes compile in %.3f ms, %.4f ms per 50 passes\n", best, best / 20);
}

} // namespace
} // namespace tyndall::fg
