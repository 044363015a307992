#pragma once
// The dialogs that stand between edits and their loss: save a copy, replace a file that is there, quit with edits that are in no file.

#include <filesystem>
#include <functional>
#include <string>

#include "core/result.h"

namespace tyndall::editor {

class SaveDialog {
public:
    using Save = std::function<Result<void>(const std::string& path)>;

    void setPath(std::string path) { path_ = std::move(path); }
    /// Asks for a name. `quitAfterwards`: once the copy is written.
    void ask(bool quitAfterwards);
    /// Asks what to do with the edits; quits at once where there are none.
    void askToQuit() { quitAsked_ = true; }

    /// In each frame of the interface, outside of other windows. `save` writes the file that was agreed to.
    void draw(bool unsavedEdits, const Save& save);
    /// Was it decided to quit?
    [[nodiscard]] bool quits() const { return quits_; }

private:
    void drawName(const Save& save);
    void drawReplace(const Save& save);
    void drawQuit(bool unsavedEdits);
    bool write(const Save& save);
    [[nodiscard]] std::filesystem::path fullPath() const;

    std::string path_, failure_;
    bool asked_ = false, quitAsked_ = false;
    bool quitAfterwards_ = false, quits_ = false;
};

} // namespace tyndall::editor
