// Cached passes: run when an input or the key changed, and only then.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "framegraph_null_executor.h"

namespace tyndall::fg {
namespace {

struct Data {
    TextureHandle in, out;
};
constexpr auto kDispatch = [](const Data&, PassContext& c) { c.compute("x.comp").dispatch(1); };
const TextureDesc kColor = texture2D(Format::RGBA32F, 8, 4);

struct FrameGraphCache : ::testing::Test {
    NullExecutor executor;
    FrameGraphImpl& graph = executor.graph;

    TextureHandle cached(const char* name, uint64_t key, TextureHandle in = {},
                         const TextureDesc& desc = kColor) {
        return graph
            .addPass<Data>(
                name,
                [&](Builder& b, Data& d) {
                    if (in) d.in = b.read(in);
                    d.out = b.create(name, desc);
                    b.cacheBy(key);
                },
                kDispatch)
            .out;
    }
    TextureHandle cachedWrite(const char* name, uint64_t key, TextureHandle over) {
        return graph
            .addPass<Data>(
                name, [&](Builder& b, Data& d) { d.out = b.write(over), b.cacheBy(key); },
                kDispatch)
            .out;
    }
    void show(TextureHandle in, const char* name = "show") {
        graph.addPass<Data>(
            name, [&](Builder& b, Data& d) { d.in = b.read(in), b.sideEffect(); }, kDispatch);
    }
    PassStatus status(const char* name) { return statusOf(executor.compiled, name); }
};

TEST_F(FrameGraphCache, RunsOnceAndAgainWhenItsKeyChanges) {
    const auto frame = [&](uint64_t key) {
        executor.beginFrame();
        show(cached("table", key));
        executor.execute();
        return status("table");
    };
    EXPECT_EQ(frame(1), PassStatus::Ran);
    EXPECT_EQ(frame(1), PassStatus::Cached);
    EXPECT_EQ(passNamed(executor.compiled, "table").reason, "its inputs did not change");
    EXPECT_EQ(resourceNamed(executor.compiled, "table").origin, ResourceOrigin::Kept);
    EXPECT_EQ(frame(2), PassStatus::Ran);
    EXPECT_EQ(frame(2), PassStatus::Cached);
    EXPECT_EQ(frame(1), PassStatus::Ran) << "only the last result is kept";
    executor.persistent.forgetResults();
    EXPECT_EQ(frame(1), PassStatus::Ran);
}

TEST_F(FrameGraphCache, AChangedInputContentOrShapeRunsItAgain) {
    const auto frame = [&](uint64_t version, int width = 8) {
        executor.beginFrame();
        const TextureHandle input = graph.importTexture("input", StaticTexture{3}, kColor, version);
        show(cached("made", 0, input, texture2D(Format::R32F, width, 4)));
        executor.execute();
        return status("made");
    };
    EXPECT_EQ(frame(1), PassStatus::Ran);
    EXPECT_EQ(frame(1), PassStatus::Cached);
    EXPECT_EQ(frame(2), PassStatus::Ran);
    EXPECT_EQ(frame(2, 16), PassStatus::Ran);
    EXPECT_EQ(frame(2, 16), PassStatus::Cached);
}

TEST_F(FrameGraphCache, WhatOrdinaryPassesWriteIsNewInEveryFrame) {
    for (int i = 0; i < 3; ++i) {
        executor.beginFrame();
        const Data& fresh = graph.addPass<Data>(
            "fresh", [](Builder& b, Data& d) { d.out = b.create("f", kColor); }, kDispatch);
        show(cached("made", 0, fresh.out));
        executor.execute();
        EXPECT_EQ(status("made"), PassStatus::Ran);
    }
}

TEST_F(FrameGraphCache, ACachedPassDoesNotDemandItsInputs) {
    const auto frame = [&](uint64_t sourceKey, uint64_t version) {
        executor.beginFrame();
        const TextureHandle import =
            graph.importTexture("import", StaticTexture{3}, kColor, version);
        show(cached("made", 0, cached("source", sourceKey, import)));
        executor.execute();
    };
    frame(1, 1);
    EXPECT_EQ(status("source"), PassStatus::Ran);
    EXPECT_EQ(status("made"), PassStatus::Ran);
    frame(1, 1);
    EXPECT_EQ(status("source"), PassStatus::Cached);
    EXPECT_EQ(status("made"), PassStatus::Cached);
    frame(2, 1);
    EXPECT_EQ(status("source"), PassStatus::Ran);
    EXPECT_EQ(status("made"), PassStatus::Ran) << "a change travels down the chain";
    frame(2, 2);
    EXPECT_EQ(status("made"), PassStatus::Ran);
}

TEST_F(FrameGraphCache, AnInputWhoseOwnResultIsGoneIsNotMadeForACachedReader) {
    const auto frame = [&](bool writeOver) {
        executor.beginFrame();
        const TextureHandle source = cached("source", 1);
        show(cached("made", 0, source));
        if (writeOver)
            show(graph
                     .addPass<Data>(
                         "over", [&](Builder& b, Data& d) { d.out = b.write(source); }, kDispatch)
                     .out,
                 "show2");
        executor.execute();
    };
    frame(true);
    frame(false);
    EXPECT_EQ(status("made"), PassStatus::Cached);
    EXPECT_EQ(status("source"), PassStatus::Culled);
    EXPECT_EQ(passNamed(executor.compiled, "source").reason,
              "only cached passes read what it writes");
}

TEST_F(FrameGraphCache, SkippingAnInputIsAChange) {
    const auto frame = [&](bool skipped) {
        executor.beginFrame();
        const Data& source = graph.addPass<Data>(
            "source",
            [&](Builder& b, Data& d) {
                d.out = b.create("s", kColor);
                b.cacheBy(1);
                if (skipped) b.skip("no");
            },
            kDispatch);
        show(cached("made", 0, source.out));
        executor.execute();
        return status("made");
    };
    EXPECT_EQ(frame(false), PassStatus::Ran);
    EXPECT_EQ(frame(false), PassStatus::Cached);
    EXPECT_EQ(frame(true), PassStatus::Ran);
    EXPECT_EQ(frame(true), PassStatus::Cached);
    EXPECT_EQ(frame(false), PassStatus::Ran);
}

TEST_F(FrameGraphCache, WritersOfOneResourceAreCachedTogetherOrNotAtAll) {
    const auto frame = [&](uint64_t first, uint64_t second) {
        executor.beginFrame();
        show(cachedWrite("second", second, cached("first", first)));
        executor.execute();
    };
    frame(1, 1);
    frame(1, 1);
    EXPECT_EQ(status("first"), PassStatus::Cached);
    EXPECT_EQ(status("second"), PassStatus::Cached);
    frame(1, 2);
    EXPECT_EQ(status("first"), PassStatus::Ran)
        << "its content was written over: it must be made again";
    EXPECT_EQ(status("second"), PassStatus::Ran);
    frame(1, 2);
    EXPECT_EQ(status("first"), PassStatus::Cached);
}

TEST_F(FrameGraphCache, AStateInBetweenThatARunningPassReadsIsMadeAgain) {
    const auto frame = [&](bool between) {
        executor.beginFrame();
        const TextureHandle first = cached("first", 1);
        if (between) show(first, "peek");
        show(cachedWrite("second", 1, first));
        executor.execute();
    };
    frame(true);
    frame(true);
    EXPECT_EQ(status("first"), PassStatus::Ran);
    EXPECT_EQ(status("second"), PassStatus::Ran);
    frame(false);
    EXPECT_EQ(status("second"), PassStatus::Cached);
}

TEST_F(FrameGraphCache, AnOrdinaryWriterSpoilsTheResultForTheNextFrame) {
    for (int i = 0; i < 2; ++i) {
        executor.beginFrame();
        const TextureHandle made = cached("made", 1);
        const Data& over = graph.addPass<Data>(
            "over", [&](Builder& b, Data& d) { d.out = b.write(made); }, kDispatch);
        show(over.out);
        executor.execute();
        EXPECT_EQ(status("made"), PassStatus::Ran);
    }
}

TEST_F(FrameGraphCache, PassesOfOneNameKeepTheirOwnResults) {
    const auto frame = [&](uint64_t secondKey) {
        executor.beginFrame();
        const TextureHandle a = cached("same", 1), b = cached("same", secondKey);
        show(a), show(b, "show2");
        executor.execute();
    };
    frame(2);
    frame(3);
    EXPECT_EQ(executor.compiled.passes[0].status, PassStatus::Cached);
    EXPECT_EQ(executor.compiled.passes[1].status, PassStatus::Ran);
    EXPECT_NE(executor.compiled.resources[1].persistent, executor.compiled.resources[2].persistent);
}

TEST_F(FrameGraphCache, PersistentResourcesCanHoldACachedResult) {
    const auto frame = [&](uint64_t key) {
        executor.beginFrame();
        const PersistentTexture atlas = graph.persistentTexture("atlas", kColor);
        show(cachedWrite("fill", key, atlas.handle));
        executor.execute();
        return status("fill");
    };
    EXPECT_EQ(frame(1), PassStatus::Ran);
    EXPECT_EQ(frame(1), PassStatus::Cached);
    EXPECT_EQ(frame(2), PassStatus::Ran);
    executor.persistent.resetHistory();
    EXPECT_EQ(frame(2), PassStatus::Ran) << "a reset resource holds nothing";
}

TEST_F(FrameGraphCache, AccumulatingPassesAreNeverCached) {
    for (int i = 0; i < 3; ++i) {
        executor.beginFrame();
        const PersistentTexture sum = graph.persistentTexture("sum", kColor);
        graph.addPass<Data>(
            "add",
            [&](Builder& b, Data& d) {
                d.in = b.read(sum.handle, Access::StorageRead);
                d.out = b.write(sum.handle);
                b.cacheBy(1);
            },
            kDispatch);
        executor.execute();
        EXPECT_EQ(status("add"), PassStatus::Ran)
            << "its input is what it wrote in the frame before";
    }
}

TEST_F(FrameGraphCache, AResultThatNobodyAsksForIsGivenUp) {
    executor.beginFrame();
    show(cached("made", 1));
    executor.execute();
    for (uint64_t i = 0; i <= PersistentTable::kFramesKept; ++i)
        executor.beginFrame(), executor.execute();
    for (const PersistentEntry& entry : executor.persistent.entries()) EXPECT_FALSE(entry.alive);
    executor.beginFrame();
    show(cached("made", 1));
    executor.execute();
    EXPECT_EQ(status("made"), PassStatus::Ran);
}

TEST_F(FrameGraphCache, ACachedResultThatIsNotNeededIsCulled) {
    const auto frame = [&](bool needed) {
        executor.beginFrame();
        const TextureHandle made = cached("made", 1);
        if (needed) show(made);
        executor.execute();
        return status("made");
    };
    EXPECT_EQ(frame(true), PassStatus::Ran);
    EXPECT_EQ(frame(false), PassStatus::Culled);
    EXPECT_EQ(frame(true), PassStatus::Cached) << "still there after a frame that did not want it";
}

} // namespace
} // namespace tyndall::fg
