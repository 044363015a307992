// Recording and compiling a frame allocates nothing once the first frames are over.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "framegraph_null_executor.h"

namespace {
std::atomic<uint64_t> allocations{0};
} // namespace

// Every allocation of this executable is counted. The sanitizers' own operators are then not used in it; malloc's still are.
void* operator new(std::size_t bytes) {
    allocations.fetch_add(1, std::memory_order_relaxed);
    if (void* memory = std::malloc(bytes == 0 ? 1 : bytes)) return memory;
    throw std::bad_alloc();
}
#pragma GCC diagnostic ignored                                                                     \
    "-Wmismatched-new-delete" // GCC sees free() where it inlines these, but not that new is replaced too
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace tyndall::fg {
namespace {

struct Data {
    TextureHandle in, previous, kept, out;
    float values[64];
};
constexpr auto kNothing = [](const Data&, PassContext&) {};

/// Every feature of the graph, with names too long for a string's own storage.
void record(FrameGraphImpl& graph) {
    const TextureDesc color = texture2D(Format::RGBA32F, 64, 64);
    const TextureHistory history =
        graph.historyTexture("a.history.with.a.long.name.for.the.heap", color);
    const PersistentTexture sum =
        graph.persistentTexture("a.persistent.texture.with.a.long.name", color);
    const TextureHandle import =
        graph.importTexture("an.imported.texture.with.a.long.name", StaticTexture{1}, color, 1);
    const Data& kept = graph.addPass<Data>(
        "a.cached.pass.with.a.long.name.for.the.heap",
        [&](Builder& b, Data& d) {
            d.in = b.read(import), d.out = b.create("kept.result.with.a.long.name", color),
            b.cacheBy(1);
        },
        kNothing);
    TextureHandle last = kept.out;
    for (int i = 0; i < 50; ++i)
        last = graph
                   .addPass<Data>(
                       "an.ordinary.pass.with.a.long.name.for.the.heap",
                       [&](Builder& b, Data& d) {
                           if (i % 7 == 3)
                               b.skip("for a reason that takes more than a few words to give");
                           d.in = b.read(last), d.previous = b.read(history.previous);
                           d.out = b.create("its.result.with.a.long.name.for.the.heap", color);
                       },
                       kNothing)
                   .out;
    graph.addPass<Data>(
        "nobody.reads.this.pass.with.a.long.name",
        [&](Builder& b, Data& d) { d.out = b.create("unread.result", color); }, kNothing);
    graph.addPass<Data>(
        "the.update.of.the.history",
        [&](Builder& b, Data& d) { d.in = b.read(last), d.out = b.write(history.current); },
        kNothing);
    graph.addPass<Data>(
        "the.sum", [&](Builder& b, Data& d) { d.in = b.read(last), d.out = b.write(sum.handle); },
        kNothing);
    graph.markOutput(last);
}

TEST(FrameGraphAllocation, NothingIsAllocatedAfterTheFirstFrames) {
    NullExecutor executor;
    uint64_t counted = 0;
    for (int frame = 0; frame < 20; ++frame) {
        const uint64_t before = allocations.load();
        record(executor.beginFrame());
        executor.compile();
        const uint64_t during = allocations.load() - before;
        executor.persistent.commit(executor.compiled);
        ASSERT_TRUE(executor.compiled.errors.empty());
        if (frame == 0) {
            EXPECT_GT(during, 0u) << "the counter counts";
        }
        if (frame >= 3) counted += during;
    }
    EXPECT_EQ(counted, 0u);
}

} // namespace
} // namespace tyndall::fg
