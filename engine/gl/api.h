#pragma once
// OpenGL 4.5 core, for the folders that call it: engine/gl and engine/framegraph/gl. The functions belong to the
// context that was made current last (gl/context.h loads them).

#include <glad/gl.h>
