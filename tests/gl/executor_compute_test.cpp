// Compute passes, buffers, copies and what links them.
#include "executor_fixture.h"

#include <cstring>

namespace tyndall::fg {
namespace {

using ExecutorComputeTest = ExecutorTest;
TYNDALL_GL_TESTS(ExecutorComputeTest);

TEST_P(ExecutorComputeTest, AChainOfPassesGivesTheSumOfItsParts) {
    begin();
    TextureHandle value = fill("start", 1);
    for (int i = 0; i < 20; ++i)
        value = add("step", value, float(i)); // two textures take turns, with a barrier each
    graph().markOutput(value);
    run();
    EXPECT_EQ(everywhere(value), 1 + 190);
    EXPECT_EQ(executor().compiled().slots.size(), 2u);
}

TEST_P(ExecutorComputeTest, BarriersStandBetweenImageWritesAndFetches) {
    begin();
    const TextureHandle out = add("reader", fill("writer", 2), 3);
    graph().markOutput(out);
    run();
    EXPECT_EQ(executor().compiled().passes[1].barriers, GLuint(GL_TEXTURE_FETCH_BARRIER_BIT));
    EXPECT_EQ(everywhere(out), 5);
}

TEST_P(ExecutorComputeTest, ImagesHaveTheirTopRowFirst) {
    begin();
    const Data& pass = graph().addPass<Data>(
        "place", [](Builder& b, Data& d) { d.out = b.create("place", color(16, 8)); },
        [](const Data& d, PassContext& c) {
            c.compute("test/place.comp").bind("target", d.out).dispatchOver(d.out);
        });
    graph().markOutput(pass.out);
    run();
    const Image image = executor().readImage(pass.out);
    ASSERT_EQ(image.width, 16);
    ASSERT_EQ(image.height, 8);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x) ASSERT_EQ(image.at(x, y)[0], float(x + 100 * (7 - y)));
    float stored[4];
    std::memcpy(stored, executor().readTexels(pass.out).data() + 16 * (16 * 3 + 5), sizeof stored);
    EXPECT_EQ(stored[0], 305) << "texels are as GL has them: row 3 from below, column 5";
}

TEST_P(ExecutorComputeTest, ASkippedWriteKeepsTheContentBefore) {
    begin();
    const TextureHandle before = fill("before", 7);
    const Data& skipped = graph().addPass<Data>(
        "skipped", [&](Builder& b, Data& d) { d.out = b.write(before), b.skip("not needed"); },
        [](const Data& d, PassContext& c) {
            c.compute("test/fill.comp")
                .bind("target", d.out)
                .set("value", 9.0f)
                .dispatchOver(d.out);
        });
    const TextureHandle after = add("after", skipped.out, 1);
    graph().markOutput(after);
    run();
    EXPECT_EQ(everywhere(after), 8);
    EXPECT_EQ(reportOf("skipped").status, PassStatus::Skipped);
    EXPECT_EQ(reportOf("skipped").reason, "not needed");
}

TEST_P(ExecutorComputeTest, AnAbsentTextureReadsAsZero) {
    begin();
    const Data& skipped = graph().addPass<Data>(
        "skipped", [](Builder& b, Data& d) { d.out = b.create("gone", color()), b.skip("no"); },
        [](const Data&, PassContext&) {});
    const TextureHandle out = add("reader", skipped.out, 4);
    graph().markOutput(out);
    run();
    EXPECT_EQ(everywhere(out), 4);
    EXPECT_EQ(executor().textureName(skipped.out), 0u);
}

TEST_P(ExecutorComputeTest, UploadsClearsAndStorageBuffersAddUp) {
    library().addSource(
        "test/sum.comp",
        "layout(local_size_x = 64) in;\nlayout(std430) readonly buffer Numbers { uint numbers[]; };\n"
        "layout(std430) buffer Total { uint total[]; };\n"
        "void main() { atomicAdd(total[1], numbers[gl_GlobalInvocationID.x]); }\n");
    struct Sum {
        BufferHandle numbers, total;
        const uint32_t* data;
    };
    uint32_t numbers[64];
    for (uint32_t i = 0; i < 64; ++i) numbers[i] = i;
    begin();
    const Sum& upload = graph().addPass<Sum>(
        "upload",
        [&](Builder& b, Sum& d) {
            d.numbers = b.create("numbers", BufferDesc{256}, Access::TransferWrite),
            d.data = numbers;
        },
        [](const Sum& d, PassContext& c) {
            c.upload(d.numbers, 0, d.data, 128);
            c.upload(d.numbers, 128, d.data + 32, 128);
        });
    const Sum& sum = graph().addPass<Sum>(
        "sum",
        [&](Builder& b, Sum& d) {
            d.numbers = b.read(upload.numbers), d.total = b.create("total", BufferDesc{8});
        },
        [](const Sum& d, PassContext& c) {
            c.clearBuffer(d.total, 5);
            c.compute("test/sum.comp")
                .bind("Numbers", d.numbers)
                .bind("Total", d.total)
                .dispatchOver(64);
        });
    graph().markOutput(sum.total);
    run();
    uint32_t total[2];
    const std::vector<std::byte> bytes = executor().readBuffer(sum.total);
    ASSERT_EQ(bytes.size(), sizeof total);
    std::memcpy(total, bytes.data(), sizeof total);
    EXPECT_EQ(total[0], 5u);
    EXPECT_EQ(total[1], 5u + 64u * 63u / 2u);
}

TEST_P(ExecutorComputeTest, AShaderMayDecideHowMuchIsDispatched) {
    library().addSource(
        "test/arguments.comp",
        "layout(local_size_x = 1) in;\nlayout(std430) buffer Arguments { uint arguments[]; };\n"
        "void main() { arguments[1] = 7u; arguments[2] = 2u; arguments[3] = 1u; }\n");
    library().addSource(
        "test/count.comp",
        "layout(local_size_x = 3) in;\nlayout(std430) buffer Total { uint total; };\n"
        "void main() { atomicAdd(total, 1u); }\n");
    begin();
    const Data& arguments = graph().addPass<Data>(
        "arguments",
        [](Builder& b, Data& d) { d.bufferOut = b.create("arguments", BufferDesc{16}); },
        [](const Data& d, PassContext& c) {
            c.compute("test/arguments.comp").bind("Arguments", d.bufferOut).dispatch(1);
        });
    const Data& count = graph().addPass<Data>(
        "count",
        [&](Builder& b, Data& d) {
            d.bufferIn = b.read(arguments.bufferOut, Access::Indirect),
            d.bufferOut = b.create("total", BufferDesc{4});
        },
        [](const Data& d, PassContext& c) {
            c.clearBuffer(d.bufferOut, 0);
            c.compute("test/count.comp").bind("Total", d.bufferOut).dispatchIndirect(d.bufferIn, 4);
        });
    graph().markOutput(count.bufferOut);
    run();
    uint32_t total = 0;
    std::memcpy(&total, executor().readBuffer(count.bufferOut).data(), 4);
    EXPECT_EQ(total, 7u * 2u * 3u);
}

TEST_P(ExecutorComputeTest, AShaderSeesTheLengthThatWasDeclared) {
    library().addSource(
        "test/length.comp",
        "layout(local_size_x = 1) in;\nlayout(std430) readonly buffer Numbers { uint numbers[]; };\n"
        "layout(std430) buffer Total { uint total[]; };\n"
        "void main() { total[0] = uint(numbers.length()) + 0u * numbers[0]; }\n");
    struct Lengths {
        BufferHandle numbers, total;
    };
    begin();
    const Lengths& upload = graph().addPass<Lengths>(
        "upload",
        [&](Builder& b, Lengths& d) {
            d.numbers = b.create("numbers", BufferDesc{20}, Access::TransferWrite);
        },
        [](const Lengths& d, PassContext& c) { c.clearBuffer(d.numbers, 1); });
    const Lengths& count = graph().addPass<Lengths>(
        "count",
        [&](Builder& b, Lengths& d) {
            d.numbers = b.read(upload.numbers), d.total = b.create("total", BufferDesc{4});
        },
        [](const Lengths& d, PassContext& c) {
            c.compute("test/length.comp")
                .bind("Numbers", d.numbers)
                .bind("Total", d.total)
                .dispatch(1);
        });
    graph().markOutput(count.total);
    run();
    uint32_t total = 0;
    std::memcpy(&total, executor().readBuffer(count.total).data(), 4);
    EXPECT_EQ(total, 5u) << "20 bytes, however the storage is rounded";
}

TEST_P(ExecutorComputeTest, UniformBlocksComeByName) {
    library().addSource(
        "test/block.comp",
        "layout(local_size_x = 8, local_size_y = 8) in;\n"
        "layout(std140) uniform Params { vec4 first; vec4 second; };\n"
        "layout(std140) uniform View { vec4 third; };\n"
        "layout(rgba32f) uniform writeonly image2D target;\n"
        "void main() { imageStore(target, ivec2(gl_GlobalInvocationID.xy), first + second * third); }\n");
    struct Params {
        float first[4], second[4];
    };
    struct View {
        float third[4];
    };
    begin();
    const Data& pass = graph().addPass<Data>(
        "block", [](Builder& b, Data& d) { d.out = b.create("block", color()); },
        [](const Data& d, PassContext& c) {
            c.compute("test/block.comp")
                .params(Params{{1, 0, 0, 0}, {2, 0, 0, 0}})
                .params(View{{10, 0, 0, 0}}, "View")
                .bind("target", d.out)
                .dispatchOver(d.out);
        });
    graph().markOutput(pass.out);
    run();
    EXPECT_EQ(everywhere(pass.out), 21);
}

TEST_P(ExecutorComputeTest, OnePassMayBuildAMipChain) {
    library().addSource(
        "test/halve.comp",
        "layout(local_size_x = 8, local_size_y = 8) in;\nuniform sampler2D source;\n"
        "layout(rgba32f) uniform writeonly image2D target;\n"
        "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy); vec4 sum = vec4(0);\n"
        "  for (int i = 0; i < 4; ++i) sum += texelFetch(source, 2 * p + ivec2(i & 1, i >> 1), 0);\n"
        "  imageStore(target, p, 0.25 * sum); }\n");
    TextureDesc desc = color(8, 8);
    desc.mips = 4;
    begin();
    const Data& pass = graph().addPass<Data>(
        "chain",
        [&](Builder& b, Data& d) {
            d.out = b.create("chain", desc), b.read(d.out, Access::Sampled);
        },
        [](const Data& d, PassContext& c) {
            c.compute("test/place.comp").bind("target", d.out, 0).dispatchOver(8, 8);
            for (int mip = 1; mip < 4; ++mip) {
                c.barrier(Access::Sampled);
                const uint32_t size = 8u >> mip;
                c.compute("test/halve.comp")
                    .bind("source", d.out, mip - 1)
                    .bind("target", d.out, mip)
                    .dispatchOver(size, size);
            }
        });
    graph().markOutput(pass.out);
    run();
    const Image top = executor().readImage(pass.out, 0, 3);
    ASSERT_EQ(top.width, 1);
    EXPECT_EQ(top.at(0, 0)[0], 3.5f + 350.0f) << "the mean of x + 100 y over 0..7";
}

TEST_P(ExecutorComputeTest, CopiesAndLayersKeepTheirPlaces) {
    library().addSource(
        "test/layer.comp",
        "layout(local_size_x = 8, local_size_y = 8) in;\nuniform sampler2D source;\n"
        "layout(rgba32f) uniform writeonly image2D target;\n"
        "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy); imageStore(target, p, texelFetch(source, p, 0) * 2.0); }\n");
    begin();
    const Data& layers = graph().addPass<Data>(
        "layers",
        [](Builder& b, Data& d) {
            d.out = b.create("layers", texture2DArray(Format::RGBA32F, 8, 8, 3));
        },
        [](const Data& d, PassContext& c) {
            for (int layer = 0; layer < 3; ++layer)
                c.compute("test/fill.comp")
                    .bind("target", d.out, 0, layer)
                    .set("value", float(layer + 1))
                    .dispatchOver(8, 8);
        });
    const Data& copy = graph().addPass<Data>(
        "copy",
        [&](Builder& b, Data& d) {
            d.in = b.read(layers.out, Access::TransferRead),
            d.out = b.create("copy", graph().desc(layers.out), Access::TransferWrite);
        },
        [](const Data& d, PassContext& c) { c.copyTexture(d.in, d.out); });
    const Data& doubled = graph().addPass<Data>(
        "doubled",
        [&](Builder& b, Data& d) {
            d.in = b.read(copy.out), d.out = b.create("doubled", color(8, 8));
        },
        [](const Data& d, PassContext& c) {
            c.compute("test/layer.comp")
                .bind("source", d.in, -1, 2)
                .bind("target", d.out)
                .dispatchOver(d.out);
        });
    graph().markOutput(doubled.out);
    graph().markOutput(copy.out);
    run();
    EXPECT_EQ(everywhere(doubled.out), 6) << "layer 2 holds 3";
    for (int layer = 0; layer < 3; ++layer)
        EXPECT_EQ(executor().readImage(copy.out, layer).at(4, 4)[0], float(layer + 1));
}

TEST_P(ExecutorComputeTest, IntegerTexturesReadBackAsTheirValues) {
    begin();
    const Data& pass = graph().addPass<Data>(
        "clear",
        [](Builder& b, Data& d) {
            d.out = b.create("signed", texture2D(Format::R32I, 4, 4), Access::TransferWrite);
        },
        [](const Data& d, PassContext& c) {
            const float value[4] = {-3, 0, 0, 0};
            c.clearTexture(d.out, value);
        });
    const Data& big = graph().addPass<Data>(
        "clear.unsigned",
        [](Builder& b, Data& d) {
            d.out = b.create("unsigned", texture2D(Format::R32UI, 4, 4), Access::TransferWrite);
        },
        [](const Data& d, PassContext& c) {
            const float value[4] = {3e9f, 0, 0, 0};
            c.clearTexture(d.out, value);
        });
    graph().markOutput(pass.out);
    graph().markOutput(big.out);
    run();
    EXPECT_EQ(everywhere(pass.out), -3);
    EXPECT_EQ(everywhere(big.out), 3e9f);
}

} // namespace
} // namespace tyndall::fg
