#include "gl/gl_fixture.h"

#include <array>

namespace tyndall::test {
namespace {

/// Contexts end before main() does: drivers do not like to be called while the process is taken down.
class SharedContexts : public ::testing::Environment {
public:
    void TearDown() override {
        for (gl::Context& context : contexts) context = {};
    }
    static SharedContexts& instance() {
        static auto* shared =
            static_cast<SharedContexts*>(::testing::AddGlobalTestEnvironment(new SharedContexts));
        return *shared;
    }
    std::array<gl::Context, 2> contexts;
    std::array<std::string, 2> failures;
};

[[maybe_unused]] const SharedContexts& kRegistered = SharedContexts::instance();

} // namespace

std::vector<TestBackend> testBackends() { return {TestBackend::Egl, TestBackend::Osmesa}; }

std::string testBackendName(const ::testing::TestParamInfo<TestBackend>& info) {
    return info.param == TestBackend::Egl ? "Egl" : "Osmesa";
}

gl::Context* testContext(TestBackend backend, std::string& why) {
    gl::Context& context = SharedContexts::instance().contexts[size_t(backend)];
    std::string& failure = SharedContexts::instance().failures[size_t(backend)];
    if (!context && failure.empty()) {
        gl::ContextOptions options;
        options.backend = backend == TestBackend::Egl ? gl::Backend::Egl : gl::Backend::Osmesa;
        options.debug = gl::DebugMode::Synchronous;
        Result<gl::Context> made = gl::Context::create(options);
        if (made)
            context = std::move(*made);
        else
            failure = made.message();
    }
    why = failure;
    if (!context) return nullptr;
    context.makeCurrent();
    return &context;
}

void GlTest::SetUp() {
    std::string why;
    context_ = testContext(GetParam(), why);
    // OSMesa has left newer Mesa; EGL must be there.
    if (context_ == nullptr && GetParam() == TestBackend::Osmesa) GTEST_SKIP() << why;
    ASSERT_NE(context_, nullptr) << why;
    context_->debugLog().reset();
    ASSERT_EQ(context_->liveObjects().total(), 0)
        << "left by a test before: " << context_->liveObjects().describe();
}

void GlTest::TearDown() {
    if (context_ == nullptr) return;
    context_->makeCurrent();
    glFinish();
    for (const std::string& message : context_->debugLog().highSeverityMessages())
        ADD_FAILURE() << message;
    EXPECT_EQ(context_->debugLog().count(gl::Severity::High), 0u);
    EXPECT_EQ(context_->liveObjects().total(), 0)
        << "left by this test: " << context_->liveObjects().describe();
    EXPECT_EQ(context_->liveObjects().bytes, 0);
}

std::vector<std::string> GlTest::takeHighSeverityMessages() {
    std::vector<std::string> messages = context_->debugLog().highSeverityMessages();
    context_->debugLog().reset();
    return messages;
}

} // namespace tyndall::test
