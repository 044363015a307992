#pragma once
// The panes: one function and one file each. A pane draws itself into the child window that the layout has opened for it; what it
// keeps between frames is in Session::panes.

#include "session.h"

namespace tyndall::editor {

/// The picture, its toolbar and the camera's mouse and keys.
void drawViewport(Session& session);
/// The scene's nodes.
void drawSceneTree(Session& session);
/// What the selected node holds.
void drawInspector(Session& session);
/// Which technique computes which term.
void drawTechniques(Session& session);
/// Presets and every setting.
void drawSettings(Session& session);
/// Milliseconds a pass.
void drawProfiler(Session& session);
/// Passes and resources of the frame; a click on a texture shows it in the viewport.
void drawFrameGraph(Session& session);
/// What was said.
void drawLog(Session& session);

} // namespace tyndall::editor
