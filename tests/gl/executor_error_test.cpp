// What a pass author or a shader author did wrong is named.
#include "executor_fixture.h"

namespace tyndall::fg {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class ExecutorErrorTest : public ExecutorTest {
protected:
    /// One pass that creates `out`, may read `in`, and is needed.
    template <typename Execute> void pass(const char* name, Execute execute) {
        graph().addPass<Data>(
            name,
            [&](Builder& b, Data& d) {
                d.out = b.create("result", color()), d.in = undeclared_, b.sideEffect();
            },
            execute);
    }
    TextureHandle undeclared_;
};
TYNDALL_GL_TESTS(ExecutorErrorTest);

TEST_P(ExecutorErrorTest, AnUndeclaredBindingIsNamed) {
    begin();
    undeclared_ = fill("fog", 1);
    graph().markOutput(undeclared_);
    pass("lighting", [](const Data& d, PassContext& c) {
        c.compute("test/add.comp").bind("target", d.out).bind("source", d.in).dispatchOver(d.out);
    });
    EXPECT_THAT(
        failure(),
        AllOf(HasSubstr("pass 'lighting' binds 'fog' to 'source' without having declared it"),
              HasSubstr("a read as sampled")));
}

TEST_P(ExecutorErrorTest, AMissingBindingIsNamed) {
    begin();
    pass("lighting", [](const Data& d, PassContext& c) {
        c.compute("test/add.comp").bind("target", d.out).dispatchOver(d.out);
    });
    EXPECT_THAT(
        failure(),
        HasSubstr("pass 'lighting' runs 'test/add.comp' without binding its sampler 'source'"));
}

TEST_P(ExecutorErrorTest, AnUnknownNameIsNamed) {
    begin();
    pass("lighting", [](const Data& d, PassContext& c) {
        c.compute("test/fill.comp").bind("tarket", d.out).dispatchOver(d.out);
    });
    EXPECT_THAT(failure(),
                HasSubstr("pass 'lighting' binds 'tarket', which 'test/fill.comp' does not have"));
}

TEST_P(ExecutorErrorTest, ANameThatTheCompilerRemovedIsNoMistake) {
    library().addSource(
        "test/unused.comp",
        "layout(local_size_x = 8, local_size_y = 8) in;\nuniform sampler2D unused;\nuniform float unusedValue;\n"
        "layout(rgba32f) uniform writeonly image2D target;\n"
        "void main() { imageStore(target, ivec2(gl_GlobalInvocationID.xy), vec4(3)); }\n");
    begin();
    const TextureHandle x = fill("x", 1);
    const Data& made = graph().addPass<Data>(
        "lighting",
        [&](Builder& b, Data& d) { d.in = b.read(x), d.out = b.create("result", color()); },
        [](const Data& d, PassContext& c) {
            c.compute("test/unused.comp")
                .bind("unused", d.in)
                .set("unusedValue", 1.0f)
                .bind("target", d.out)
                .dispatchOver(d.out);
        });
    graph().markOutput(made.out);
    run();
    EXPECT_EQ(everywhere(made.out), 3);
}

TEST_P(ExecutorErrorTest, AProgramThatIsNotListedIsNamed) {
    begin();
    pass("lighting", [](const Data&, PassContext& c) {
        c.compute("common/count_invalid.comp", {{"KIND", 3}});
    });
    EXPECT_THAT(failure(),
                AllOf(HasSubstr("pass 'lighting' asks for 'common/count_invalid.comp KIND=3'"),
                      HasSubstr("variants.txt")));
}

TEST_P(ExecutorErrorTest, AUniformOfAnotherTypeIsNamed) {
    begin();
    pass("lighting", [](const Data& d, PassContext& c) {
        c.compute("test/fill.comp").bind("target", d.out).set("value", 1).dispatchOver(d.out);
    });
    EXPECT_THAT(failure(),
                HasSubstr("pass 'lighting' sets 'value' of 'test/fill.comp' to an integer"));
}

TEST_P(ExecutorErrorTest, ABlockThatIsTooSmallIsNamed) {
    library().addSource(
        "test/block.comp",
        "layout(local_size_x = 1) in;\nlayout(std140) uniform Params { vec4 values[4]; };\n"
        "layout(rgba32f) uniform writeonly image2D target;\n"
        "void main() { imageStore(target, ivec2(0), values[0] + values[3]); }\n");
    struct Params {
        float values[4];
    };
    begin();
    pass("lighting", [](const Data& d, PassContext& c) {
        c.compute("test/block.comp").params(Params{}).bind("target", d.out).dispatch(1);
    });
    EXPECT_THAT(
        failure(),
        HasSubstr(
            "pass 'lighting' gives 16 bytes to the uniform block 'Params' of 'test/block.comp', which has 64"));
}

TEST_P(ExecutorErrorTest, AllErrorsOfAGraphComeTogether) {
    begin();
    const TextureHandle x = fill("x", 1);
    for (const char* name : {"a", "b", "c"})
        graph().addPass<Data>(
            name, [&](Builder& b, Data& d) { d.out = b.write(x); },
            [](const Data&, PassContext&) {});
    const std::string message = failure();
    EXPECT_THAT(message, AllOf(HasSubstr("'a'"), HasSubstr("'b'"), HasSubstr("'c'"),
                               HasSubstr("both write over version 1 of 'x'")));
}

TEST_P(ExecutorErrorTest, AShaderThatDoesNotCompileIsAnErrorAndTheNextFrameIsFine) {
    library().addSource("test/broken.comp",
                        "layout(local_size_x = 1) in;\nvoid main() { nonsense; }\n");
    begin();
    pass("lighting", [](const Data& d, PassContext& c) {
        c.compute("test/broken.comp").bind("anything", d.out).dispatch(1);
    });
    const Result<void> done = executor().execute();
    ASSERT_FALSE(done.ok());
    EXPECT_THAT(done.message(), AllOf(HasSubstr("test/broken.comp"), HasSubstr("nonsense")));
    begin();
    const TextureHandle out = fill("fine", 2);
    graph().markOutput(out);
    run();
    EXPECT_EQ(everywhere(out), 2);
    (void)takeHighSeverityMessages(); // drivers may report the compilation as well
}

TEST_P(ExecutorErrorTest, AFailedCheckInAPassLeavesAnExecutorThatWorks) {
    begin();
    pass("lighting",
         [](const Data& d, PassContext& c) { c.compute("test/fill.comp").bind("tarket", d.out); });
    EXPECT_NE(failure(), "nothing failed");
    begin();
    const TextureHandle out = fill("fine", 2);
    graph().markOutput(out);
    run();
    EXPECT_EQ(everywhere(out), 2);
}

} // namespace
} // namespace tyndall::fg
