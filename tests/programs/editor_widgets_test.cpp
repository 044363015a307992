// What the editor draws with Dear ImGui, driven by events, without a window and without GL.

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <imgui_internal.h> // windows by their names

#include "input_feed.h"
#include "number_field.h"
#include "save_dialog.h"
#include "support/content.h"
#include "widgets.h"

namespace tyndall::editor {
namespace {
namespace fs = std::filesystem;

constexpr int kEnter = 257, kEscape = 256, kControl = 341, kHome = 268; // as GLFW numbers keys
constexpr ImGuiWindowFlags kPane = ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoDecoration;

/// A person in front of an interface of one window.
class WidgetTest : public ::testing::Test {
protected:
    void SetUp() override {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {800, 600};
        io.KeyMap[ImGuiKey_Enter] = kEnter;
        io.KeyMap[ImGuiKey_Escape] = kEscape;
        io.KeyMap[ImGuiKey_Home] = kHome;
        io.KeyMap[ImGuiKey_A] = 'A';
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
        settle();
    }
    void TearDown() override { ImGui::DestroyContext(); }

    virtual void draw() = 0;
    /// One frame of the interface for each that the events need.
    void act(const std::vector<InputEvent>& events = {}) {
        for (const InputEvent& event : events) queue_.push(event);
        do {
            feed_.apply(queue_.takeFrame(), 1.0 / 60);
            ImGui::NewFrame();
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize({paneWidth, 600});
            ImGui::Begin("pane", nullptr, kPane);
            draw();
            ImGui::End();
            ImGui::Render();
        } while (!queue_.empty());
    }
    void settle() {
        for (int i = 0; i < 3; ++i) act();
    }
    static InputEvent to(const ImVec2& at) {
        return {.kind = InputKind::Cursor, .at = {double(at.x), double(at.y)}};
    }
    static InputEvent button(bool down) { return {.kind = InputKind::Button, .down = down}; }
    static InputEvent key(int code, bool down) {
        return {.kind = InputKind::Key, .code = code, .down = down};
    }
    void tap(int code) { act({key(code, true), key(code, false)}); }
    void click(const ImVec2& at) { act({to(at), button(true), button(false)}); }
    void type(const std::string& characters) {
        for (const char c : characters) act({{.kind = InputKind::Text, .code = c}});
    }

