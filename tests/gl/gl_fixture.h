#pragma once
// Tests with a GL context, on EGL and on OSMesa:
//
//   using MyTest = tyndall::test::GlTest;
//   TYNDALL_GL_TESTS(MyTest);
//   TEST_P(MyTest, SaysWhatHolds) { … }
//
// A test fails when the driver sent a message of high severity, or when GL objects are left at its end. The contexts
// are shared by all tests of a process.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "gl/context.h"

namespace tyndall::test {

enum class TestBackend : int32_t {
    Egl = 0, // as Backend::Egl: hardware where there is some, else Mesa's surfaceless platform
    Osmesa = 1,
};
std::vector<TestBackend> testBackends();
std::string testBackendName(const ::testing::TestParamInfo<TestBackend>& info);
/// The context of this process for `backend`, made on first use and current now; empty, with the reason in `why`, where
/// there is none.
gl::Context* testContext(TestBackend backend, std::string& why);

class GlTest : public ::testing::TestWithParam<TestBackend> {
protected:
    void SetUp() override;
    void TearDown() override;
    [[nodiscard]] gl::Context& context() { return *context_; }
    /// The messages of high severity since the test began or the last call, which then no longer fail it: for tests
    /// that provoke them.
    std::vector<std::string> takeHighSeverityMessages();

private:
    gl::Context* context_ = nullptr;
};

} // namespace tyndall::test

/// Runs the tests of `FIXTURE` on every back end.
#define TYNDALL_GL_TESTS(FIXTURE)                                                                  \
    INSTANTIATE_TEST_SUITE_P(On, FIXTURE, ::testing::ValuesIn(::tyndall::test::testBackends()),    \
                             ::tyndall::test::testBackendName)
