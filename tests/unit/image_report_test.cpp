// What reports are made of: JSON text, traces, progress.

#include <cmath>

#include <gtest/gtest.h>

#include "core/check.h"
#include "core/json_writer.h"
#include "core/progress.h"
#include "core/trace.h"

namespace tyndall {
namespace {

TEST(JsonText, EscapesWhatTheStandardAsksForAndMendsBrokenUtf8) {
    EXPECT_EQ(jsonString("a\"b\\c\n\t\r\x01"), R"("a\"b\\c\n\t\r\u0001")");
    EXPECT_EQ(jsonString("gr\xc3\xbc\xc3\x9f \xf0\x9f\x98\x80"),
              "\"gr\xc3\xbc\xc3\x9f \xf0\x9f\x98\x80\"");
    const std::string bad = "\xef\xbf\xbd";
    EXPECT_EQ(jsonString("\xff"), '"' + bad + '"');
    EXPECT_EQ(jsonString("\xc0\xaf"), '"' + bad + bad + '"') << "overlong";
    EXPECT_EQ(jsonString("\xed\xa0\x80"), '"' + bad + bad + bad + '"') << "a surrogate";
    EXPECT_EQ(jsonString("a\xe2\x82"), "\"a" + bad + bad + '"') << "cut off";
}

TEST(JsonText, NumbersAreShortAndReadBackTheSame) {
    EXPECT_EQ(jsonNumber(0.1), "0.1");
    EXPECT_EQ(jsonNumber(-3), "-3");
    EXPECT_EQ(std::stod(jsonNumber(1.0 / 3)), 1.0 / 3);
    EXPECT_EQ(jsonNumber(NAN), "null");
    EXPECT_EQ(jsonNumber(-INFINITY), "null");
}

TEST(JsonText, WritesNestedValuesInOrder) {
    JsonWriter json;
    json.beginObject()
        .member("b", 1)
        .member("a", "x")
        .key("list")
        .compact()
        .beginArray()
        .value(1.5)
        .value(true)
        .null()
        .endArray();
    json.key("empty").beginObject().endObject().key("rows").beginArray();
    json.compact().beginObject().member("n", uint64_t(1) << 60).endObject();
    json.compact().beginObject().endObject().endArray().endObject();
    EXPECT_EQ(
        json.take(),
        "{\n  \"b\": 1,\n  \"a\": \"x\",\n  \"list\": [1.5, true, null],\n  \"empty\": {},\n  \"rows\": [\n"
        "    {\"n\": 1152921504606846976},\n    {}\n  ]\n}\n");
}

TEST(JsonText, MisuseIsCaught) {
    EXPECT_THROW(JsonWriter().beginObject().value(1), CheckFailure);
    EXPECT_THROW(JsonWriter().beginArray().key("a"), CheckFailure);
    EXPECT_THROW(JsonWriter().beginArray().endObject(), CheckFailure);
    EXPECT_THROW((void)JsonWriter().beginArray().take(), CheckFailure);
    EXPECT_THROW(JsonWriter().value(1).value(2), CheckFailure);
}

TEST(Trace, HoldsSpansAndNamesTheirTracks) {
    CpuProfiler profiler;
    { const CpuZone zone(&profiler, "scene.load"); }
    const CpuZone nowhere(nullptr, "not recorded");
    Trace trace;
    trace.addProfile(profiler);
    trace.addSpan(trace.addTrack("GPU"), "gbuffer", 10, 2.5, "ran");
    const std::string json = trace.toJson();
    EXPECT_NE(json.find(R"("args": {"name": "CPU"})"), std::string::npos) << json;
    EXPECT_NE(json.find(R"("ph": "X", "name": "scene.load")"), std::string::npos) << json;
    EXPECT_NE(json.find(R"("ts": 10, "dur": 2.5, "args": {"detail": "ran"})"), std::string::npos)
        << json;
    EXPECT_EQ(json.find("not recorded"), std::string::npos);
}

TEST(Progress, EstimatesFromTheShareThatIsDone) {
    EXPECT_EQ(progressText("rendering", 0.25, 10), "rendering: 25 %, 30 s left");
    EXPECT_EQ(progressText("rendering", 0, 10), "rendering: 0 %") << "nothing to estimate from";
    EXPECT_EQ(progressText("rendering", 0.5, 0.1), "rendering: 50 %") << "too early";
    EXPECT_EQ(progressText("rendering", 7, 10), "rendering: 100 %");
    EXPECT_EQ(durationText(59.5), "1 min 0 s");
    EXPECT_EQ(durationText(3900), "1 h 5 min");
}

struct ProgressTest : ::testing::Test {
    double now = 100;
    std::string text;
    std::string run(ProgressStyle style) {
        Progress progress(
            "work", style, [&] { return now; }, [&](std::string_view part) { text += part; });
        for (int i = 0; i < 100; ++i, now += 0.25) progress.update(i / 100.0);
        return text;
    }
};

TEST_F(ProgressTest, ALogGetsALineNowAndThen) {
    EXPECT_EQ(run(ProgressStyle::Lines), "work: 40 %, 15 s left\nwork: 80 %, 5 s left\n");
}
TEST_F(ProgressTest, ATerminalsLineIsClearedAtTheEnd) {
    run(ProgressStyle::Terminal);
    EXPECT_EQ(text.substr(0, 4), "\r\x1b[K");
    EXPECT_EQ(text.substr(text.size() - 4), "\r\x1b[K");
    EXPECT_EQ(text.find('\n'), std::string::npos);
}
TEST_F(ProgressTest, QuietIsQuiet) { EXPECT_EQ(run(ProgressStyle::Quiet), ""); }

} // namespace
} // namespace tyndall