    float paneWidth = 400;

private:
    InputQueue queue_;
    InputFeed feed_;
};

ImVec2 middleOfItem() {
    const ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
    return {0.5f * (a.x + b.x), 0.5f * (a.y + b.y)};
}

// --- events ---

struct ButtonsTest : WidgetTest {
    ImVec2 left, right;
    int leftClicks = 0, rightClicks = 0;
    void draw() override {
        leftClicks += ImGui::Button("left");
        left = middleOfItem();
        rightClicks += ImGui::Button("right");
        right = middleOfItem();
    }
};

TEST_F(ButtonsTest, AClickActsWhereItWasMadeThoughTheCursorWentOnBeforeAnybodyLooked) {
    act({to(left), button(true), button(false), to(right)});
    EXPECT_EQ(leftClicks, 1);
    EXPECT_EQ(rightClicks, 0);
    act({to(right), button(true), button(false), button(true), button(false), to(left)});
    EXPECT_EQ(rightClicks, 2);
}

TEST_F(ButtonsTest, KeysAndButtonsAreReleasedWhenTheWindowLosesTheFocus) {
    act({key('A', true), to(left), button(true)});
    EXPECT_TRUE(ImGui::IsKeyDown('A'));
    act({{.kind = InputKind::Focus, .down = false}});
    EXPECT_FALSE(ImGui::IsKeyDown('A'));
    EXPECT_FALSE(ImGui::IsMouseDown(0));
}

struct TabsTest : WidgetTest {
    ImVec2 second;
    bool secondOpen = false;
    void draw() override {
        if (!ImGui::BeginTabBar("tabs")) return;
        if (ImGui::BeginTabItem("first")) ImGui::EndTabItem();
        secondOpen = ImGui::BeginTabItem("second");
        if (secondOpen) ImGui::EndTabItem();
        second = middleOfItem();
        ImGui::EndTabBar();
    }
};

TEST_F(TabsTest, ATabTakesAClickThatComesTogetherWithTheCursor) {
    click(second); // tabs are among the widgets that want to be hovered first
    settle();
    EXPECT_TRUE(secondOpen);
}

// --- numbers ---

struct NumbersTest : WidgetTest {
    TypedNumber typed;
    double value[3] = {1, -0.001, 3.25};
    int changes = 0;
    ImVec2 field, elsewhere;
    void draw() override {
        ImGui::SetNextItemWidth(300);
        changes += dragNumbers(typed, value, 3, {.speed = 0.5f, .format = "%.2f"});
        field = {ImGui::GetItemRectMin().x + 50, middleOfItem().y};
        ImGui::Button("elsewhere");
        elsewhere = middleOfItem();
    }
    void beginTyping() { // Ctrl + click, which selects all
        act({key(kControl, true)});
        click(field);
        act({key(kControl, false)});
        settle();
    }
};

TEST_F(NumbersTest, ATypedNumberCountsOnceWhenItIsEntered) {
    beginTyping();
    type("120");
    EXPECT_EQ(changes, 0) << "a digit is not a number yet";
    EXPECT_EQ(value[0], 1);
    tap(kEnter);
    settle();
    EXPECT_EQ(changes, 1);
    EXPECT_EQ(value[0], 120);
    EXPECT_EQ(value[1], -0.001) << "not rounded to what is shown";
    EXPECT_EQ(value[2], 3.25);
}

TEST_F(NumbersTest, ATypedNumberCountsWhenTheFieldIsLeft) {
    beginTyping();
    type("7");
    click(elsewhere);
    settle();
    EXPECT_EQ(changes, 1);
    EXPECT_EQ(value[0], 7);
}

TEST_F(NumbersTest, EscTakesBackWhatWasTyped) {
    beginTyping();
    type("99");
    tap(kEscape);
    settle();
    EXPECT_EQ(changes, 0);
    EXPECT_EQ(value[0], 1);
}

TEST_F(NumbersTest, DraggingIsLive) {
    act({to(field), button(true)});
    for (int step = 1; step <= 10; ++step) act({to({field.x + float(10 * step), field.y})});
    EXPECT_GT(changes, 5);
    EXPECT_GT(value[0], 20) << "100 pixels at 0.5, but for the first few";
    const double dragged = value[0];
    act({button(false)});
    beginTyping();
    EXPECT_EQ(value[0], dragged);
}

TEST(Numbers, WhatWouldBeShownAsMinusNothingIsNothing) {
    EXPECT_FALSE(std::signbit(withoutNegativeZero(-0.0, 2)));
    EXPECT_EQ(withoutNegativeZero(-0.0049, 2), 0);
    EXPECT_EQ(withoutNegativeZero(-0.0051, 2), -0.0051);
}

// --- settings ---

struct Values {
    float changed, same;
};
constexpr SettingDesc kFields[] = {
    TYNDALL_FLOAT(Values, changed, "test.changed", "A setting with a long name that is changed",
                  "m", 0, 10, 1, "A number."),
    TYNDALL_FLOAT(Values, same, "test.same", "Same", "", 0, 10, 2, "A number."),
};

struct SettingsTest : WidgetTest {
    TypedNumber typed;
    Values values{3, 2};
    std::vector<SettingEdit> edits;
    ImVec2 table;
    void draw() override {
        table = ImGui::GetCursorScreenPos();
        if (!beginSettingRows("rows")) return;
        for (const SettingDesc& field : kFields)
            if (const std::optional<SettingEdit> edit = settingRow(typed, field, &values))
                edits.push_back(*edit);
        ImGui::EndTable();
    }
    ImVec2 resetOf(int row) const {
        const float side = ImGui::GetFrameHeight(),
                    rowHeight = side + 2 * ImGui::GetStyle().CellPadding.y;
        return {table.x + 0.5f * side, table.y + (float(row) + 0.5f) * rowHeight};
    }
};

TEST_F(SettingsTest, TheResetButtonIsAtOnePlaceInPanesOfAnyWidth) {
    for (const float width : {120.0f, 250.0f, 400.0f, 790.0f}) {
        paneWidth = width;
        edits.clear();
        settle();
        click(resetOf(0));
        ASSERT_EQ(edits.size(), 1u) << width;
        EXPECT_TRUE(edits[0].reset);
        EXPECT_EQ(edits[0].text, "1");
    }
}

TEST_F(SettingsTest, WhatHasItsDefaultCannotBeReset) {
    click(resetOf(1));
    EXPECT_TRUE(edits.empty());
}

// --- menus ---

struct MenuTest : WidgetTest {
    ImVec2 menu;
    bool open = false;
    bool askToClose = false, closed = false;
    void draw() override {
        ImGui::SetNextItemWidth(100);
        open = ImGui::BeginCombo("list", "one");
        if (open) {
            ImGui::Selectable("two");
            ImGui::EndCombo();
        }
        if (!open) menu = {ImGui::GetItemRectMin().x + 10, middleOfItem().y};
        if (askToClose) closed = closeInnermostPopup();
        askToClose = false;
    }
};

TEST_F(MenuTest, EscClosesWhatIsOpenAndSaysSo) {
    click(menu);
    settle();
    ASSERT_TRUE(open);
    askToClose = true;
    act();
    EXPECT_TRUE(closed);
    settle();
    EXPECT_FALSE(open);
    askToClose = true;
    act();
    EXPECT_FALSE(closed) << "nothing is open: Esc is free for the selection";
}

// --- saving ---

struct SaveTest : WidgetTest {
    SaveDialog dialog;
    std::vector<std::string> written;
    bool unsaved = true;
    fs::path folder = test::scratchDir("save_dialog");
    void draw() override {
        dialog.draw(unsaved, [this](const std::string& path) -> Result<void> {
            if (path.ends_with("refused")) return Error{"it cannot be written"};
            written.push_back(path);
            unsaved = false;
            return {};
        });
    }
    static ImGuiWindow* dialogNamed(const char* name) {
        ImGuiWindow* window = ImGui::FindWindowByName(name);
        return window && window->Active ? window : nullptr;
    }
    /// A button of the line at the bottom of a dialog, by the labels of those up to it.
    void press(const char* name, const std::vector<std::string>& labels) {
        const ImGuiWindow* window = dialogNamed(name);
        ASSERT_TRUE(window) << name;
        const ImGuiStyle& style = ImGui::GetStyle();
        float x = window->Pos.x + style.WindowPadding.x, width = 0;
        for (const std::string& label : labels) {
            x += width > 0 ? width + style.ItemSpacing.x : 0;
            width = ImGui::CalcTextSize(label.c_str()).x + 2 * style.FramePadding.x;
        }
        click({x + 0.5f * width, window->Pos.y + window->Size.y - style.WindowPadding.y -
                                     0.5f * ImGui::GetFrameHeight()});
        settle();
    }
    void ask(const fs::path& path, bool quitAfterwards = false) {
        dialog.setPath(path.string());
        dialog.ask(quitAfterwards);
        settle();
    }
    /// The name is in the field already.
    void enter() {
        tap(kEnter);
        settle();
    }
};

TEST_F(SaveTest, ANewFileIsWrittenWithoutAQuestion) {
    const fs::path path = folder / "new.scene.json";
    ask(path);
    enter();
    EXPECT_EQ(written, std::vector<std::string>{path.string()});
    EXPECT_FALSE(dialogNamed("Save a copy"));
    EXPECT_FALSE(dialog.quits());
}

TEST_F(SaveTest, AFileThatIsThereIsReplacedOnlyAfterAYes) {
    const fs::path path = folder / "there.scene.json";
    std::ofstream(path) << "precious";
    ask(path);
    enter();
    ASSERT_TRUE(dialogNamed("Replace the file?"));
    EXPECT_TRUE(written.empty());
    press("Replace the file?", {"Replace", "Cancel"});
    EXPECT_TRUE(written.empty());
    EXPECT_TRUE(dialogNamed("Save a copy")) << "back to the name";
    press("Save a copy", {"Save"});
    press("Replace the file?", {"Replace"});
    EXPECT_EQ(written, std::vector<std::string>{path.string()});
    EXPECT_FALSE(dialogNamed("Save a copy"));
}

TEST_F(SaveTest, WhatCannotBeWrittenLeavesTheDialogOpenAndDoesNotQuit) {
    ask(folder / "refused", true);
    enter();
    EXPECT_TRUE(dialogNamed("Save a copy"));
    EXPECT_FALSE(dialog.quits());
}

TEST_F(SaveTest, SavingACopyOnQuittingSavesAndQuits) {
    dialog.setPath((folder / "last.scene.json").string());
    dialog.askToQuit();
    settle();
    press("Quit?", {"Save a copy and quit..."});
    EXPECT_FALSE(dialog.quits());
    ASSERT_TRUE(dialogNamed("Save a copy"));
    enter();
    EXPECT_EQ(written.size(), 1u);
    EXPECT_TRUE(dialog.quits());
}

TEST_F(SaveTest, CancellingTheCopyStays) {
    dialog.setPath((folder / "last.scene.json").string());
    dialog.askToQuit();
    settle();
    press("Quit?", {"Save a copy and quit..."});
    press("Save a copy", {"Save", "Cancel"});
    EXPECT_FALSE(dialog.quits());
    ask(folder / "later.scene.json");
    enter();
    EXPECT_EQ(written.size(), 1u);
    EXPECT_FALSE(dialog.quits()) << "this copy was not to be the end";
}

TEST_F(SaveTest, EscLeavesTheDialog) {
    ask(folder / "new.scene.json");
    tap(kEscape);
    settle();
    EXPECT_FALSE(dialogNamed("Save a copy"));
    EXPECT_TRUE(written.empty());
}

TEST_F(SaveTest, WithoutEditsQuittingAsksNothing) {
    unsaved = false;
    dialog.askToQuit();
    act();
    EXPECT_TRUE(dialog.quits());
}

} // namespace
} // namespace tyndall::editor
