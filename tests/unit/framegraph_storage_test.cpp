// Lifetimes, shared storage and barriers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "framegraph_null_executor.h"

namespace tyndall::fg {
namespace {

struct Data {
    TextureHandle in, out;
    BufferHandle bufferIn, bufferOut;
};
constexpr auto kNothing = [](const Data&, PassContext&) {};
const TextureDesc kColor = texture2D(Format::RGBA32F, 8, 4); // 512 bytes

// Values of the OpenGL 4.5 registry.
constexpr uint32_t GL_TEXTURE_FETCH = 0x8, GL_SHADER_IMAGE = 0x20, GL_COMMAND = 0x40,
                   GL_UNIFORM = 0x4, GL_VERTEX = 0x1, GL_ELEMENT = 0x2, GL_TEXTURE_UPDATE = 0x100,
                   GL_BUFFER_UPDATE = 0x200, GL_FRAMEBUFFER = 0x400, GL_TRANSFORM_FEEDBACK = 0x800,
                   GL_SHADER_STORAGE = 0x2000, GL_QUERY_BUFFER = 0x8000;

struct FrameGraphStorage : ::testing::Test {
    NullExecutor executor;
    FrameGraphImpl& graph = executor.beginFrame();

    TextureHandle produce(const char* name, const TextureDesc& desc = kColor,
                          Access access = Access::StorageWrite) {
        return graph
            .addPass<Data>(
                name, [&](Builder& b, Data& d) { d.out = b.create(name, desc, access); }, kNothing)
            .out;
    }
    TextureHandle filter(const char* name, TextureHandle in, Access access = Access::Sampled,
                         Access output = Access::StorageWrite) {
        return graph
            .addPass<Data>(
                name,
                [&](Builder& b, Data& d) {
                    d.in = b.read(in, access), d.out = b.create(name, kColor, output);
                },
                kNothing)
            .out;
    }
    uint32_t slot(const char* name) { return resourceNamed(executor.compiled, name).slot; }
    uint32_t barriers(const char* pass) { return passNamed(executor.compiled, pass).barriers; }
};

TEST_F(FrameGraphStorage, ResourcesOfOneShapeShareStorageWhenTheyDoNotOverlap) {
    graph.markOutput(filter("d", filter("c", filter("b", produce("a")))));
    executor.execute();
    EXPECT_EQ(slot("a"), slot("c"));
    EXPECT_EQ(slot("b"), slot("d"));
    EXPECT_NE(slot("a"), slot("b")) << "b is written while a is read";
    EXPECT_EQ(executor.compiled.pooledBytes(), 2u * 512u);
    EXPECT_EQ(executor.compiled.unpooledBytes(), 4u * 512u);
}

TEST_F(FrameGraphStorage, DifferentShapesDoNotShare) {
    TextureHandle color = produce("a");
    color = filter("b", color);
    const Data& other = graph.addPass<Data>(
        "c",
        [&](Builder& b, Data& d) {
            d.in = b.read(color), d.out = b.create("c", texture2D(Format::RGBA16F, 8, 4));
        },
        kNothing);
    graph.markOutput(other.out);
    executor.execute();
    EXPECT_EQ(executor.compiled.slots.size(), 3u);
}

TEST_F(FrameGraphStorage, LifetimesRunFromTheFirstToTheLastRunningUser) {
    const TextureHandle a = produce("a");
    filter("culled", a);
    const TextureHandle b = filter("b", a);
    graph.markOutput(b);
    filter("culled.late", a);
    executor.execute();
    const CompiledResource& resource = resourceNamed(executor.compiled, "a");
    EXPECT_EQ(resource.firstPass, 0u);
    EXPECT_EQ(resource.lastPass, 2u);
    EXPECT_EQ(resourceNamed(executor.compiled, "b").lastPass, executor.compiled.passes.size())
        << "outputs live to the end";
}

TEST_F(FrameGraphStorage, NoTwoLivingResourcesShareStorageOnRandomGraphs) {
    uint32_t state = 99;
    const auto random = [&](uint32_t n) {
        return (state = state * 1664525u + 1013904223u) / 65536u % n;
    };
    for (int trial = 0; trial < 50; ++trial) {
        executor.beginFrame();
        std::vector<TextureHandle> made{produce("first")};
        for (uint32_t i = 1; i < 25; ++i) {
            const TextureHandle in = made[random(uint32_t(made.size()))];
            const TextureDesc desc = texture2D(Format::R32F, 4 + int(random(2)), 4);
            made.push_back(graph
                               .addPass<Data>(
                                   "p",
                                   [&](Builder& b, Data& d) {
                                       d.in = b.read(in), d.out = b.create("t", desc);
                                   },
                                   kNothing)
                               .out);
            if (random(4) == 0) graph.markOutput(made.back());
        }
        executor.execute();
        const auto& resources = executor.compiled.resources;
        for (size_t i = 1; i < resources.size(); ++i)
            for (size_t k = i + 1; k < resources.size(); ++k) {
                if (resources[i].slot == kNoIndex || resources[i].slot != resources[k].slot)
                    continue;
                EXPECT_EQ(resources[i].texture, resources[k].texture);
                EXPECT_TRUE(resources[i].lastPass < resources[k].firstPass ||
                            resources[k].lastPass < resources[i].firstPass);
            }
    }
}

TEST_F(FrameGraphStorage, KeepAllSharesNothing) {
    graph.markOutput(filter("c", filter("b", produce("a"))));
    executor.compile({.keepAll = true});
    EXPECT_EQ(executor.compiled.slots.size(), 3u);
}

TEST_F(FrameGraphStorage, EveryAcquireHasItsPassAndEveryTransientIsReleasedOnce) {
    graph.markOutput(filter("d", filter("c", filter("b", produce("a")))));
    executor.execute();
    std::vector<int> acquired(executor.compiled.resources.size()), released(acquired.size());
    for (const CompiledPass& pass : executor.compiled.passes) {
        for (const uint32_t r : executor.compiled.list(pass.acquires)) ++acquired[r];
        for (const uint32_t r : executor.compiled.list(pass.releases)) ++released[r];
    }
    EXPECT_EQ(acquired, (std::vector<int>{0, 1, 1, 1, 1}));
    EXPECT_EQ(released, (std::vector<int>{0, 1, 1, 1, 0})) << "the output is not released";
}

TEST_F(FrameGraphStorage, KeptAndPersistentResourcesTakeNoPoolSlot) {
    const Data& cached = graph.addPass<Data>(
        "cached", [](Builder& b, Data& d) { d.out = b.create("kept", kColor), b.cacheBy(1); },
        kNothing);
    const PersistentTexture sum = graph.persistentTexture("sum", kColor);
    graph.addPass<Data>(
        "add", [&](Builder& b, Data& d) { d.in = b.read(cached.out), d.out = b.write(sum.handle); },
        kNothing);
    executor.execute();
    EXPECT_TRUE(executor.compiled.slots.empty());
    EXPECT_NE(resourceNamed(executor.compiled, "kept").persistent,
              resourceNamed(executor.compiled, "sum").persistent);
}

// --- barriers ---

TEST(BarrierTable, ShaderWritesNeedTheBitOfTheNextAccess) {
    const auto bits = [](Access next, bool buffer) {
        return barrierBits(Access::StorageWrite, next, buffer);
    };
    EXPECT_EQ(bits(Access::Sampled, false), GL_TEXTURE_FETCH);
    EXPECT_EQ(bits(Access::StorageRead, false), GL_SHADER_IMAGE);
    EXPECT_EQ(bits(Access::StorageWrite, false), GL_SHADER_IMAGE);
    EXPECT_EQ(bits(Access::StorageRead, true), GL_SHADER_STORAGE);
    EXPECT_EQ(bits(Access::StorageWrite, true), GL_SHADER_STORAGE);
    EXPECT_EQ(bits(Access::Uniform, true), GL_UNIFORM);
    EXPECT_EQ(bits(Access::Indirect, true), GL_COMMAND);
    EXPECT_EQ(bits(Access::Vertex, true), GL_VERTEX | GL_ELEMENT);
    EXPECT_EQ(bits(Access::TransferRead, false), GL_TEXTURE_UPDATE);
    EXPECT_EQ(bits(Access::TransferWrite, true), GL_BUFFER_UPDATE);
    EXPECT_EQ(bits(Access::Capture, true), GL_TRANSFORM_FEEDBACK | GL_QUERY_BUFFER);
    for (const Access target : {Access::ColorTarget, Access::DepthTarget, Access::DepthRead})
        EXPECT_EQ(bits(target, false), GL_FRAMEBUFFER);
}

TEST(BarrierTable, CoherentAccessesNeedNoneAmongThemselves) {
    for (uint32_t previous = 0; previous <= uint32_t(Access::Capture); ++previous)
        for (uint32_t next = 0; next <= uint32_t(Access::Capture); ++next)
            for (const bool buffer : {false, true}) {
                const bool incoherent = Access(previous) == Access::StorageWrite ||
                                        Access(next) == Access::StorageWrite;
                if (incoherent) continue;
                EXPECT_EQ(barrierBits(Access(previous), Access(next), buffer), 0u)
                    << previous << " " << next;
            }
}

TEST(BarrierTable, AShaderWriteWaitsForEarlierReads) {
    EXPECT_EQ(barrierBits(Access::Sampled, Access::StorageWrite, false), GL_SHADER_IMAGE);
    EXPECT_EQ(barrierBits(Access::Indirect, Access::StorageWrite, true), GL_SHADER_STORAGE);
}

TEST_F(FrameGraphStorage, BarriersStandBetweenAShaderWriteAndItsReaders) {
    const TextureHandle a = produce("a");
    const TextureHandle sampled = filter("sampled", a, Access::Sampled);
    filter("again", a, Access::Sampled);
    graph.markOutput(sampled);
    graph.markOutput(graph.findTexture("again"));
    executor.execute();
    EXPECT_EQ(barriers("a"), 0u);
    EXPECT_EQ(barriers("sampled"), GL_TEXTURE_FETCH);
    EXPECT_EQ(barriers("again"), 0u) << "the barrier before 'sampled' covers it";
}

TEST_F(FrameGraphStorage, ANewerWriteNeedsANewBarrier) {
    const TextureHandle a = produce("a"), b = filter("b", a);
    graph.markOutput(filter("c", b));
    executor.execute();
    EXPECT_EQ(barriers("b"), GL_TEXTURE_FETCH);
    EXPECT_EQ(barriers("c") & GL_TEXTURE_FETCH, GL_TEXTURE_FETCH);
}

TEST_F(FrameGraphStorage, RenderTargetsNeedNoBarrierBeforeTheyAreSampled) {
    const TextureHandle a = produce("a", kColor, Access::ColorTarget);
    graph.markOutput(filter("b", a, Access::Sampled, Access::ColorTarget));
    executor.execute();
    EXPECT_EQ(barriers("b"), 0u);
}

TEST_F(FrameGraphStorage, SharedStorageIsOrderedAcrossItsNames) {
    // c takes a's storage: its shader writes must wait until b has read a.
    const TextureHandle a = produce("a", kColor, Access::ColorTarget);
    const TextureHandle b = filter("b", a, Access::Sampled, Access::ColorTarget);
    graph.markOutput(filter("c", b, Access::Sampled, Access::StorageWrite));
    executor.execute();
    ASSERT_EQ(slot("a"), slot("c"));
    EXPECT_EQ(barriers("c"), GL_SHADER_IMAGE);
}

TEST_F(FrameGraphStorage, ReadModifyWriteChainsAreOrdered) {
    const Data& first = graph.addPass<Data>(
        "first", [](Builder& b, Data& d) { d.bufferOut = b.create("sum", BufferDesc{64}); },
        kNothing);
    const Data& second = graph.addPass<Data>(
        "second", [&](Builder& b, Data& d) { d.bufferOut = b.write(first.bufferOut); }, kNothing);
    graph.addPass<Data>(
        "draw",
        [&](Builder& b, Data& d) {
            d.bufferIn = b.read(second.bufferOut, Access::Indirect), b.sideEffect();
        },
        kNothing);
    executor.execute();
    EXPECT_EQ(barriers("second"), GL_SHADER_STORAGE);
    EXPECT_EQ(barriers("draw"), GL_COMMAND);
}

TEST_F(FrameGraphStorage, OneImportUnderTwoNamesIsOneStorage) {
    const BufferHandle a = graph.importBuffer("a", StaticBuffer{5}, {64}, 1),
                       b = graph.importBuffer("b", StaticBuffer{5}, {64}, 1);
    graph.addPass<Data>(
        "write", [&](Builder& builder, Data& d) { d.bufferOut = builder.write(a); }, kNothing);
    graph.addPass<Data>(
        "read",
        [&](Builder& builder, Data& d) { d.bufferIn = builder.read(b), builder.sideEffect(); },
        kNothing);
    executor.execute();
    EXPECT_EQ(barriers("read"), GL_SHADER_STORAGE);
}

} // namespace
} // namespace tyndall::fg
