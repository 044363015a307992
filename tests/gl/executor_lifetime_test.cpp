// What lives how long: culling, kept results, histories, the pool, poison, reports.
#include "executor_fixture.h"

#include <cmath>
#include <cstring>

namespace tyndall::fg {
namespace {

class ExecutorLifetimeTest : public ExecutorTest {
protected:
    StaticTexture source_;
};
TYNDALL_GL_TESTS(ExecutorLifetimeTest);

TEST_P(ExecutorLifetimeTest, ACulledPassDoesNotRun) {
    static int runs;
    runs = 0;
    for (const bool needed : {true, false}) {
        begin();
        const Data& pass = graph().addPass<Data>(
            "maybe", [](Builder& b, Data& d) { d.out = b.create("maybe", color()); },
            [](const Data&, PassContext&) { ++runs; });
        if (needed) graph().markOutput(pass.out);
        run();
        EXPECT_EQ(reportOf("maybe").status, needed ? PassStatus::Ran : PassStatus::Culled);
    }
    EXPECT_EQ(runs, 1);
}

TEST_P(ExecutorLifetimeTest, RunningOnePassAgainRunsThatPassAlone) {
    static int runsBefore;
    runsBefore = 0;
    begin();
    const Data& first = graph().addPass<Data>(
        "first", [](Builder& b, Data& d) { d.out = b.create("first", color()); },
        [](const Data& d, PassContext& c) {
            ++runsBefore;
            c.compute("test/fill.comp")
                .bind("target", d.out)
                .set("value", 2.0f)
                .dispatchOver(d.out);
        });
    static float amount; // what changes between the runs
    amount = 1;
    const Data& second = graph().addPass<Data>(
        "second",
        [&](Builder& b, Data& d) {
            d.in = b.read(first.out);
            d.out = b.create("second", color());
        },
        [](const Data& d, PassContext& c) {
            c.compute("test/add.comp")
                .bind("source", d.in)
                .bind("target", d.out)
                .set("value", amount)
                .dispatchOver(d.out);
        });
    graph().markOutput(first.out);
    graph().markOutput(second.out);
    run();
    EXPECT_EQ(everywhere(second.out), 3);
    amount = 5;
    const Result<void> again = executor().runAgain(&second);
    ASSERT_TRUE(again.ok()) << again.message();
    EXPECT_EQ(everywhere(second.out), 7);
    EXPECT_EQ(runsBefore, 1);
}

TEST_P(ExecutorLifetimeTest, APassWhoseInputIsGoneIsNotRunAgain) {
    begin();
    const TextureHandle in = fill("in", 1);
    const Data& pass = graph().addPass<Data>(
        "pass",
        [&](Builder& b, Data& d) {
            d.in = b.read(in);
            d.out = b.create("out", color());
        },
        [](const Data& d, PassContext& c) {
            c.compute("test/add.comp")
                .bind("source", d.in)
                .bind("target", d.out)
                .set("value", 1.0f)
                .dispatchOver(d.out);
        });
    graph().markOutput(pass.out);
    run();
    EXPECT_THROW((void)executor().runAgain(&pass), CheckFailure);
}

TEST_P(ExecutorLifetimeTest, ACachedPassKeepsItsContent) {
    uint64_t key = 1;
    const auto frame = [&](float value) {
        begin();
        // The key says that nothing changed, so a changed value must not show; others use the pool meanwhile.
        const TextureHandle source = graph().importTexture("source", source_, color(), 1);
        const TextureHandle kept = add("kept", source, value, &key);
        const TextureHandle out = add("out", kept, 0);
        graph().markOutput(out);
        graph().markOutput(add("more", fill("other", 50), 1));
        run();
        return everywhere(out);
    };
    gl::Texture texture("source", gl::TextureSpec{GL_TEXTURE_2D, GL_RGBA32F, 16, 8, 1, 1});
    texture.clear(10);
    source_ = executor().registerTexture("source", std::move(texture));
    EXPECT_EQ(frame(1), 11);
    EXPECT_EQ(frame(2), 11);
    EXPECT_EQ(reportOf("kept").status, PassStatus::Cached);
    key = 2;
    EXPECT_EQ(frame(3), 13);
    executor().forgetCachedResults();
    EXPECT_EQ(frame(4), 14);
}

TEST_P(ExecutorLifetimeTest, HistoryCountsFramesAndStartsAnew) {
    const auto frame = [&](int width) {
        begin();
        const TextureHistory history = graph().historyTexture("count", color(width, 8));
        const Data& pass = graph().addPass<Data>(
            "count",
            [&](Builder& b, Data& d) {
                d.in = b.read(history.previous), d.out = b.write(history.current), d.value = 1;
            },
            [](const Data& d, PassContext& c) {
                c.compute("test/add.comp")
                    .bind("source", d.in)
                    .bind("target", d.out)
                    .set("value", d.value)
                    .dispatchOver(d.out);
            });
        graph().markOutput(pass.out);
        run();
        return everywhere(pass.out);
    };
    EXPECT_EQ(frame(16), 1) << "a history starts as zero";
    EXPECT_EQ(frame(16), 2);
    EXPECT_EQ(frame(16), 3);
    executor().resetHistory();
    EXPECT_EQ(frame(16), 1);
    EXPECT_EQ(frame(16), 2);
    EXPECT_EQ(frame(32), 1) << "another size is another history";
}

TEST_P(ExecutorLifetimeTest, PersistentTexturesAccumulate) {
    library().addSource(
        "test/accumulate.comp",
        "layout(local_size_x = 8, local_size_y = 8) in;\nlayout(rgba32f) uniform image2D sum;\n"
        "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy); imageStore(sum, p, imageLoad(sum, p) + vec4(2)); }\n");
    for (int i = 1; i <= 4; ++i) {
        begin();
        const PersistentTexture sum = graph().persistentTexture("sum", color());
        EXPECT_EQ(sum.wasReset, i == 1);
        const Data& pass = graph().addPass<Data>(
            "accumulate",
            [&](Builder& b, Data& d) {
                d.in = b.read(sum.handle, Access::StorageRead), d.out = b.write(sum.handle);
            },
            [](const Data& d, PassContext& c) {
                c.compute("test/accumulate.comp").bind("sum", d.out).dispatchOver(d.out);
            });
        run();
        EXPECT_EQ(everywhere(pass.out), 2.0f * float(i));
    }
}

TEST_P(ExecutorLifetimeTest, PoisonShowsWhatAPassDidNotWrite) {
    executor().setOptions({.poison = true});
    begin();
    const TextureHandle half = fill("half", 1, color(16, 8), 8); // the left half only
    const Data& integers = graph().addPass<Data>(
        "integers",
        [](Builder& b, Data& d) {
            d.out = b.create("integers", texture2D(Format::R32UI, 4, 4)),
            d.bufferOut = b.create("bytes", BufferDesc{8});
        },
        [](const Data&, PassContext&) {});
    const Data& skipped = graph().addPass<Data>(
        "skipped", [](Builder& b, Data& d) { d.out = b.create("gone", color()), b.skip("no"); },
        [](const Data&, PassContext&) {});
    const TextureHandle absent = add("absent", skipped.out, 1);
    for (const TextureHandle output : {half, integers.out, absent}) graph().markOutput(output);
    graph().markOutput(integers.bufferOut);
    run();
    const Image image = executor().readImage(half);
    EXPECT_EQ(image.at(7, 3)[0], 1);
    EXPECT_TRUE(std::isnan(image.at(8, 3)[0]));
    EXPECT_TRUE(std::isnan(executor().readImage(absent).at(0, 0)[0])) << "a stand-in is poison too";
    EXPECT_EQ(executor().readImage(integers.out).at(1, 1)[0], 4294967296.0f)
        << "0xFFFFFFFF as a float";
    for (const std::byte byte : executor().readBuffer(integers.bufferOut))
        EXPECT_EQ(byte, std::byte(0xff));
}

TEST_P(ExecutorLifetimeTest, PoisonSparesResultsThatAreKept) {
    executor().setOptions({.poison = true});
    uint64_t key = 1;
    for (int i = 0; i < 3; ++i) {
        begin();
        gl::Texture texture("source", gl::TextureSpec{GL_TEXTURE_2D, GL_RGBA32F, 16, 8, 1, 1});
        texture.clear(5);
        if (source_.id == 0) source_ = executor().registerTexture("source", std::move(texture));
        const TextureHandle kept =
            add("kept", graph().importTexture("source", source_, color(), 1), 1, &key);
        const TextureHistory history = graph().historyTexture("h", color());
        const Data& pass = graph().addPass<Data>(
            "keep",
            [&](Builder& b, Data& d) {
                d.in = b.read(kept), d.out = b.write(history.current), b.read(history.previous);
            },
            [](const Data& d, PassContext& c) {
                c.compute("test/add.comp")
                    .bind("source", d.in)
                    .bind("target", d.out)
                    .set("value", 0.0f)
                    .dispatchOver(d.out);
            });
        const TextureHandle old = add("old", history.previous, 0);
        graph().markOutput(pass.out);
        graph().markOutput(old);
        run();
        EXPECT_EQ(everywhere(pass.out), 6);
        EXPECT_EQ(std::isnan(executor().readImage(old).at(0, 0)[0]), i == 0)
            << "there is no past in the first frame";
    }
}

TEST_P(ExecutorLifetimeTest, StorageIsSharedAcrossFramesAndFreedWhenUnused) {
    const auto frame = [&](int width) {
        begin();
        graph().markOutput(add("b", fill("a", 1, color(width, 8)), 1));
        run();
    };
    frame(64);
    const gl::LiveObjects before = context().liveObjects();
    for (int i = 0; i < 20; ++i) frame(64);
    EXPECT_EQ(context().liveObjects().count(gl::ObjectKind::Texture),
              before.count(gl::ObjectKind::Texture));
    EXPECT_EQ(context().liveObjects().bytes, before.bytes)
        << "nothing is made after the first frame";
    const uint64_t bytes64 = executor().report().gpuBytes;
    for (int i = 0; i < 12; ++i) frame(16);
    EXPECT_EQ(bytes64 - executor().report().gpuBytes, 2u * (64u - 16u) * 8u * 16u)
        << "two textures shrank from 64 to 16 columns";
    EXPECT_EQ(executor().report().liveTextures, 2u);
}

TEST_P(ExecutorLifetimeTest, NoObjectIsMadeAfterTheFirstFrames) {
    uint64_t key = 1;
    const auto frame = [&] {
        begin();
        const TextureHistory history = graph().historyTexture("h", color());
        TextureHandle last = add("kept", fill("fresh", 1), 1, &key);
        for (int i = 0; i < 10; ++i) last = add("step", last, 1);
        const Data& pass = graph().addPass<Data>(
            "history",
            [&](Builder& b, Data& d) {
                d.in = b.read(last), b.read(history.previous), d.out = b.write(history.current);
            },
            [](const Data& d, PassContext& c) {
                c.compute("test/add.comp")
                    .bind("source", d.in)
                    .bind("target", d.out)
                    .set("value", 0.0f)
                    .dispatchOver(d.out);
            });
        graph().markOutput(pass.out);
        run();
    };
    executor().setOptions({.timings = false}); // queries come and go with the GPU's pace
    for (int i = 0; i < 3; ++i) frame();
    const gl::LiveObjects before = context().liveObjects();
    for (int i = 0; i < 30; ++i) frame();
    EXPECT_EQ(context().liveObjects().describe(), before.describe());
    EXPECT_EQ(context().liveObjects().bytes, before.bytes);
}

TEST_P(ExecutorLifetimeTest, OnlyWhatStaysCanBeReadBack) {
    begin();
    const TextureHandle inner = fill("inner", 1);
    const TextureHandle out = add("out", inner, 1);
    graph().markOutput(out);
    run();
    EXPECT_THROW((void)executor().readImage(inner), CheckFailure);
    executor().setOptions({.keepAll = true});
    begin();
    const TextureHandle again = fill("inner", 3);
    graph().markOutput(add("out", add("middle", again, 1), 1));
    EXPECT_EQ(executor().findTexture("inner"), again);
    run();
    EXPECT_EQ(everywhere(again), 3);
}

TEST_P(ExecutorLifetimeTest, ReportsTellTimesOfEveryPassThatRan) {
    for (int i = 0; i < 8; ++i) {
        begin();
        const TextureHandle a = fill("same", 1), b = add("same", a, 1);
        graph().markOutput(b);
        run();
        glFinish();
    }
    const FrameReport& report = executor().report();
    ASSERT_EQ(report.passes.size(), 2u);
    const bool timed = context().capabilities().limits.timestampBits > 0;
    for (const PassReport& pass : report.passes) {
        EXPECT_EQ(pass.name, "same");
        EXPECT_GT(pass.cpuMs, 0);
        if (timed) {
            EXPECT_GE(pass.gpuMs, 0);
        }
        EXPECT_LT(pass.savedMs, 0);
    }
    if (timed) {
        EXPECT_DOUBLE_EQ(report.gpuMs, report.passes[0].gpuMs + report.passes[1].gpuMs);
    }
    begin();
    graph().addPass<Data>(
        "same", [](Builder& b, Data& d) { d.out = b.create("x", color()), b.skip("no"); },
        [](const Data&, PassContext&) {});
    run();
    if (timed) {
        EXPECT_GE(reportOf("same").savedMs, 0) << "what it took when it last ran";
    }
}

TEST_P(ExecutorLifetimeTest, InvalidTexelsAreCountedForEachPass) {
    library().addSource(
        "test/invalid.comp",
        "layout(local_size_x = 8, local_size_y = 8) in;\n"
        "layout(rgba32f) uniform writeonly image2D target;\nuniform float zero;\n"
        "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy); vec4 v = vec4(1);\n"
        "  if (p.x == 3) v.y = uintBitsToFloat(0x7fc00000u);\n" // NaN in 8 texels
        "  if (p == ivec2(5, 5)) v.x = 1.0 / zero;\n"           // infinity in one
        "  if (p.y == 0 && p.x > 8) v.z = -1.0;\n"              // negative in 7
        "  imageStore(target, p, v); }\n");
    executor().setOptions({.checkTexels = true});
    const auto frame = [&] {
        begin();
        const Data& bad = graph().addPass<Data>(
            "bad", [](Builder& b, Data& d) { d.out = b.create("bad", color(16, 8)); },
            [](const Data& d, PassContext& c) {
                c.compute("test/invalid.comp")
                    .bind("target", d.out)
                    .set("zero", 0.0f)
                    .dispatchOver(d.out);
            });
        graph().markOutput(bad.out);
        graph().markOutput(fill("good", 1, color(13, 7)));
        run();
    };
    frame();
    EXPECT_EQ(reportOf("bad").nonFiniteTexels, 9u);
    EXPECT_EQ(reportOf("bad").negativeTexels, 7u);
    EXPECT_EQ(reportOf("good").nonFiniteTexels, 0u);
    EXPECT_EQ(reportOf("good").negativeTexels, 0u);
    EXPECT_EQ(executor().report().nonFiniteTexels, 9u);
    executor().allowNegative("bad");
    frame();
    EXPECT_EQ(reportOf("bad").nonFiniteTexels, 9u);
    EXPECT_EQ(executor().report().negativeTexels, 0u);
}

} // namespace
} // namespace tyndall::fg
